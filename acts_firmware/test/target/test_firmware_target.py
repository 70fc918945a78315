# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The firmware built for the Teensy 4.1: it fits, and on an emulated processor of that kind it does what it does here.

Skipped where the cross compiler or QEMU is not installed, unless ACTS_REQUIRE_FIRMWARE_TOOLS is set.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from core_library import installed
from firmware_script import SCRIPT, firmware
from sketch_model import SketchRun, run_sketch, upload

from acts_core.sampling import SCHEME_NUMBERS
from acts_core.wire import BoardImage, BoardObject, BoardSettings, encode_configure, object_library, patch_dictionary

pytestmark = pytest.mark.slow


def test_it_compiles_and_fits_the_teensy() -> None:
    result = firmware()
    assert result.returncode == 0, result.stdout + result.stderr
    assert "sketch_binary" in result.stdout
    assert "sketch_raster_ascii" in result.stdout


@pytest.fixture(scope="module")
def on_target() -> list[str]:
    """The command that runs a program, to be named next, on the processor."""
    core = firmware("run", "core_test")
    assert core.returncode == 0, core.stdout + core.stderr
    assert "all checks passed" in core.stdout
    return [sys.executable, str(SCRIPT), "run", "--as-built"]


def test_the_core_passes_its_tests_on_the_processor(on_target: list[str]) -> None:
    assert on_target  # made by those tests


def test_sampling_agrees_with_the_host(on_target: list[str]) -> None:
    here, there = (
        subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout
        for command in ([installed("sampling_digest")], [*on_target, "sampling_digest"])
    )
    assert there == here
    assert len(here.splitlines()) == 6 * len(SCHEME_NUMBERS)


def both_runs(script: list[str], on_target: list[str], tmp_path: Path) -> tuple[SketchRun, SketchRun]:
    """The sketch's run here and on the processor."""
    return run_sketch(script, tmp_path), run_sketch(script, tmp_path, [*on_target, "sketch_run"])


def test_the_sketch_does_the_same_as_on_the_host(on_target: list[str], tmp_path: Path) -> None:
    script = ["0 press 3 4 500", "20000 open", "50000 stall", "400000 read", "450000 close", "470000 end"]
    here, there = both_runs(script, on_target, tmp_path)
    assert here.frames()
    assert there.text == here.text


def test_recovery_agrees_with_the_host(on_target: list[str], tmp_path: Path) -> None:
    # Single precision on both, but not the same order of operations: whole counts may be rounded apart.
    model = patch_dictionary(np.random.default_rng(1).standard_normal((64, 200)))
    configure = encode_configure(4, BoardSettings(m=300, output="image", frame_period_us=10_000)).hex()
    press = [f"0 press {row} {col} {300 + 20 * (row + col)}" for row in range(5, 12) for col in range(8, 20)]
    script = [*press, "20000 open", *upload(model, 21_000), f"60000 send {configure}", "160000 end"]
    here, there = (
        [message.counts.astype(int) for message in run.messages() if isinstance(message, BoardImage)]
        for run in both_runs(script, on_target, tmp_path)
    )
    assert len(here) == len(there) > 5
    assert max(np.abs(one - other).max() for one, other in zip(here, there, strict=True)) <= 1
    assert here[-1].max() > 300


def test_classification_agrees_with_the_host(on_target: list[str], tmp_path: Path) -> None:
    random = np.random.default_rng(2)
    model = object_library(random.random((1024, 30)), np.arange(30) // 10)
    configure = encode_configure(4, BoardSettings(m=100, output="object", frame_period_us=10_000)).hex()
    press = [f"0 press {row} {col} {300 + 20 * (row + col)}" for row in range(5, 12) for col in range(8, 20)]
    script = [*press, "20000 open", *upload(model, 21_000), f"80000 send {configure}", "160000 end"]
    here, there = (
        [message for message in run.messages() if isinstance(message, BoardObject)]
        for run in both_runs(script, on_target, tmp_path)
    )
    assert len(here) == len(there) > 5
    for one, other in zip(here, there, strict=True):
        assert other.number == one.number
        np.testing.assert_allclose(other.residuals, one.residuals, atol=1e-5)
