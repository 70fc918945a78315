# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The hand holds another hand, which moves by 20 mm and turns by 20 degrees."""

from __future__ import annotations

import math

import numpy as np

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandToHandConfig
from acts_sim.hand import HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome, Run

_WAY_M = 0.020
_TURN_RAD = math.radians(20.0)
_MOTION_S = 1.5
_PHALANGES = 3
_LOST_FOR_S = 0.1


def run(one: Run) -> Outcome:
    """Three phalanges must stay in contact, and no region may exceed the force limit."""
    draw = one.draw()
    world = HandWorldConfig(seed=one.world_seed, pose="thumb_up", object="other_hand", object_held=True)
    reflexes = ("slip", "hand_to_hand") if one.reflex else ("slip",)
    rig = one.rig(world, one.options(*reflexes, grip_force_n=0.3))
    outcome = Outcome(kept=False)
    if not rig.grasp():
        outcome.details["failed"] = "not grasped"
        return outcome
    rig.run(0.5)
    # Along the palm and slightly across it, never into it.
    way = draw.standard_normal(3) * (1.0, 1.0, 0.3)
    way *= _WAY_M / np.linalg.norm(way)
    way[2] = -abs(way[2])
    axis = draw.standard_normal(3)
    turn = axis / np.linalg.norm(axis) * _TURN_RAD
    outcome.details.update(way_mm=(1e3 * way).round(1).tolist(), turn_deg=np.degrees(turn).round(1).tolist())
    rig.world.holder.move(way, turn, _MOTION_S)
    phalanges = [name for name, region in LEAP_RIGHT.regions.items() if region.role != "palm"]
    end_s = rig.time_s + _MOTION_S + 0.5
    largest_n, fewest, few_since_s, longest_few_s = 0.0, len(phalanges), rig.time_s, 0.0
    while rig.time_s < end_s:
        rig.step()
        forces = {name: patch.force_n for name, patch in rig.world.truth.patches.items()}
        largest_n = max(largest_n, *forces.values())
        touching = sum(forces[name] > 0.02 for name in phalanges)
        fewest = min(fewest, touching)
        if touching >= _PHALANGES:
            few_since_s = rig.time_s
        longest_few_s = max(longest_few_s, rig.time_s - few_since_s)
    limit_n = HandToHandConfig().hand_to_hand_max_force_n
    outcome.kept = longest_few_s < _LOST_FOR_S
    outcome.details.update(fewest=fewest, longest_fewer_ms=1e3 * longest_few_s, largest_n=largest_n, at_end=touching)
    outcome.ok = outcome.kept and largest_n < limit_n
    return outcome
