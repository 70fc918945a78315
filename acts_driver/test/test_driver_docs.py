"""docs/driver.md names every parameter and every diagnostic value."""

from dataclasses import fields
from pathlib import Path

import pytest

from acts_core.settings import describe
from acts_driver.report import Totals
from acts_driver.settings import DriverSettings

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "driver.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", [*describe(DriverSettings), *(field.name for field in fields(Totals))])
def test_it_is_documented(name: str) -> None:
    assert f"`{name}`" in PAGE
