"""The firmware built for the Teensy 4.1: it fits, and on an emulated processor of that kind it does what it does here.

Skipped where the cross compiler or QEMU is not installed, unless ACTS_REQUIRE_FIRMWARE_TOOLS is set.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from core_library import installed
from sketch_model import run_sketch

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/firmware.py"
TOOLS_MISSING = 3
BUILD_LIMIT_S = 600


def firmware(*arguments: str) -> subprocess.CompletedProcess[str]:
    result = subprocess.run(
        [sys.executable, SCRIPT, *arguments], capture_output=True, text=True, timeout=BUILD_LIMIT_S, check=False
    )
    if result.returncode == TOOLS_MISSING and "ACTS_REQUIRE_FIRMWARE_TOOLS" not in os.environ:
        pytest.skip(result.stderr.strip())
    return result


def test_it_compiles_and_fits_the_teensy() -> None:
    result = firmware()
    assert result.returncode == 0, result.stdout + result.stderr
    assert "sketch_binary" in result.stdout
    assert "sketch_raster_ascii" in result.stdout


def test_the_core_passes_its_tests_on_the_processor() -> None:
    result = firmware("run", "core_test")
    assert result.returncode == 0, result.stdout + result.stderr
    assert "all checks passed" in result.stdout


def test_sampling_agrees_with_the_host() -> None:
    result = firmware("run", "sampling_digest")
    assert result.returncode == 0, result.stderr
    host = subprocess.run([installed("sampling_digest")], capture_output=True, text=True, timeout=60, check=True)
    assert result.stdout == host.stdout
    assert len(result.stdout.splitlines()) >= 36


def test_the_sketch_does_the_same_as_on_the_host(tmp_path: Path) -> None:
    script = ["0 press 3 4 500", "20000 open", "50000 stall", "400000 read", "450000 close", "470000 end"]
    here = run_sketch(script, tmp_path)
    firmware("run", "core_test")  # skips where that cannot be run
    there = run_sketch(script, tmp_path, [sys.executable, str(SCRIPT), "run", "sketch_run"])
    assert here.frames()
    assert there.text == here.text
