# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate slip-sampled` on few contacts."""

import json
from pathlib import Path
from typing import Any

import pytest

from acts_core.sampling import SkinMap
from acts_core.skin import layout
from acts_tools.cli import main
from acts_tools.evaluate.slip import slip_sampled_command
from acts_tools.firmware.board_sampler import BoardSampler

pytestmark = pytest.mark.slow


def test_slip_is_told_soon_and_never_in_a_hold(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "out.json"
    words = ["--m", "128", "--seeds", "1", "--hold-s", "0.3", "--json", str(output)]
    assert main(["evaluate", "slip-sampled", *words]) == 0
    (entry,) = json.loads(output.read_text())["results"]
    assert entry["m"] == 128
    assert len(entry["delay_ms"]) == 15
    assert max(entry["delay_ms"]) < 15.0
    assert entry["false_holding"] == 0
    assert "| 128 |" in capsys.readouterr().out


def test_slip_is_told_as_soon_on_a_skin_whose_dead_taxels_are_known(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.json"
    words = ["evaluate", "slip-sampled", "--m", "128", "--seeds", "1", "--hold-s", "0.1", "--json", str(output)]
    lines = "row=20"
    assert main([*words, "--broken-taxels", lines]) == 0
    broken = json.loads(output.read_text())["results"][0]["delay_ms"]
    assert main([*words, "--broken-taxels", lines, "--dead-taxels", lines]) == 0
    report = json.loads(output.read_text())
    assert report["broken_taxels"] == report["dead_taxels"] == lines
    told = report["results"][0]["delay_ms"]
    assert None in broken or max(broken) > 15.0
    assert None not in told
    assert max(told) < 15.0
    assert main([*words, "--broken-taxels", "row=32"]) == 1
    assert "broken_taxels: 'row=32' is outside of an array of 32 x 32" in capsys.readouterr().err


def test_limits_can_be_set(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "out.json"
    words = ["--m", "128", "--seeds", "1", "--hold-s", "0.1", "--set", "slip_distance_m=0.02", "--json", str(output)]
    assert main(["evaluate", "slip-sampled", *words]) == 0
    report = json.loads(output.read_text())
    assert report["slip"]["slip_distance_m"] == 0.02
    # Nothing moves so far.
    assert set(report["results"][0]["delay_ms"]) == {None}
    assert main(["evaluate", "slip-sampled", "--set", "slip_sigma=4"]) != 0
    assert "slip_sigmas" in capsys.readouterr().err


def test_a_skin_of_which_the_node_tells_no_slip_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evaluate", "slip-sampled", "--layout", "square", "--seeds", "1"]) != 0
    assert "--layout square: the reconstruction tells no slip" in capsys.readouterr().err


def test_the_sampling_knows_how_the_taxels_lie_on_the_skin(monkeypatch: pytest.MonkeyPatch) -> None:
    """As a board that its driver has told; else it would follow a contact over the border of a patch."""
    maps: list[SkinMap | None] = []

    def sampler(*given: Any, **named: Any) -> BoardSampler:
        maps.append(named.get("skin_map"))
        return BoardSampler(*given, **named)

    monkeypatch.setattr(slip_sampled_command, "BoardSampler", sampler)
    words = ["--layout", "leap_right", "--m", "128", "--seeds", "1", "--hold-s", "0"]
    assert main(["evaluate", "slip-sampled", *words]) == 0
    assert set(maps) == {SkinMap.of(layout("leap_right"))}
