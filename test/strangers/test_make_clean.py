# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`make clean` removes what was made in a checkout, and nothing else, and nothing that is in use."""

from __future__ import annotations

import fcntl
import mmap
import os
import shutil
import subprocess
from pathlib import Path

import pytest

MAKEFILE = Path(__file__).resolve().parents[2] / "Makefile"


@pytest.mark.parametrize("state", [".acts", ".acts/jazzy"])
def test_nothing_is_removed_under_a_set_up(tmp_path: Path, state: str) -> None:
    shutil.copy(MAKEFILE, tmp_path)
    (tmp_path / state / "venv").mkdir(parents=True)
    clean = ["make", "-C", str(tmp_path), "clean"]
    with (tmp_path / state / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        refused = subprocess.run(clean, capture_output=True, text=True, timeout=30)
    assert refused.returncode != 0
    assert "not cleaned: a set-up of this checkout is under way, wait for it" in refused.stderr
    assert (tmp_path / state / "venv").is_dir()
    assert subprocess.run(clean, capture_output=True, text=True, timeout=30).returncode == 0
    assert not (tmp_path / ".acts").exists()


def test_nothing_is_removed_under_what_runs(tmp_path: Path) -> None:
    shutil.copy(MAKEFILE, tmp_path)
    library = tmp_path / ".acts" / "library"
    library.parent.mkdir()
    library.write_bytes(b"0" * 4096)
    clean = ["make", "-C", str(tmp_path), "clean"]
    with library.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ):
        refused = subprocess.run(clean, capture_output=True, text=True, timeout=30)
    assert refused.returncode != 0
    assert "not cleaned: end what runs from here first (ps " in refused.stderr
    assert f"{os.getpid()} " in refused.stderr
    assert library.exists()
    assert subprocess.run(clean, capture_output=True, text=True, timeout=30).returncode == 0
    assert not library.parent.exists()


def test_what_was_built_or_cached_is_removed_and_nothing_else(tmp_path: Path) -> None:
    shutil.copy(MAKEFILE, tmp_path)
    # Second what pip leaves in a checkout that is installed without ROS, third what linters and pytest do.
    made = [
        *(".acts/venv/file", "build/file", "install/file", "log/file", "out/ball_balancing.png"),
        *("acts_core/build/lib/file", "acts_core/acts_core.egg-info/PKG-INFO", "acts_recon/build/file"),
        *(".mypy_cache/file", ".ruff_cache/file", ".pytest_cache/file"),
    ]
    kept = [
        *("acts_core/acts_core/array.py", "acts_core/test/build/file", "acts_core/setup.py"),
        *("touch/touch_0.mcap", "touch.npz", "recordings/plate/touch.mcap", "objects.npz", "builds/touch.mcap"),
    ]
    for name in (*made, *kept):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    subprocess.run(["make", "-C", str(tmp_path), "clean"], check=True, capture_output=True, timeout=30)
    left = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert left == {"Makefile", *kept}
