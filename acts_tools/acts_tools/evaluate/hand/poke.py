# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A finger of a hand that holds a cylinder is poked, by a tip of 1 mm or by a blunt end."""

from __future__ import annotations

import numpy as np

from acts_control.hand.description import LEAP_RIGHT
from acts_sim.hand import BLUNT_RADIUS_M, LARGEST_RADIUS_M, SHARP_RADIUS_M, HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome, Run

_SPEED_M_S = 0.05
_TRAVEL_M = 0.006
_WATCHED_S = 0.4
_NOTICED_MS = 20.0
_ALLOWED_M = 0.002
_OPENS_RAD_S = 0.02
_FINGERS = ("index", "middle", "ring")


def sharp(one: Run) -> Outcome:
    """A tip of 1 mm: the finger must open, the others must hold."""
    outcome = _poke(one, SHARP_RADIUS_M)
    outcome.ok = bool(
        outcome.noticed_ms is not None
        and outcome.stopped_ms is not None
        and outcome.noticed_ms + outcome.stopped_ms <= _NOTICED_MS
        and outcome.penetration_mm is not None
        and outcome.penetration_mm < 1e3 * _ALLOWED_M
        and outcome.kept
    )
    return outcome


def blunt(one: Run) -> Outcome:
    """A round end of 8 to 20 mm: no reflex may act, neither for it nor for the cylinder."""
    outcome = _poke(one, float(one.draw().uniform(BLUNT_RADIUS_M, LARGEST_RADIUS_M)))
    # Also before the end touches, because the cylinder is blunt as well.
    outcome.ok = outcome.details.get("alarms", 1) == 0
    return outcome


def _poke(one: Run, radius_m: float) -> Outcome:
    draw = np.random.default_rng([one.seed, 11])
    world = HandWorldConfig(
        seed=one.seed, pose="palm_up", object="cylinder", object_size_m=draw.uniform(0.022, 0.028), object_held=True
    )
    reflexes = ("sharp", "slip") if one.reflex else ("slip",)
    rig = one.rig(world, one.options(*reflexes))
    outcome = Outcome(kept=False, details={"radius_mm": 1e3 * radius_m})
    if not rig.grasp():
        outcome.details["failed"] = "not grasped"
        return outcome
    rig.world.holder.let_go()
    rig.run(0.2)
    finger = _FINGERS[int(draw.integers(len(_FINGERS)))]
    patch = f"{finger}_medial"
    before = rig.reflexes["sharp"].events if one.reflex else 0
    outcome.details.update(patch=patch, alarms_before=before)
    held = {region.name for region in rig.regions if region.in_contact} - {patch}
    joints = [k for k, name in enumerate(LEAP_RIGHT.names) if name in LEAP_RIGHT.fingers[finger].closes]
    row, col = draw.uniform(1.0, 6.0, 2)
    rig.world.tip.poke(patch, radius_m, _SPEED_M_S, _TRAVEL_M, start_m=0.002, row=float(row), col=float(col))
    touched_s = noticed_s = opened_s = None
    deepest_m = 0.0
    end_s = rig.time_s + _WATCHED_S
    q_rad = np.array(rig.world.truth.q_rad)
    while rig.time_s < end_s:
        rig.step()
        truth = rig.world.truth
        last, q_rad = q_rad, np.array(truth.q_rad)
        deepest_m = max(deepest_m, truth.tip_depth_m)
        if touched_s is None and truth.patches[patch].tip_force_n > 0.0:
            touched_s = rig.time_s
        if noticed_s is None and one.reflex and rig.reflexes["sharp"].events > before:
            noticed_s = rig.time_s
        opens_rad_s = -float((q_rad - last)[joints].min()) / 0.002
        if noticed_s is not None and opened_s is None and opens_rad_s > _OPENS_RAD_S:
            opened_s = rig.time_s
    outcome.details["alarms"] = rig.reflexes["sharp"].events if one.reflex else 0
    outcome.penetration_mm = 1e3 * deepest_m
    if touched_s is not None and noticed_s is not None:
        outcome.noticed_ms = 1e3 * (noticed_s - touched_s)
    if noticed_s is not None and opened_s is not None:
        outcome.stopped_ms = 1e3 * (opened_s - noticed_s)
    kept = {region.name for region in rig.regions if region.in_contact}
    others = {name for name in held if LEAP_RIGHT.regions[name].finger != finger}
    outcome.kept = others <= kept
    return outcome
