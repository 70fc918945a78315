# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The cache of compiled kernels: it serves a second process, and notices every change of what a kernel is made of."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

FILES = {
    "constants.py": "STEP = 1\n",
    "inner.py": """
from acts_core.kernels import kernel
from acts_kerneltest.constants import (
    STEP,
)

@kernel
def stepped(value):
    return value + STEP
""",
    "outer.py": """
from acts_core.kernels import kernel
from acts_kerneltest import inner

stepped = inner.stepped

@kernel(fastmath={"nsz"})
def twice(value):
    return stepped(stepped(value))
""",
    "inner_other.py": "",
    "elsewhere.py": "",
}

PROGRAM = """
from numba.core import event
with event.install_recorder("numba:compile") as recorder:
    from acts_kerneltest.outer import twice
    print(twice(0), len(recorder.buffer) > 0)
"""

Run = Callable[[], tuple[int, bool]]


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "acts_kerneltest"
    folder.mkdir()
    for name, text in {"__init__.py": "", **FILES}.items():
        (folder / name).write_text(text)
    return folder


@pytest.fixture
def run(package: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Call the kernel in a new process: its result, and whether anything was compiled."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("PYTHONPATH", f"{package.parent}:{os.environ.get('PYTHONPATH', '')}")
    # Files are changed within the same second, which Python's own cache does not notice.
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")

    def finished() -> tuple[int, bool]:
        done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stderr
        result, has_compiled = done.stdout.split()
        return int(result), has_compiled == "True"

    return finished


def folders(root: Path) -> list[str]:
    return sorted({str(path.parent) for path in root.rglob("*.nbi")})


def test_a_second_process_compiles_nothing(run: Run) -> None:
    assert run() == (2, True)
    assert run() == (2, False)


def test_a_change_of_anything_it_is_made_of_is_noticed(run: Run, package: Path) -> None:
    run()
    count = len(folders(package))
    for file, old, new, result in (
        ("constants.py", "STEP = 1", "STEP = 5", 10),
        ("inner.py", "value + STEP", "value - STEP", -10),
        ("outer.py", "stepped(stepped(value))", "stepped(value)", -5),
    ):
        (package / file).write_text(FILES[file].replace(old, new))
        assert run() == (result, True)
        # What was compiled of the former content is gone.
        assert len(folders(package)) == count
    assert run() == (-5, False)


def test_a_change_elsewhere_compiles_nothing(run: Run, package: Path) -> None:
    run()
    (package / "elsewhere.py").write_text("STEP = 7\n")
    # No module of the same beginning of a name is taken for a former one.
    (package / "inner_other.py").write_text(FILES["inner.py"])
    assert run() == (2, False)


def test_the_users_folder_is_used_where_it_is_asked_for(
    run: Run, package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "mine"))
    assert run() == (2, True)
    assert run() == (2, False)
    assert folders(package) == []
    assert folders(tmp_path / "mine")


def test_a_package_that_cannot_be_written_is_cached_with_the_user(
    run: Run, package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A file in its place keeps even root from making the folder.
    (package / "__pycache__").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert run() == (2, True)
    assert run() == (2, False)
    assert folders(tmp_path / "cache")
