# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate wearables`: events on worn skins with their onset, and untouched skins of which nothing is told."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from acts_core.skin import layout
from acts_recon.impacts import Kind
from acts_sim.wearables import SCENES, worn_scene
from acts_tools.cli import main
from acts_tools.evaluate.wearables.watching import Watcher
from acts_tools.evaluate.wearables.wearables_command import SKINS, tally
from acts_tools.progress import Progress


def test_a_hit_and_an_untouched_skin_are_reported(tmp_path: Path) -> None:
    out = tmp_path / "wearables.json"
    words = ["evaluate", "wearables", "--scene", "helmet_hit", "--seeds", "1", "--untouched", "end_effector"]
    assert main([*words, "--minutes", "0.02", "--json", str(out), "--recordings", str(tmp_path)]) == 0
    hit, alone = json.loads(out.read_text())["results"]
    assert (hit["scene"], hit["figure"], hit["layout"]) == ("helmet_hit", "8E", "helmet")
    assert (hit["events"], hit["missed"], hit["false"], hit["as_expected"]) == (1, 0, 0, 1)
    # 25 hits: 0.95 ms at most.
    assert hit["onset_error_ms"]["max"] < 1.5
    assert hit["onset_within_2_ms"] == 1
    assert (alone["untouched"], alone["seconds"], alone["told"]) == ("end_effector", 1, 0)
    recording = np.load(tmp_path / "helmet_hit.npy")
    assert recording.dtype == np.uint16
    # Nothing is pressed before the hit, so that a board needs no calibration.
    assert recording[: len(recording) // 20].max() <= 1
    assert recording.max() > 200


def test_an_untouched_skin_is_the_same_whichever_others_are_watched(tmp_path: Path) -> None:
    out, told = tmp_path / "wearables.json", []
    for names in (["leg"], ["helmet", "leg"]):
        words = ["evaluate", "wearables", "--scene", "--untouched", *names, "--minutes", "0.02", "--json", str(out)]
        assert main(words) == 0
        told.append(json.loads(out.read_text())["results"][-1])
    assert told[0]["untouched"] == "leg"
    assert told[0] == told[1]


def test_noise_that_an_untouched_skin_cannot_be_calibrated_with_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["evaluate", "wearables", "--scene", "--untouched", "end_effector", "--minutes", "0.02"]
    assert main([*words, "--noise-counts", "100"]) == 1
    told = capsys.readouterr().err
    assert (
        "error: --noise-counts 100: by so much noise a driver takes the untouched skin end_effector for touched" in told
    )


def test_nothing_to_evaluate_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evaluate", "wearables", "--scene", "--untouched"]) == 1
    assert "--scene and --untouched name nothing; name a scene or a skin" in capsys.readouterr().err


def test_for_no_minutes_no_untouched_skin_is_watched(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "wearables.json"
    words = ["evaluate", "wearables", "--untouched", "end_effector", "--minutes", "0"]
    assert main([*words, "--scene", "helmet_hit", "--seeds", "1", "--json", str(out)]) == 0
    assert [entry.get("untouched") for entry in json.loads(out.read_text())["results"]] == [None]
    assert "untouched: end_effector not watched, since --minutes is 0\n" in capsys.readouterr().out
    assert main([*words, "--scene"]) == 1
    assert "error: --minutes is 0 and --scene names nothing; name a scene or a skin" in capsys.readouterr().err


def test_a_scene_that_was_added_is_evaluated(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(SCENES, "chest_tap", replace(SCENES["arm_tap"], name="chest_tap", layout="chest"))
    with Progress("chest_tap", 1) as progress:
        found = tally("chest_tap", 1, 64, 3.0, 1, progress)
    assert (found.events, found.missed, found.as_expected) == (1, 0, 1)


def test_there_is_a_layout_of_every_skin_that_is_watched() -> None:
    assert {layout(name).name for name in SKINS} == set(SKINS)


def test_the_onset_of_a_slow_touch_is_followed_back() -> None:
    shown = worn_scene("chest_touch", np.random.default_rng([1, 1]))
    told = Watcher(shown.layout, 3.0).watch(shown, 64, 3.0, 2)
    (_, begun), (_, over) = told
    true_s = shown.events[0].onset_s
    # Felt 10 ms late, since the hand comes at 0.05 m/s; 25 touches, when over: 2.4 ms at most, 0.7 in the mean.
    assert 0.005 < begun.onset_s - true_s < 0.015
    assert abs(over.onset_s - true_s) < 0.003
    assert over.kind is Kind.PRESS
    assert abs(over.onset_s - true_s) < 4 * over.onset_sd_s


def test_fingers_that_tap_together_are_one_tap() -> None:
    shown = worn_scene("arm_tap", np.random.default_rng([1, 0]))
    over = [impact for _, impact in Watcher(shown.layout, 3.0).watch(shown, 64, 3.0, 1) if impact.is_over]
    assert [impact.kind for impact in over] == [Kind.TAP]


def test_a_tap_that_looks_like_an_impact_has_the_onset_of_a_slow_touch() -> None:
    """Three fingers tap; one of them was felt 14 ms late, and its force had soon fallen to half."""
    shown = worn_scene("arm_tap", np.random.default_rng([2, 3]))
    over = [impact for _, impact in Watcher(shown.layout, 3.0).watch(shown, 64, 3.0, 4) if impact.is_over]
    assert abs(over[0].onset_s - shown.events[0].onset_s) < 0.002


def test_a_footstep_is_one_step_from_heel_to_toes() -> None:
    shown = worn_scene("footstep", np.random.default_rng([1, 1]))
    over = [impact for _, impact in Watcher(shown.layout, 3.0).watch(shown, 64, 3.0, 2) if impact.is_over]
    assert [impact.kind for impact in over] == [Kind.STEP]
    # 25 steps: 0.75 ms at most.
    assert abs(over[0].onset_s - shown.events[0].onset_s) < 0.001
    assert over[0].duration_s == pytest.approx(max(one.end_s for one in shown.contacts) - over[0].onset_s, abs=0.03)
