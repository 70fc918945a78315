# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The script that builds for the Teensy 4.1, on a firmware of no program, which takes no time."""

import shutil
from pathlib import Path

from firmware_script import SCRIPT, firmware

EMPTY = "cmake_minimum_required(VERSION 3.16)\nproject(empty LANGUAGES NONE)\n"


def make_checkout(root: Path) -> Path:
    """A checkout of the script alone; returns that."""
    script = root / "scripts/firmware.py"
    script.parent.mkdir(parents=True)
    shutil.copy(SCRIPT, script)
    (root / "acts_firmware/teensy").mkdir(parents=True)
    (root / "acts_firmware/teensy/cortex_m7.cmake").touch()
    (root / "acts_firmware/CMakeLists.txt").write_text(EMPTY)
    return script


def test_a_checkout_that_was_moved_is_built_anew(tmp_path: Path) -> None:
    before, after = tmp_path / "before", tmp_path / "after"
    built = firmware(script=make_checkout(before))
    assert built.returncode == 0, built.stderr
    before.rename(after)
    moved = firmware(script=after / "scripts/firmware.py")
    assert moved.returncode == 0, moved.stderr
    # What is built where it is, is kept.
    kept = after / ".acts/firmware/kept"
    kept.touch()
    assert firmware(script=after / "scripts/firmware.py").returncode == 0
    assert kept.exists()
