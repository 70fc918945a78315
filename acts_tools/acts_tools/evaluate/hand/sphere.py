# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A sphere off the centre of the palm is gripped and brought to the centre."""

from __future__ import annotations

import math

import numpy as np

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.reflexes import HandState
from acts_sim.hand import HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome, Run
from acts_tools.hand_rigs.rig import HandRig

# The thumb closes around large spheres from above; for small ones it waits at the side.
_POSTURES = {"sphere": "round", "small_sphere": "cup"}
_OFF_M = 0.020
_NEAR_M = 0.005
_SHAPED_S = 0.6
# The sphere lies on the palm then, and no finger has reached it.
_PUT_S = 0.1
# In one process up to 4.5 s; live, beside other programs, half a second more.
_GRIPPED_S = 8.0
_BALANCED_S = 5.0
_PULL_WEIGHTS, _PULL_RAMP_S, _PULLED_S = 3.0, 0.1, 1.0


def run(one: Run) -> Outcome:
    """A sphere of 20 to 40 mm radius, 20 mm off; at the end it must be within 5 mm, with two fingertips on it."""
    return _run(one, float(one.draw().uniform(0.020, 0.040)), "sphere")


def small(one: Run) -> Outcome:
    """A sphere of 8 to 15 mm radius must be kept while it is pulled away from the palm by three times its weight."""
    return _run(one, float(one.draw().uniform(0.008, 0.015)), "small_sphere")


def _run(one: Run, radius_m: float, name: str) -> Outcome:
    draw = np.random.default_rng([one.seed, 13])
    # To the side or towards the fingers; towards the wrist the thumb is in the way.
    angle = draw.uniform(-math.pi / 2, math.pi / 2)
    world = HandWorldConfig(
        seed=one.world_seed,
        pose="palm_up",
        object=name,
        object_size_m=radius_m,
        # Away until the hand has its initial shape; the thumb would push it off.
        object_x_m=-0.085,
        object_y_m=-0.1,
    )
    reflexes = ("slip", "sphere", "trap") if one.reflex else ("slip",)
    rig = one.rig(world, one.options(*reflexes, grasp_posture=_POSTURES[name], grip_force_n=0.3))
    outcome = Outcome(kept=False, details={"radius_mm": 1e3 * radius_m, "angle_deg": math.degrees(angle)})
    rig.begin_grasp()
    # Later, the thumb has closed too far.
    rig.run(_SHAPED_S - rig.behind_s)
    rig.world.put(_OFF_M * math.cos(angle), _OFF_M * math.sin(angle))
    rig.run(_PUT_S + rig.behind_s)
    palm = np.array(LEAP_RIGHT.regions["palm"].centre_m)
    outcome.details["begin_mm"] = _distance_mm(rig, palm)
    rig.run(_GRIPPED_S, lambda: rig.state is not HandState.CLOSING)
    if rig.state is not HandState.HOLDING:
        outcome.details["failed"] = "not grasped"
        return outcome
    rig.run(_BALANCED_S)
    if name == "small_sphere":
        outcome.details["before_pull_mm"] = _distance_mm(rig, palm)
        rig.world.disturbances.pull(-_PULL_WEIGHTS * rig.world.weight_n * rig.world.down, _PULL_RAMP_S)
        rig.run(_PULLED_S)
    outcome.offset_mm = _distance_mm(rig, palm)
    tips = [r.name for r in rig.regions if r.in_contact and LEAP_RIGHT.regions[r.name].role == "distal"]
    touching = [r.name for r in rig.regions if r.in_contact]
    outcome.kept = not rig.world.truth.object_lost and len(touching) >= 2
    outcome.details.update(tips=tips, touching=touching)
    near = outcome.offset_mm <= 1e3 * _NEAR_M
    outcome.ok = bool(outcome.kept and (near and len(tips) >= 2 if name == "sphere" else True))
    return outcome


def _distance_mm(rig: HandRig, palm_m: np.ndarray) -> float:
    away = rig.object_m() - palm_m
    return 1e3 * float(np.hypot(away[0], away[1]))
