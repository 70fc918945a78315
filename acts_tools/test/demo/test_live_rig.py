# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The rig over the real interfaces begins as the rig in one process does: with an open hand, and then it closes."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState
from acts_core.errors import LaunchError
from acts_core.skin import layout
from acts_sim.hand import COLUMN, HandWorld, HandWorldConfig, carry_out, row_width
from acts_tools.hand_rigs.live import LiveHand
from acts_tools.hand_rigs.live_rig import LiveRig, LiveTip
from acts_tools.hand_rigs.recording import HandRecording, StatusSample

STEP_S = 0.002
OPEN_RAD = np.array(LEAP_RIGHT.postures["open"])
SUNK_RAD = np.where([name.endswith("mcp_side") for name in LEAP_RIGHT.names], 0.6, 0.0)


class SunkHand:
    """A hand whose fingers sank before its motors had torque; what it is asked for begins a little later.

    The first `lost` times that it is asked to open, its motors are lost before it does.
    """

    def __init__(self, ends_in: HandState, lost: int = 0) -> None:
        self._lost = lost
        patches = tuple(patch.name for patch in layout("leap_right").patches)
        self.recording = HandRecording(patches=patches)
        self.asked: list[str] = []
        self.q_rad = self.q_when_asked_to_grasp = SUNK_RAD.copy()
        # Before any time that the machine runs: what is told is old enough to be read at once.
        self.time_s = -100.0
        self._ends_in = ends_in
        self._to_come: list[tuple[float, HandState]] = []
        self._tell(HandState.STOPPED)

    def ask(self, name: str, _mark: str = "") -> float:
        self.asked.append(name)
        if name == "release":
            is_lost, self._lost = self._lost > 0, self._lost - 1
            self._to_come = [(self.time_s + 0.02, HandState.STOPPED if is_lost else HandState.OPEN)]
        else:
            self.q_when_asked_to_grasp = self.q_rad.copy()
            self._to_come = [(self.time_s + 0.02, HandState.CLOSING), (self.time_s + 0.4, self._ends_in)]
        return self.time_s

    def until(self, condition: Callable[[], bool], _timeout_s: float) -> bool:
        while not condition():
            self._pass()
        return True

    def _pass(self) -> None:
        row = np.zeros(row_width(len(self.recording.patches)))
        self.time_s += STEP_S
        while self._to_come and self._to_come[0][0] <= self.time_s:
            self._tell(self._to_come.pop(0)[1])
        if self.recording.statuses[-1].state == HandState.OPEN:
            self.q_rad += np.clip(OPEN_RAD - self.q_rad, -3.0 * STEP_S, 3.0 * STEP_S)
        row[COLUMN["q_rad"]] = self.q_rad
        row[COLUMN["object_quaternion"]] = 1.0, 0.0, 0.0, 0.0
        row[COLUMN["tip_patch"]] = -1.0
        self.recording.truth_times.append(np.array([self.time_s]))
        self.recording.truth_rows.append(row[np.newaxis])

    def _tell(self, state: HandState) -> None:
        self.recording.statuses.append(StatusSample(self.time_s, int(state), "made", (), {"slip": 0}))


@pytest.mark.parametrize("ends_in", [HandState.HOLDING, HandState.OPEN])
def test_a_hand_that_sank_is_open_before_it_grasps(ends_in: HandState) -> None:
    hand = SunkHand(ends_in)
    rig = LiveRig(cast(LiveHand, hand), HandWorldConfig(object="cylinder", object_held=True))
    assert np.abs(np.array(rig.truth().q_rad) - OPEN_RAD).max() < 0.06
    assert hand.asked == ["release"]
    # The status says OPEN for a moment after the grasp was asked for: that is not its end.
    assert rig.grasp() is (ends_in is HandState.HOLDING)
    assert rig.state is ends_in
    assert hand.asked == ["release", "grasp"]
    assert np.abs(hand.q_when_asked_to_grasp - OPEN_RAD).max() < 0.06


def test_a_tip_starts_where_it_does_in_one_process() -> None:
    lines: list[str] = []
    rig = SimpleNamespace(do=lambda line, _mark: lines.append(line))
    worlds = [HandWorld(HandWorldConfig(object="none")) for _ in range(2)]
    LiveTip(cast(LiveRig, rig)).poke("index_medial", 0.0005, 0.05, 0.006, start_m=0.002, row=3.25, col=2.5)
    carry_out(worlds[0], lines[0])
    worlds[1].tip.poke("index_medial", 0.0005, 0.05, 0.006, start_m=0.002, row=3.25, col=2.5)
    for world in worlds:
        world.step()
    assert worlds[0].truth.tip_depth_m == pytest.approx(worlds[1].truth.tip_depth_m, abs=1e-9)


def test_a_hand_that_lost_its_motors_is_asked_again_to_open_but_not_for_ever() -> None:
    hand = SunkHand(HandState.HOLDING, lost=2)
    rig = LiveRig(cast(LiveHand, hand), HandWorldConfig(object="cylinder", object_held=True))
    assert np.abs(np.array(rig.truth().q_rad) - OPEN_RAD).max() < 0.06
    assert hand.asked == ["release"] * 3
    with pytest.raises(LaunchError, match="did not open within 2 s, asked 3 times"):
        LiveRig(cast(LiveHand, SunkHand(HandState.HOLDING, lost=3)), HandWorldConfig(object="cylinder"))
