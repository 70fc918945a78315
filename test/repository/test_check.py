# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`make test-quick` and `make format` on a machine without linters."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def check(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """scripts/check.py, of which nothing is installed that it would run."""
    specification = importlib.util.spec_from_file_location("check", ROOT / "scripts" / "check.py")
    assert specification is not None
    assert specification.loader is not None
    check = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(check)
    monkeypatch.setenv("PATH", "/no/such/folder")
    monkeypatch.setattr(check, "test", lambda arguments: [f"tests {' '.join(arguments)}"])
    return check


@pytest.mark.parametrize(
    ("option", "missing", "failures"),
    [
        ([], "ruff, mypy, clang-format", "tests "),
        (["--quick"], "ruff", "tests -m not slow"),
        (["--format"], "ruff, clang-format", "linters: not installed"),
        (["--lint"], "ruff, mypy, clang-format", "linters: not installed"),
    ],
)
def test_without_linters_it_says_so_and_tests_are_run(
    check: ModuleType,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    option: list[str],
    missing: str,
    failures: str,
) -> None:
    monkeypatch.setattr("sys.argv", ["check.py", *option])
    assert check.main() == 1
    told, failed = capsys.readouterr().out.splitlines()
    assert told.startswith(f"[check] linters left out, not installed: {missing} (pip install ")
    assert failed == f"[check] failed: {failures}"
