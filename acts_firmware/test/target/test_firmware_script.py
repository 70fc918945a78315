# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The script that builds for the Teensy 4.1, on a firmware of no program, which takes no time."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from firmware_script import BUILD_LIMIT_S, SCRIPT, TOOLS_MISSING, firmware

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


def test_a_compiler_without_its_library_is_told_with_the_packages(tmp_path: Path) -> None:
    compiler = tmp_path / "bin/arm-none-eabi-g++"
    compiler.parent.mkdir()
    compiler.write_text("#!/bin/sh\necho '<stdin>:1:10: fatal error: array: No such file or directory' >&2\nexit 1\n")
    compiler.chmod(0o755)
    script = make_checkout(tmp_path / "checkout")
    environment = {**os.environ, "PATH": f"{compiler.parent}:{os.environ['PATH']}"}
    result = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, timeout=BUILD_LIMIT_S, env=environment
    )
    assert result.returncode == TOOLS_MISSING
    assert "sudo apt-get install gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi" in result.stderr
    assert len(result.stderr.splitlines()) == 1
