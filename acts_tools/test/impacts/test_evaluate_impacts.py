# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate impacts`, `ricochet` and `edges`: what they report of a few balls and edges."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from acts_recon.impacts import UNKNOWN_DIRECTION_SD_RAD, Impact, Kind
from acts_sim.impacts import Scene
from acts_tools.cli import main
from acts_tools.evaluate.impacts import edges_command, plays, ricochet_command
from acts_tools.evaluate.impacts.impacts_command import TOUCH_MS, drops_of, seen_by_us
from acts_tools.evaluate.impacts.ricochet_command import numbered_throw, told_by_us


def test_bounces_are_told_and_seen_as_often_as_by_the_papers_method(tmp_path: Path) -> None:
    out = tmp_path / "impacts.json"
    assert main(["evaluate", "impacts", "--seeds", "2", "--m", "64", "--json", str(out)]) == 0
    report = json.loads(out.read_text())
    paper, adaptive, tracking = report["results"]
    assert (paper["method"], adaptive["scheme"], tracking["scheme"]) == ("paper", "adaptive", "tracking")
    for entry in report["results"]:
        assert entry["drops"] == entry["seen"] == entry["told"] == 2
        # 8.7 ms at 874 frames/s.
        assert 6 < entry["frames"] < 8.5
        assert 0.1 < entry["force_change"] < 0.4
    for ours in (adaptive, tracking):
        assert ours["told_as_bounce"] == 2
        assert ours["onset_error_ms"]["mean"] < 0.7
        assert ours["impulse_share"]["mean"] == pytest.approx(1.1, abs=0.3)


def test_of_several_touches_that_are_told_the_strongest_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    (shown,) = drops_of(1, 1, TOUCH_MS)
    truth = shown.collisions[0]
    begin_s, largest_n = float(truth.time_s[0]), float(truth.force_n.max())

    def touch(number: int, after_s: float, peak_n: float, *, is_over: bool) -> tuple[float, Impact]:
        onset_s, frames = begin_s + after_s, 3 + number
        force_n = np.array([peak_n / 2, peak_n])
        told = Impact(
            number, is_over, Kind.IMPACT, onset_s, 1e-3, 0.008, frames, 0, 0, peak_n, 0, True, force_n=force_n
        )
        return onset_s + 0.001, told

    def play(_ours: plays.Ours, _scene: Scene, _seed: int) -> list[tuple[float, Impact]]:
        # One that did not happen begins first and is over first; the true one is number 2, and a third never ends.
        begun = [touch(number, after_s, 0.1, is_over=False) for number, after_s in ((1, -0.01), (2, 0.0), (3, 0.002))]
        return [*begun, touch(1, -0.01, 0.1, is_over=True), touch(2, 0.0, largest_n, is_over=True)]

    monkeypatch.setattr(plays.Ours, "play", play)
    entry = seen_by_us([shown], "adaptive", 64, 3.0)
    assert (entry["told"], entry["told_further"], entry["told_as_bounce"]) == (1, 2, 1)
    assert (entry["frames"], entry["onset_within_1_sigma"]) == (5, 1)
    assert entry["onset_error_ms"]["mean"] == pytest.approx(0, abs=1e-6)
    assert entry["delay_ms"]["mean"] == pytest.approx(1)
    assert entry["peak_share"]["mean"] == pytest.approx(1)


def test_of_several_touches_of_a_throw_the_direction_of_the_strongest_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    def touch(number: int, peak_n: float, direction_rad: float, sd_rad: float) -> tuple[float, Impact]:
        told = Impact(
            number,
            True,
            Kind.IMPACT,
            0.1,
            1e-3,
            0.008,
            5,
            0,
            0,
            peak_n,
            0,
            direction_rad=direction_rad,
            direction_sd_rad=sd_rad,
        )
        return 0.11, told

    told = [touch(1, 0.1, 2.0, 0.01), touch(2, 3.0, math.radians(91), math.radians(2)), touch(3, 0.5, -1.0, 0.01)]
    monkeypatch.setattr(plays.Ours, "play", lambda *_: told)
    ours, shown = plays.Ours("tracking", 64, 3.0), numbered_throw(2.0, 90, 1, 0)
    assert told_by_us(ours, shown, 1, 90) == pytest.approx((1.0, 2.0))
    told[1] = touch(2, 3.0, 0.0, UNKNOWN_DIRECTION_SD_RAD)
    assert told_by_us(ours, shown, 1, 90) is None


def test_the_throws_of_a_speed_that_is_named_twice_count_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ricochet_command, "told_by_us", lambda *_: (1.0, 2.0))
    monkeypatch.setattr(ricochet_command.PaperDirections, "direction_rad", lambda *_: None)
    out = tmp_path / "ricochet.json"
    assert main(["evaluate", "ricochet", "--seeds", "1", "--speeds", "2", "2.0", "--json", str(out)]) == 0
    report = json.loads(out.read_text())
    assert report["speeds"] == [2]
    *angles, whole = report["results"]
    assert len(angles) == whole["throws"] == 8
    # By Wilson, of 8 of 8; of 16 of 16 it would be 0.81.
    assert whole["acts"]["within_1_sigma_95"] == pytest.approx([0.676, 1.0], abs=0.001)


def test_directions_are_told_better_than_by_the_papers_method(tmp_path: Path) -> None:
    out = tmp_path / "ricochet.json"
    words = ["evaluate", "ricochet", "--seeds", "1", "--speeds", "2", "--json", str(out)]
    assert main([*words, "--recordings", str(tmp_path)]) == 0
    *angles, whole = json.loads(out.read_text())["results"]
    assert [entry["angle_deg"] for entry in angles] == [0, 45, 90, 135, 180, -135, -90, -45]
    assert whole["throws"] == 8
    written = [np.load(tmp_path / f"throw_2_m_s_{angle}_deg.npy") for angle in range(0, 360, 45)]
    # A second, untouched at both ends, with a touch of some milliseconds.
    assert all(len(frames) == 8000 and not frames[0].any() and not frames[-1].any() for frames in written)
    assert all(20 < np.count_nonzero(frames.max(axis=(1, 2)) > 50) < 200 for frames in written)
    assert whole["acts"]["unknown"] == 0
    assert whole["acts"]["mean_deg"] < 3 < whole["paper"]["mean_with_guesses_deg"]


def test_edges_are_told_with_their_force_and_place(tmp_path: Path) -> None:
    out = tmp_path / "edges.json"
    words = ["--seeds", "4", "--scheme", "tracking", "random", "tracking", "--m", "64", "64", "--json", str(out)]
    assert main(["evaluate", "edges", *words]) == 0
    report = json.loads(out.read_text())
    assert [(entry["scheme"], entry["m"]) for entry in report["results"]] == [("tracking", 64), ("random", 64)]
    tracking, random = report["results"]
    assert (tracking["edges"], tracking["told"], tracking["with_direction"]) == (4, 4, 0)
    assert tracking["peak_share"]["p5"] > 0.9
    assert tracking["peak_share"]["max"] < 1.1
    assert tracking["off_mm"]["max"] < 1.0
    assert random["peak_share"]["max"] < 1.6


def test_of_edges_of_which_no_impact_is_told_there_are_no_numbers() -> None:
    scores = edges_command.scores_of([None, None])
    assert (scores["edges"], scores["told"], scores["with_direction"]) == (2, 0, 0)
    assert scores["peak_share"]["p5"] is scores["peak_share"]["max"] is scores["off_mm"]["median"] is None
