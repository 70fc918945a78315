# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a driver goes on with that is in place of another one; ROS_DOMAIN_ID 2."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from driver_rig import Rig
from skin_stream import (
    SIZE,
    Stream,
    ask_until,
    ask_with_frames,
    await_baseline,
    calibrate,
    close_port,
    start,
    start_calibrated,
)

from acts_driver.baseline import kept_baseline
from acts_msgs.msg import Baseline

pytestmark = pytest.mark.slow


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(2)
    yield rig
    rig.close()


def start_tared(rig: Rig, stream: Stream, path: Path) -> None:
    """A driver whose skin was calibrated at 25 counts and tared at 300."""
    start_calibrated(rig, stream, path)
    stream.field = np.full(SIZE, 300, dtype=np.uint16)
    rig.spin_until(lambda: bool(rig.samples) and min(rig.samples[-1].counts) >= 300, "the load")
    pressed = rig.samples[-1].header.stamp
    rig.spin_until(lambda: rig.samples[-1].header.stamp.sec > pressed.sec + 1, "a second of it")
    assert ask_with_frames(rig, "tare").success


def end(rig: Rig, *, by_an_error: bool) -> None:
    """End the driver as its process does."""
    driver = rig.driver
    assert driver is not None
    if by_an_error:
        driver.failed()
    driver.close()
    rig.executor.remove_node(driver)
    driver.destroy_node()
    rig.driver = None


def test_a_driver_in_place_of_one_that_an_error_has_ended_goes_on_with_its_tare(
    rig: Rig, stream: Stream, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    start_tared(rig, stream, tmp_path / "skin.npz")
    end(rig, by_an_error=True)
    baselines = start(rig, stream, tmp_path / "skin.npz")
    rig.spin_until(lambda: bool(baselines), "a baseline")
    # Not even for a moment that of the file.
    assert {baseline.source for baseline in baselines} == {Baseline.SOURCE_TARE}
    assert min(baselines[-1].baseline) == pytest.approx(300.5, abs=1)
    assert f"baseline of {SIZE} taxels from the driver that has died (tare)" in capfd.readouterr().err
    rig.status_until(lambda status: status.get("baseline") == "tare", "the report")


def test_a_driver_that_ended_in_order_leaves_no_tare(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    start_tared(rig, stream, tmp_path / "skin.npz")
    end(rig, by_an_error=False)
    baselines = start(rig, stream, tmp_path / "skin.npz")
    assert await_baseline(rig, baselines).source == Baseline.SOURCE_FILE
    assert min(baselines[-1].baseline) == pytest.approx(25.5, abs=1)


def test_what_the_parameters_have_taken_away_is_left_to_nobody(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    start_tared(rig, stream, tmp_path / "skin.npz")
    close_port(rig)
    assert rig.set_parameters(calibration_file="") == (True, "")
    end(rig, by_an_error=True)
    baselines = start(rig, stream, tmp_path / "skin.npz")
    assert await_baseline(rig, baselines).source == Baseline.SOURCE_FILE


def test_a_driver_with_another_file_does_not_go_on_with_the_tare(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    start_tared(rig, stream, tmp_path / "skin.npz")
    end(rig, by_an_error=True)
    baselines = start(rig, stream, tmp_path / "none.npz")
    rig.spin_until(lambda: bool(baselines), "that there is none")
    assert baselines[-1].source == Baseline.SOURCE_NONE


def test_a_baseline_that_cannot_be_kept_is_told_and_the_driver_goes_on(
    rig: Rig, stream: Stream, tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "kept"
    monkeypatch.setattr(kept_baseline, "kept_folder", lambda: folder)
    start(rig, stream, tmp_path / "skin.npz")
    shutil.rmtree(folder)
    folder.write_text("somebody's")
    stream.start()
    calibrate(rig)
    told = capfd.readouterr().err
    assert re.search(rf"{folder}/.*cannot be written \(.*\); a driver that takes over from this one begins", told)
    # Another one is not tried, and neither told.
    ask_until(rig, "tare", lambda answer: bool(answer.success), "a tare")
    assert "takes over" not in capfd.readouterr().err
