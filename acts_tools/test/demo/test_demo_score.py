# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Scoring, table and picture of the demo on made-up recordings with known errors."""

from pathlib import Path

import numpy as np
import pytest

from acts_core.array import ArrayGeometry
from acts_tools.demo.ball.picture import draw
from acts_tools.demo.ball.recording import Recording, Track
from acts_tools.demo.ball.score import rms_error_mm, score, table


def make_recording(*, offset_m: float = 0.001, rate_hz: float = 1000.0) -> Recording:
    """4 s of each segment; the ball runs parallel to the reference at a known distance."""
    recording = Recording(contact_rate_hz=rate_hz, contacts_received=16000, finished=True)
    names = ["hold", "N", "B", "I"]
    for step in range(1600):
        time_s = 100.0 + step * 0.01
        x_m = 0.02 * np.sin(step * 0.01)
        recording.reference.add(time_s, x_m, 0.0)
        recording.segments.append(names[step // 400])
        # The first second is far off, as when the ball has just been put down.
        recording.truth.add(time_s, x_m, 0.03 if step < 100 else offset_m)
        recording.tilt_time_s.append(time_s)
        recording.tilt_commanded_rad.append((0.01, 0.02))
        recording.tilt_measured_rad.append((0.01, 0.02))
    recording.latencies_s = [np.linspace(0.001, 0.003, 1001, dtype=np.float32)]
    recording.segment_pressure = {name: np.ones((32, 32)) for name in names}
    recording.cpu_percent = {"driver": 21.04}
    return recording


def test_errors_and_percentiles_are_those_put_in() -> None:
    results = score(make_recording(offset_m=0.0015))
    assert results["ok"]
    assert results["rms_mm"] == {"hold": 1.5, "N": 1.5, "B": 1.5, "I": 1.5}
    assert results["latency_ms"]["median"] == pytest.approx(2.0, abs=0.01)
    assert results["latency_ms"]["p99"] == pytest.approx(2.98, abs=0.01)
    assert results["cpu_percent"] == {"driver": 21.0}


def test_the_first_two_seconds_of_holding_do_not_count() -> None:
    recording = make_recording()
    assert rms_error_mm(recording, "hold", skip_s=2.0) == pytest.approx(1.0)
    error = rms_error_mm(recording, "hold")
    assert error is not None
    assert error > 10


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"contact_rate_hz": 990.0}, "990.0 contacts/s"),
        ({"frames_lost": 1}, "1 frame lost between"),
        ({"stop_reason": "touch is stale"}, "touch is stale"),
        ({"finished": False}, "did not come to its end"),
        ({"reference": Track(), "segments": []}, "no segment was traced"),
    ],
)
def test_what_was_not_good_enough_is_named(change: dict[str, object], words: str) -> None:
    recording = make_recording()
    for name, value in change.items():
        setattr(recording, name, value)
    results = score(recording)
    assert not results["ok"]
    assert any(words in failure for failure in results["failures"])
    assert words in table(results)


def test_a_letter_out_of_bounds_fails_the_run() -> None:
    results = score(make_recording(offset_m=0.006))
    assert not results["ok"]
    assert len(results["failures"]) == 4


@pytest.mark.parametrize("track", ["truth", "reference"])
@pytest.mark.parametrize("kept", [slice(0, 400), slice(430, None)])
def test_a_demo_that_could_not_watch_itself_is_not_good(track: str, kept: slice) -> None:
    recording = make_recording()
    watched: Track = getattr(recording, track)
    rows = list(zip(watched.time_s, watched.x_m, watched.y_m, strict=True))
    # The first and the last arrived, as when the observer is held up.
    rows = [rows[0], *rows[kept], rows[-1]]
    setattr(recording, track, Track(*(list(column) for column in zip(*rows, strict=True))))
    if track == "reference":
        names = recording.segments
        recording.segments = [names[0], *names[kept], names[-1]]
    results = score(recording)
    assert not results["ok"]
    assert any("received nothing for" in failure for failure in results["failures"])


def test_a_ball_that_fell_off_is_told_as_that_and_not_as_a_demo_that_received_nothing() -> None:
    recording = make_recording()
    recording.finished, recording.has_fallen = False, True
    truth = recording.truth
    recording.truth = Track(truth.time_s[:900], truth.x_m[:900], truth.y_m[:900])
    assert score(recording)["failures"] == ["the ball fell off the plate", "the trajectory did not come to its end"]
    # What was missed before it fell is told nevertheless.
    del recording.truth.time_s[500:600], recording.truth.x_m[500:600], recording.truth.y_m[500:600]
    assert any("received nothing for 1.0 s" in failure for failure in score(recording)["failures"])
    recording.truth = Track()
    assert "the ball fell off the plate" in score(recording)["failures"]


def test_a_nan_error_is_a_failure() -> None:
    recording = make_recording()
    recording.truth.x_m[1000] = float("nan")
    assert not score(recording)["ok"]


def test_a_letter_that_was_not_traced_is_null_and_no_failure() -> None:
    recording = make_recording()
    recording.segments = ["hold"] * len(recording.segments)
    results = score(recording)
    assert results["ok"]
    assert results["rms_mm"]["N"] is None


def test_picture_and_table_show_every_part(tmp_path: Path) -> None:
    recording = make_recording()
    results = score(recording)
    draw(recording, results, ArrayGeometry(), tmp_path / "out" / "picture.png")
    assert (tmp_path / "out" / "picture.png").read_bytes().startswith(b"\x89PNG")
    for words in ("contacts received", "I traced", "CPU, driver", "result: good"):
        assert words in table(results)


def test_a_run_without_any_data_is_scored_and_drawn(tmp_path: Path) -> None:
    recording = Recording()
    results = score(recording)
    assert not results["ok"]
    draw(recording, results, ArrayGeometry(), tmp_path / "empty.png")
    assert (tmp_path / "empty.png").stat().st_size > 1000
