# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the scenarios of the hand tell of an object that is not grasped, and of one that is pulled; with a hand of plain
numbers.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState
from acts_sim.hand import HandWorldConfig
from acts_tools.evaluate.hand.scenario import Run
from acts_tools.evaluate.hand.scenarios import SCENARIOS

_PALM_M = np.array(LEAP_RIGHT.regions["palm"].centre_m)


class _Hand:
    """A hand that grasps or does not, and from which the object is moved by 4 mm when it is pulled."""

    behind_s = 0.0

    def __init__(self, *, grasps: bool) -> None:
        self._grasps = grasps
        self.state = HandState.HOLDING if grasps else HandState.OPEN
        self.regions = [SimpleNamespace(name=name, in_contact=True) for name in ("palm", "middle_distal")]
        self._object_m = _PALM_M
        disturbances = SimpleNamespace(pull=self._pull)
        truth = SimpleNamespace(object_lost=False)
        self.world = SimpleNamespace(put=self._put, disturbances=disturbances, truth=truth, weight_n=1.0, down=_PALM_M)

    def run(self, *_: Any) -> bool:
        return True

    def begin_grasp(self) -> None:
        pass

    def grasp(self) -> bool:
        return self._grasps

    def object_m(self) -> np.ndarray:
        return self._object_m

    def _put(self, *_: Any) -> None:
        self._object_m = _PALM_M + np.array((0.003, 0.0, 0.0))

    def _pull(self, *_: Any) -> None:
        self._object_m = _PALM_M + np.array((0.003, 0.004, 0.0))


@pytest.mark.parametrize("name", SCENARIOS)
def test_what_was_not_grasped_was_not_kept(name: str) -> None:
    outcome = SCENARIOS[name](Run(1, rig=lambda *_: _Hand(grasps=False)))
    assert outcome.details["failed"] == "not grasped"
    assert outcome.kept is False
    assert not outcome.ok


def test_how_far_off_a_small_sphere_is_is_told_after_the_pull() -> None:
    outcome = SCENARIOS["small_sphere"](Run(1, rig=lambda *_: _Hand(grasps=True)))
    assert outcome.kept
    assert outcome.details["before_pull_mm"] == pytest.approx(3.0)
    assert outcome.offset_mm == pytest.approx(5.0)


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_seed_has_its_hand(name: str) -> None:
    """Commands take larger seeds than the parameter of a node."""

    class MadeError(Exception):
        pass

    def made(world: HandWorldConfig, _: Any) -> Any:
        worlds.append(world)
        raise MadeError

    worlds: list[HandWorldConfig] = []
    for seed in (5, 2**31 + 5, 2**63 - 1):
        with pytest.raises(MadeError):
            SCENARIOS[name](Run(seed, rig=made))
    assert [world.seed for world in worlds] == [5, 5, 2**31 - 1]
