# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The reflexes of the simulated hand, without wires."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from ament_index_python.packages import get_package_share_directory

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState
from acts_recon.settings import ReconstructionSettings
from acts_sim.hand import HandWorldConfig, PatchTruth
from acts_tools.cli import main
from acts_tools.evaluate.hand import poke, scenarios, slip, sphere
from acts_tools.evaluate.hand.scenario import Outcome, Run
from acts_tools.hand_rigs.rig import HandRig, RigOptions

pytestmark = pytest.mark.slow


def test_the_same_seed_gives_the_same_bits() -> None:
    world = HandWorldConfig(seed=3, object="cylinder", object_held=True)
    rigs = [HandRig(world, RigOptions()) for _ in range(2)]
    for rig in rigs:
        rig.run(0.02)
        assert rig.supervisor.grasp() == ""
        rig.run(0.2)
    assert np.array_equal(rigs[0].goal_rad, rigs[1].goal_rad)
    assert rigs[0].regions == rigs[1].regions
    assert rigs[0].world.truth.as_dict() == rigs[1].world.truth.as_dict()


def test_the_skin_is_sampled_and_found_pressed_as_the_launch_file_has_it() -> None:
    path = Path(get_package_share_directory("acts_config")) / "params" / "hand_reflexes.yaml"
    parameters = {
        name.rpartition("/")[2]: node["ros__parameters"] for name, node in yaml.safe_load(path.read_text()).items()
    }
    options = RigOptions()
    sampling = asdict(options.sampling)
    same = {name: value for name, value in parameters["driver"].items() if name in sampling}
    assert same == {name: sampling[name] for name in same}
    assert len(same) >= 2
    # What the file leaves out holds, too: the node's own values.
    node = ReconstructionSettings(**parameters["reconstruction"])
    recovered = {"touch_counts": options.touch_counts, "noise_counts": options.noise_counts, **asdict(options.slip)}
    assert recovered == {name: getattr(node, name) for name in recovered}


@pytest.mark.parametrize("rate_hz", [10.0, 49.0])
def test_a_hand_with_slow_reflexes_is_asked_to_grasp_once_it_feels_touch(rate_hz: float) -> None:
    rig = HandRig(HandWorldConfig(object="cylinder", object_held=True), RigOptions(rate_hz))
    rig.begin_grasp()
    assert rig.run(0.2, lambda: rig.state is HandState.CLOSING)


def test_an_untouched_patch_is_searched_too() -> None:
    rig = HandRig(HandWorldConfig(object="cylinder", object_held=True), RigOptions())
    rig.run(0.1)
    rig.world.tip.poke("index_medial", 0.004, 0.05, 0.004, start_m=0.001)
    poked = lambda: next(one for one in rig.regions if one.name == "index_medial")  # noqa: E731
    assert rig.run(0.2, lambda: poked().in_contact)
    assert rig.world.truth.tip_depth_m < 0.003


def test_false_slips_are_counted_by_the_minute(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def made(one: Run) -> Outcome:
        return Outcome(kept=True, details={"held_s": 30.0, "false_slips": one.seed - 1, "slips_before": 2})

    monkeypatch.setitem(scenarios.SCENARIOS, "hold", made)
    path = tmp_path / "out.json"
    assert main(["evaluate", "hand", "--scenario", "hold", "--seeds", "3", "--json", str(path)]) == 0
    told = json.loads(path.read_text())["results"][-1]["false_slips"]
    assert told == {"per_minute": 2.0, "minutes": 1.5, "while_grasping": 6}
    assert "false slips: 3 in 1.5 min" in capsys.readouterr().out


def test_a_cylinder_that_nothing_pulls_does_not_slip(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(slip, "_HELD_S", 0.2)
    outcome = slip.hold(Run(100))
    assert outcome.ok
    assert outcome.details["false_slips"] == 0
    assert outcome.details["held_s"] == pytest.approx(0.2)


def test_how_hard_the_hand_grips_before_the_pull_is_told() -> None:
    outcome = slip.run(Run(703, reflex=False))
    grasped_n, before_n = (outcome.details[name] for name in ("grip_grasped_n", "grip_before_n"))
    assert 3.0 < grasped_n < 7.0
    assert before_n == pytest.approx(grasped_n, rel=0.2), "the release makes nothing grip harder"
    assert outcome.details["max_grip_n"] < 1.0, "it is pulled out of this grip"


def test_a_cylinder_that_is_pulled_by_twice_its_weight_is_held() -> None:
    outcome = slip.run(Run(5))
    assert outcome.details["load"] == 2.0
    assert outcome.kept
    assert outcome.noticed_ms is not None
    assert outcome.offset_mm is not None
    assert outcome.offset_mm < 10.0
    # It sticks to the skin before foam and fingers have come to rest.
    assert outcome.stopped_ms is not None
    assert 0.0 < outcome.details["stopped_sliding_ms"] < outcome.stopped_ms


def test_an_object_that_the_fingers_yield_to_moves_farther_than_it_slides() -> None:
    outcome = slip.run(Run(320))
    assert outcome.offset_mm is not None
    assert outcome.offset_mm > 0.25
    assert outcome.details["slid_mm"] < 0.2
    assert outcome.noticed_ms is None
    assert not outcome.ok, "0.2 mm of motion has to be noticed, however it comes about"


@pytest.mark.parametrize("seed", [848, 1090])
def test_a_blunt_end_that_brushes_the_next_segment_is_no_tip(seed: int) -> None:
    outcome = poke.blunt(Run(seed))
    assert outcome.ok
    assert outcome.details["alarms"] == 0


def test_sliding_is_the_mean_over_the_patches_weighted_by_force() -> None:
    truth = HandRig(HandWorldConfig(object="none"), RigOptions()).world.truth
    assert slip.sliding_m_s(replace(truth, patches={})) == 0.0
    patches = {"palm": PatchTruth(force_n=3.0, sliding_m_s=0.001), "index_distal": PatchTruth(1.0, 0.5, 0.005, 0.0)}
    assert slip.sliding_m_s(replace(truth, patches=patches)) == pytest.approx(0.002)


@pytest.mark.parametrize("size_m", [0.018, 0.025])
def test_a_sphere_that_was_brought_to_the_centre_stays_there_and_does_not_slip(size_m: float) -> None:
    """It rocked to and fro: joints went back to where they had been before they brought it there."""
    world = HandWorldConfig(seed=1, object="sphere", object_size_m=size_m)
    rig = HandRig(world, RigOptions(reflexes=("sharp", "slip", "sphere")))
    rig.run(0.5)
    assert rig.grasp()
    rig.run(2.0)
    at, slips = rig.object_m(), rig.reflexes["slip"].events
    rig.run(1.0)
    assert np.linalg.norm(rig.object_m() - at) < 0.0005
    assert rig.reflexes["slip"].events == slips
    palm = LEAP_RIGHT.regions["palm"]
    assert np.linalg.norm((rig.object_m() - palm.centre_m)[:2]) < 0.005


def test_the_command_runs_seeds_and_writes_shares_with_intervals(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def made(one: Run) -> Outcome:
        assert one.rate_hz == 60.0
        assert not one.reflex
        return Outcome(ok=one.seed != 4, kept=True, noticed_ms=float(one.seed))

    monkeypatch.setitem(scenarios.SCENARIOS, "slip", made)
    path = tmp_path / "out.json"
    words = ["evaluate", "hand", "--scenario", "slip", "--seed", "2", "--seeds", "4", "--reflex", "off"]
    assert main([*words, "--rate-hz", "60", "--json", str(path)]) == 0
    report = json.loads(path.read_text())
    assert [entry["seed"] for entry in report["results"]] == [2, 3, 4, 5, "all"]
    assert report["results"][-1]["ok"]["share"] == 0.75
    assert report["results"][-1]["ok"]["low"] == pytest.approx(0.30, abs=0.01)
    assert report["results"][-1]["noticed_ms"] == {"median": 3.5, "largest": 5.0, "runs": 4}
    assert "ok: 3 of 4" in capsys.readouterr().out


def test_further_reflexes_and_settings_are_those_of_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def made(one: Run) -> Outcome:
        rig = one.rig(HandWorldConfig(object="none"), one.options("slip", grip_force_n=0.15, slip_keep_s=0.5))
        assert list(rig.reflexes) == ["slip", "hand_to_hand"]
        assert rig.reflexes["slip"].config.slip_keep_s == 2.0
        rig.reflexes["hand_to_hand"].events = one.seed
        return Outcome(ok=True, kept=True)

    monkeypatch.setitem(scenarios.SCENARIOS, "hold", made)
    path = tmp_path / "out.json"
    words = ["evaluate", "hand", "--scenario", "hold", "--seeds", "2", "--json", str(path)]
    assert main([*words, "--also", "hand_to_hand", "slip", "--set", "slip_keep_s=2"]) == 0
    report = json.loads(path.read_text())
    assert (report["also"], report["set"]) == (["hand_to_hand", "slip"], {"slip_keep_s": 2.0})
    assert [entry["events"] for entry in report["results"][:2]] == [
        {"slip": 0, "hand_to_hand": 1},
        {"slip": 0, "hand_to_hand": 2},
    ]
    assert "hand_to_hand: set off 3 times in 2 runs" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--also", "slipp"), "did you mean 'slip'"),
        (("--set", "slip_keep=2"), "did you mean 'slip_keep_s'"),
        (("--set", "slip_keep_s=-1"), "slip_keep_s"),
        (("--set", "sphere_min_spread_m=0.05", "--also", "sphere"), "sphere_max_spread_m"),
    ],
)
def test_reflexes_and_settings_that_there_are_not_are_refused(
    words: tuple[str, ...], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["evaluate", "hand", "--scenario", "hold", *words]) != 0
    assert told in capsys.readouterr().err


@pytest.mark.parametrize("seed", [20, 17], ids=["large, far from the thumb", "small"])
def test_a_sphere_is_rolled_to_the_centre_and_gripped_there(seed: int) -> None:
    outcome = sphere.run(Run(seed))
    assert outcome.details["begin_mm"] == pytest.approx(20.0, abs=0.5)
    assert outcome.kept
    assert outcome.offset_mm is not None
    assert outcome.offset_mm < 5.0
    assert len(outcome.details["tips"]) >= 2


def test_a_sphere_that_lies_in_the_open_hand_is_gripped() -> None:
    world = HandWorldConfig(seed=1, pose="palm_up", object="sphere", object_size_m=0.034)
    rig = HandRig(world, RigOptions(reflexes=("sharp", "slip", "sphere")))
    assert rig.grasp()
    rig.run(1.0)
    assert not rig.world.truth.object_lost
    assert sum(one.in_contact for one in rig.regions) >= 3
