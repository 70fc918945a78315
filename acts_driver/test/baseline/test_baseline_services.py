# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Calibrate and tare on the driver, over real DDS and a pseudo-terminal; ROS_DOMAIN_ID 57."""

from __future__ import annotations

import re
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from driver_rig import Rig
from skin_stream import (
    COLS,
    ROWS,
    SIZE,
    Stream,
    ask,
    ask_until,
    ask_with_frames,
    await_baseline,
    calibrate,
    close_port,
    open_port,
    start,
    start_calibrated,
)

from acts_core.errors import SettingsError
from acts_driver.baseline import Baseline as SavedBaseline
from acts_driver.baseline.baseline import BaselineSource
from acts_msgs.msg import Baseline

pytestmark = pytest.mark.slow


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(57)
    yield rig
    rig.close()


def test_where_there_is_no_baseline_yet_the_log_names_the_service_as_it_is_called(
    rig: Rig, stream: Stream, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    start(rig, stream, tmp_path / "skin.npz")
    service = "/plate/driver/calibrate"
    rig.spin_until(lambda: service in dict(rig.listener.get_service_names_and_types()), "the service")
    assert f"{tmp_path}/skin.npz is not there, the service {service} writes it" in capfd.readouterr().err


def test_calibrate_and_tare(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    path = tmp_path / "skin.npz"
    baselines = start(rig, stream, path)
    answer = ask(rig, "calibrate")
    assert not answer.success
    assert "no frames: is the driver configured" in answer.message
    stream.start()
    calibrate(rig)
    first = await_baseline(rig, baselines)
    assert (first.rows, first.cols, first.source) == (ROWS, COLS, Baseline.SOURCE_CALIBRATION)
    assert first.header.frame_id == "plate"
    assert first.header.stamp.sec > 0
    assert list(first.valid) == [True] * SIZE
    assert np.abs(np.array(first.baseline) - 25.5).max() < 0.2
    assert np.abs(np.array(first.noise) - 0.5).max() < 0.1
    saved = SavedBaseline.load(path, ROWS, COLS)
    assert saved.counts.ravel().tolist() == list(first.baseline)

    # The skin is pressed: no calibration, but a tare. Samples stay raw.
    stream.field = np.where(np.arange(SIZE) < 2 * COLS, 300, 25).astype(np.uint16)
    rig.spin_until(lambda: bool(rig.samples) and max(rig.samples[-1].counts) >= 300, "the touch")
    refused = ask_with_frames(rig, "calibrate")
    assert not refused.success
    assert "the skin was touched" in refused.message
    pressed = rig.samples[-1].header.stamp
    rig.spin_until(lambda: rig.samples[-1].header.stamp.sec > pressed.sec + 1, "a second of touch")
    assert ask_with_frames(rig, "tare").success
    rig.spin_until(lambda: baselines[-1].source == Baseline.SOURCE_TARE, "the tared baseline")
    assert baselines[-1].baseline[0] == pytest.approx(300.5, abs=1)
    assert max(rig.samples[-1].counts) >= 300
    # A tare is not stored.
    assert SavedBaseline.load(path, ROWS, COLS).counts[0, 0] == pytest.approx(25.5, abs=0.2)
    status = rig.status_until(lambda status: status.get("baseline") == "tare", "the report")
    assert status["baseline_taxels"] == str(SIZE)
    assert {"baseline_below", "baseline_drift_per_min.median", "baseline_drift_per_min.largest"} <= status.keys()


def test_a_touch_is_one_of_taxels_that_are_neighbours_on_the_skin(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    combed = tmp_path / "combed.yaml"
    combed.write_text("patches:\n  pad:\n    wires: {down: 'rows 0 to 6 by 2, 1 to 7 by 2', across: cols}\n")
    # In the matrix these are two broken taxels.
    stream.field[[3, 2 * COLS + 3]] = 400
    start(rig, stream, tmp_path / "skin.npz", layout=combed)
    stream.start()
    ask_until(rig, "calibrate", lambda answer: "the skin was touched: 2 taxels" in answer.message, "a refusal")
    close_port(rig)
    assert rig.set_parameters(layout="") == (True, "")
    open_port(rig)
    calibrate(rig)
    # Against this baseline they are untouched.
    stream.field[[3, 2 * COLS + 3]] = 800
    close_port(rig)
    assert rig.set_parameters(layout=str(combed)) == (True, "")
    open_port(rig)
    ask_until(rig, "calibrate", lambda answer: "the skin was touched: 2 taxels" in answer.message, "a refusal again")


def test_a_layout_that_cannot_be_read_leaves_the_baseline_its_neighbours(
    rig: Rig, stream: Stream, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    start(rig, stream, tmp_path / "skin.npz", layout=tmp_path / "none.yaml")
    told = ""

    def is_told() -> bool:
        nonlocal told
        told += capfd.readouterr().err
        return "none.yaml" in told and "the baseline goes on with the neighbours that it knows" in told

    stream.start()
    rig.spin_until(is_told, "the warning")
    calibrate(rig)


@pytest.mark.parametrize("is_set_again", [True, False])
def test_a_layout_s_file_is_read_again_with_the_port_or_where_it_is_set_again(
    rig: Rig, stream: Stream, tmp_path: Path, capfd: pytest.CaptureFixture[str], is_set_again: bool
) -> None:
    combed = tmp_path / "combed.yaml"
    start(rig, stream, tmp_path / "skin.npz", layout=combed)
    told = ""

    def is_told() -> bool:
        nonlocal told
        told += capfd.readouterr().err
        return "the baseline goes on with the neighbours that it knows" in told

    rig.spin_until(is_told, "the warning")
    close_port(rig)
    combed.write_text("patches:\n  pad:\n    wires: {down: 'rows 0 to 6 by 2, 1 to 7 by 2', across: cols}\n")
    if is_set_again:
        assert rig.set_parameters(layout=str(combed)) == (True, "")
    open_port(rig)
    # In the matrix these are two broken taxels.
    stream.field[[3, 2 * COLS + 3]] = 400
    stream.start()
    ask_until(rig, "calibrate", lambda answer: "the skin was touched: 2 taxels" in answer.message, "a refusal")


@pytest.mark.parametrize("service", ["calibrate", "tare"])
def test_without_frames_the_past_is_not_taken_for_the_present(
    rig: Rig, stream: Stream, tmp_path: Path, service: str
) -> None:
    start_calibrated(rig, stream, tmp_path / "skin.npz")
    stream.ended.set()
    ask_until(
        rig,
        service,
        lambda answer: not answer.success and "no frames for" in answer.message,
        "a refusal without frames",
    )


@pytest.mark.parametrize("service", ["calibrate", "tare"])
def test_as_soon_as_the_port_is_closed_the_past_is_not_taken_for_the_present(
    rig: Rig, stream: Stream, tmp_path: Path, service: str
) -> None:
    start_calibrated(rig, stream, tmp_path / "skin.npz")
    close_port(rig)
    answer = ask(rig, service)
    assert not answer.success
    assert "no frames: is the driver configured" in answer.message


def test_the_file_is_read_at_the_start(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    path = tmp_path / "skin.npz"
    counts = np.full((ROWS, COLS), 12.5, dtype=np.float32)
    tracked = SavedBaseline(counts, counts / np.float32(10), counts > 0, BaselineSource.CALIBRATION, time_ns=5 * 10**9)
    tracked.save(path)
    baselines = start(rig, stream, path)
    first = await_baseline(rig, baselines)
    assert list(first.baseline) == [12.5] * SIZE
    assert first.header.stamp.sec == 5
    assert first.source == Baseline.SOURCE_FILE


def test_a_driver_without_a_baseline_withdraws_that_of_the_driver_before(
    rig: Rig, stream: Stream, tmp_path: Path
) -> None:
    baselines = start(rig, stream, tmp_path / "skin.npz")
    rig.spin_until(lambda: bool(baselines), "that there is none")
    assert baselines[-1].source == Baseline.SOURCE_NONE
    assert (baselines[-1].rows, baselines[-1].cols, baselines[-1].header.frame_id) == (ROWS, COLS, "plate")
    assert list(baselines[-1].valid) == [False] * SIZE


def test_a_baseline_that_the_parameters_take_away_is_withdrawn(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    baselines = start(rig, stream, tmp_path / "skin.npz")
    stream.start()
    calibrate(rig)
    await_baseline(rig, baselines)
    close_port(rig)
    assert rig.set_parameters(calibration_file="", rows=ROWS + 1) == (True, "")
    rig.spin_until(lambda: baselines[-1].source == Baseline.SOURCE_NONE, "that there is none any more")
    assert (baselines[-1].rows, baselines[-1].cols) == (ROWS + 1, COLS)
    assert list(baselines[-1].valid) == [False] * (SIZE + COLS)
    status = rig.status_until(lambda status: status.get("state") == "unconfigured", "the report")
    assert status.get("baseline", "none") == "none"


def test_a_file_of_another_skin_is_refused(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    path = tmp_path / "skin.npz"
    counts = np.full((COLS, ROWS), 12.5, dtype=np.float32)
    SavedBaseline(counts, counts / np.float32(10), counts > 0, BaselineSource.CALIBRATION, time_ns=0).save(path)
    with pytest.raises(SettingsError, match="6 x 8 taxels, the array has 8 x 6"):
        start(rig, stream, path)


@pytest.mark.parametrize(
    ("file", "words"),
    [("a" * 300, "cannot be read .*too long"), ("~nobody-of-this-name/skin.npz", "~nobody-of-this-name")],
    ids=["long", "nobodys"],
)
def test_a_file_that_cannot_even_be_looked_for_is_refused_and_the_node_goes_on(
    rig: Rig, stream: Stream, tmp_path: Path, file: str, words: str
) -> None:
    start_calibrated(rig, stream, tmp_path / "skin.npz")
    close_port(rig)
    done, reason = rig.set_parameters(calibration_file=file)
    assert not done
    assert re.search(words, reason)
    open_port(rig)
    calibrate(rig)


def test_a_calibration_that_cannot_be_stored_is_told_and_the_node_goes_on(
    rig: Rig, stream: Stream, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("")
    start(rig, stream, tmp_path / "file" / "skin.npz")
    stream.start()
    answer = ask_until(
        rig, "calibrate", lambda answer: "the baseline cannot be saved" in answer.message, "what is wrong"
    )
    assert not answer.success
    assert answer.message.startswith("calibrated until the driver ends, but not stored: ")
    rig.status_until(lambda status: status.get("baseline") == "calibration", "the report")


def test_a_calibration_that_a_slow_disk_holds_up_does_not_replace_a_newer_one(
    rig: Rig, stream: Stream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "skin.npz"
    is_back = threading.Event()
    stored: list[SavedBaseline] = []
    save = SavedBaseline.save

    def save_slowly(baseline: SavedBaseline, to: Path) -> None:
        stored.append(baseline)
        if len(stored) == 1:
            is_back.wait(20.0)
        save(baseline, to)

    monkeypatch.setattr(SavedBaseline, "save", save_slowly)
    start(rig, stream, path)
    stream.start()
    ask_until(rig, "calibrate", lambda answer: "takes longer than 0.5 s" in answer.message, "a calibration")
    stream.field = np.full(SIZE, 45, dtype=np.uint16)
    rig.spin_until(lambda: bool(rig.samples) and min(rig.samples[-1].counts) >= 45, "the new readings")
    sent = stream.sent
    rig.spin_until(lambda: stream.sent > sent + 300, "three seconds of them")
    ask_with_frames(rig, "calibrate")
    is_back.set()
    rig.spin_until(lambda: not [one for one in threading.enumerate() if one.name == "acts_background"], "the files")
    assert SavedBaseline.load(path, ROWS, COLS).counts[0, 0] == pytest.approx(45.5, abs=0.5)
    assert [one.name for one in tmp_path.iterdir() if "npz" in one.name] == ["skin.npz"]


def test_a_slow_board_can_be_tared_at_any_time(rig: Rig, stream: Stream, tmp_path: Path) -> None:
    stream.frame_s = 0.7
    start(rig, stream, tmp_path / "none.npz")
    stream.start()
    ask_until(rig, "tare", lambda answer: bool(answer.success), "a tare")
    # Also shortly before the next frame.
    until = stream.sent + 2
    while stream.sent < until:
        assert ask(rig, "tare").success
