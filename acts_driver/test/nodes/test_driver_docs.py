# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""docs/driver.md names every parameter and every diagnostic value but for the schemes' own; --help every parameter."""

import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import pytest

from acts_core.sampling import OWN_SETTINGS
from acts_core.settings import describe
from acts_driver.nodes.report import Totals
from acts_driver.settings import DriverSettings

pytestmark = pytest.mark.slow

PAGE = (Path(__file__).resolve().parents[3] / "docs" / "driver.md").read_text(encoding="utf-8")
# docs/reference.md lists these, also those of schemes that somebody adds.
OF_SCHEMES = {own.parameter for own in OWN_SETTINGS}


@pytest.mark.parametrize(
    "name", sorted({*describe(DriverSettings), *(field.name for field in fields(Totals))} - OF_SCHEMES)
)
def test_it_is_documented(name: str) -> None:
    assert f"`{name}`" in PAGE


def test_help_tells_every_parameter_and_starts_nothing() -> None:
    program = [sys.executable, "-m", "acts_ros.executables.program", "acts_driver.nodes.driver_node"]
    result = subprocess.run([*program, "--help"], capture_output=True, text=True, timeout=60, check=False)
    assert (result.returncode, result.stderr) == (0, "")
    assert "board bytes in" in result.stdout
    for name in describe(DriverSettings):
        assert f"    {name} (default " in result.stdout
