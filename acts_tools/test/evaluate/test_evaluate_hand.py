"""The reflexes of the simulated hand, without wires."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from acts_sim.hand import HandWorldConfig
from acts_tools.cli import main
from acts_tools.evaluate.hand import scenarios, slip
from acts_tools.evaluate.hand.rig import HandRig, RigOptions
from acts_tools.evaluate.hand.scenario import Outcome, Run

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


def test_a_cylinder_that_is_pulled_by_twice_its_weight_is_held() -> None:
    outcome = slip.run(Run(5))
    assert outcome.details["load"] == 2.0
    assert outcome.kept
    assert outcome.noticed_ms is not None
    assert outcome.offset_mm is not None
    assert outcome.offset_mm < 10.0


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


def test_a_rate_that_the_hand_does_not_have_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evaluate", "hand", "--scenario", "slip", "--rate-hz", "5"]) != 0
    assert "allowed is 10 to 500" in capsys.readouterr().err
