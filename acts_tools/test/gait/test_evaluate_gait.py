# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate gait`, and the steps of random walks and of recorded insoles."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from acts_core.errors import RecordingError
from acts_recon.gait import GaitTracker
from acts_sim.walking import Walk, walk
from acts_tools.cli import main
from acts_tools.evaluate.gait.force_curve import rises_s
from acts_tools.evaluate.gait.insoles import read_insoles

pytestmark = pytest.mark.slow


@settings(max_examples=15)
@given(
    cadence=st.floats(30.0, 180.0),
    stance=st.floats(0.5, 0.75),
    weight=st.floats(1e-3, 1e6),
    noise=st.floats(0.0, 0.03),
    offset=st.floats(-0.2, 0.35),
    rate_hz=st.sampled_from([8.0, 13.0, 30.0, 100.0]),
    seed=st.integers(0, 1000),
)
@example(cadence=58.0, stance=0.75, weight=1.0, noise=0.02734375, offset=-0.1875, rate_hz=8.0, seed=367)
@example(cadence=100.0, stance=0.62, weight=700.0, noise=0.01, offset=0.0, rate_hz=1000.0, seed=1)
def test_any_walk_has_its_steps(
    cadence: float, stance: float, weight: float, noise: float, offset: float, rate_hz: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    stride_s = 120.0 / cadence
    walking = walk(Walk(cadence_per_min=cadence, stance_share=stance), 6.0 + 7 * stride_s, rng)
    time_s = np.arange(rng.uniform(0.0, 1.0 / rate_hz), walking.duration_s, 1.0 / rate_hz)
    if min(stance, 1.0 - stance) * stride_s < 3.0 / rate_hz:
        return  # Too few samples in a stance or a swing: docs/gait.md, Limits.
    tracker = GaitTracker()
    for foot in range(2):
        force = walking.force_n(foot, time_s) / walking.walk.weight_n + noise * rng.standard_normal(time_s.size)
        steps = [
            step
            for at_s, value in zip(time_s.tolist(), (weight * (force + offset)).tolist(), strict=True)
            for step in tracker.step(foot, at_s, value)
        ]
        steps += tracker.finish()[foot]
        true = [footfall for footfall in walking.footfalls[foot] if footfall.is_whole]
        assert len(steps) == len(true)
        for step, footfall in zip(steps, true, strict=True):
            assert step.strike_s == pytest.approx(footfall.above_s(0.25)[0], abs=0.6 / rate_hz + 0.03)
    assert tracker.gait().cadence_per_min == pytest.approx(cadence, rel=0.06)


def test_simulated_walks(tmp_path: Path) -> None:
    out = tmp_path / "gait.json"
    assert main(["evaluate", "gait", "--seeds", "2", "--rate", "8", "50", "--json", str(out)]) == 0
    slow, fast = json.loads(out.read_text())["results"]
    for entry in (slow, fast):
        assert entry["found"] == entry["steps"] > 20
        assert (entry["wrong"], entry["steps_of_standing"]) == (0, 0)
        assert entry["centre_error_mm"] < 1.0
    assert fast["strike_error_ms"]["sd"] < 3.0
    assert slow["strike_error_ms"]["sd"] < 40.0
    assert fast["double_support_error"] < 0.03


def test_recorded_walks_have_the_steps_of_their_force_curve(
    recording_path: Callable[[str], Path], tmp_path: Path
) -> None:
    out = tmp_path / "gait.json"
    assert main(["evaluate", "gait", "--frames", str(recording_path("insole/pairs.npz")), "--json", str(out)]) == 0
    results = json.loads(out.read_text())["results"]
    assert [entry["recording"].split()[1] for entry in results] == ["standing"] * 5 + ["walking"] * 2
    # In the first two somebody shifts the weight, and mostly does not lift the feet: what is a step there is open.
    for entry in results[2:]:
        for foot in entry["feet"].values():
            assert abs(foot["steps"] - foot["curve_steps"]) <= 2
            assert foot["cadence_per_min"] == pytest.approx(foot["curve_cadence_per_min"], rel=0.06)
    walks = [foot for entry in results[5:] for foot in entry["feet"].values()]
    assert sum(abs(foot["steps"] - foot["curve_steps"]) for foot in walks) <= 1
    assert all(foot["progress_m"] > 0.005 for foot in walks)
    assert all(0.05 < entry["double_support"] < 0.3 for entry in results[5:])


def test_the_force_curve_shows_steps_and_what_stands_has_none() -> None:
    time_s = np.arange(0.0, 10.0, 0.1)
    walks = (time_s % 1.0 < 0.55).astype(float)
    assert rises_s(time_s, walks) == pytest.approx(np.arange(1.0, 10.0), abs=1e-6)
    assert rises_s(time_s, 1.0 + 0.1 * walks).size == 0


def test_one_foot_with_a_rate_and_labels(tmp_path: Path) -> None:
    path, out = tmp_path / "one.npz", tmp_path / "out.json"
    walking = walk(Walk(), 15.0, np.random.default_rng(1))
    frames = walking.frames(np.arange(0.0, 15.0, 0.05), np.random.default_rng(1))[:, 0]
    np.savez(path, frames=frames, rate_hz=20.0, start=[0, 100], length=[300, 200], label=["all", "end"])
    assert main(["evaluate", "gait", "--frames", str(path), "--json", str(out)]) == 0
    whole, end = json.loads(out.read_text())["results"]
    assert (whole["recording"], end["recording"]) == ("0 all", "1 end")
    assert list(whole["feet"]) == ["left"]
    assert whole["feet"]["left"]["steps"] == whole["feet"]["left"]["curve_steps"] > end["feet"]["left"]["steps"] > 3
    assert whole["cadence_per_min"] == pytest.approx(110.0, rel=0.04)
    assert whole["double_support"] is None


@pytest.mark.parametrize("name", ["time_s", "rate_hz"])
def test_what_acts_export_writes_of_one_insole_has_its_steps(name: str, tmp_path: Path) -> None:
    time_s = np.arange(0.0, 15.0, 0.05)
    walking = walk(Walk(), 15.0, np.random.default_rng(1))
    frames = walking.frames(time_s, np.random.default_rng(1))[:, 0]
    np.savez(tmp_path / "frames.npz", frames=frames, rate_hz=20.0)
    times: dict[str, Any] = {name: {"time_s": time_s, "rate_hz": 20.0}[name]}
    np.savez(tmp_path / "image.npz", image=frames, stamp_ns=(1e9 * time_s).astype(np.int64), **times)
    found = []
    for path in (tmp_path / "frames.npz", tmp_path / "image.npz"):
        assert main(["evaluate", "gait", "--frames", str(path), "--json", str(tmp_path / "out.json")]) == 0
        found.append(json.loads((tmp_path / "out.json").read_text())["results"][0]["feet"]["left"])
    assert found[0]["steps"] > 5
    assert found[1]["steps"] == found[0]["steps"]
    assert found[1]["cadence_per_min"] == pytest.approx(found[0]["cadence_per_min"])


def test_insoles_without_a_step_are_nothing_to_compare(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "none.npz"
    np.savez(path, frames=np.zeros((100, 2, 5, 5)), rate_hz=20.0)
    assert main(["evaluate", "gait", "--frames", str(path)]) == 1
    said = capsys.readouterr().err
    assert "nothing could be compared" in said
    assert "frames hold 0 to 0; needed are recordings of somebody who walks" in said


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frames": np.zeros((4, 3, 5, 5))}, r"frames \(4, 3, 5, 5\), float64: needed are `frames`"),
        ({"frames": np.zeros(4)}, "needed are `frames`"),
        ({"frames": np.where(np.arange(4)[:, None, None] == 2, np.nan, np.zeros((4, 5, 5)))}, "1 of 4 frames hold NaN"),
        ({"frames": np.full((4, 2, 5, 5), np.inf)}, "the first of them is numbered 0; needed are numbers"),
        ({"t_s": np.arange(3.0)}, "needed are `frames`"),
        ({"t_s": np.zeros(4)}, "not ascend"),
        (
            {"t_s": np.array([0.0, 0.1, 0.1, 0.2])},
            "recording 0 do not ascend: the frame numbered 2 is of 0.1 s, the one before of 0.1 s; leave out",
        ),
        (
            {"t_s": np.array([0.0, 0.1, 0.2, 0.1]), "start": [0, 1], "length": [1, 3]},
            "recording 1 do not ascend: the frame numbered 3 is of 0.1 s, the one before of 0.2 s",
        ),
        ({"t_s": np.full(4, np.nan)}, "needed are `frames`"),
        ({"t_s": np.array([0.0, 0.1, np.nan, 0.2])}, "t_s of the frame numbered 2 is nan; leave out such frames"),
        ({"rate_hz": 0.0}, "neither t_s nor one rate_hz"),
        ({"rate_hz": 1e9}, "neither t_s nor one rate_hz"),
        ({"start": [0], "length": [5]}, "beyond the 4 frames"),
        ({"start": [-1], "length": [2]}, "do not fit"),
        ({"start": [0.5], "length": [2]}, "do not fit"),
        ({"start": [0, 2], "length": [0, 0]}, "all recordings have the length 0"),
    ],
)
def test_files_that_do_not_fit_are_refused(tmp_path: Path, change: dict[str, Any], message: str) -> None:
    path = tmp_path / "insoles.npz"
    np.savez(path, **{"frames": np.zeros((4, 2, 5, 5)), "rate_hz": 8.0, **change})
    with pytest.raises(RecordingError, match=message):
        read_insoles(path)


def test_numbers_of_frames_may_be_floats_that_are_whole(tmp_path: Path) -> None:
    path = tmp_path / "insoles.npz"
    np.savez(path, frames=np.zeros((4, 2, 5, 5)), rate_hz=8.0, start=[0.0, 3.0], length=[3.0, 1.0])
    assert [len(one.frames) for one in read_insoles(path)] == [3, 1]


def test_a_file_without_frames_is_told_apart_from_frames_of_another_shape(tmp_path: Path) -> None:
    np.savez(tmp_path / "other.npz", pressure=np.zeros((4, 5, 5)), rate_hz=8.0)
    with pytest.raises(RecordingError, match="no array `frames`; needed are"):
        read_insoles(tmp_path / "other.npz")
