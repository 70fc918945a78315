# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A held cylinder is pulled along its axis by 0.5, 1 or 2 times its weight, within 50 ms; or it is left alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from acts_sim.hand import HandTruth, HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome, Run

LOADS = (0.5, 1.0, 2.0)
"""Forces, relative to the weight of the object."""

_RAMP_S = 0.05
_SETTLED_S = 0.6
_WATCHED_S = 1.0
_HELD_S = 10.0
_NOTICEABLE_M = 0.0002
_ALLOWED_M = 0.003
_NOTICED_MS = 15.0
# Below this speed the object counts as at rest: the foam still yields slightly.
_STANDS_M_S = 0.010


def run(one: Run) -> Outcome:
    """Grasp, release the holder, load, observe."""
    rig, outcome = _grasped(one)
    if rig is None:
        return outcome
    load = LOADS[one.seed % len(LOADS)]
    outcome.details["load"] = load
    slips_before = outcome.details["slips_before"]
    at = rig.object_m()
    moved_s = slid_s = noticed_s = stood_s = None
    farthest_m = slid_m = 0.0
    rig.world.disturbances.pull_down(load, _RAMP_S)
    begin_s = before_s = rig.time_s
    while rig.time_s < begin_s + _WATCHED_S:
        rig.step()
        truth = rig.world.truth
        slid_m += sliding_m_s(truth) * (rig.time_s - before_s)
        before_s = rig.time_s
        if slid_s is None and slid_m > _NOTICEABLE_M:
            slid_s = rig.time_s
        # Only along the pull: a grip that tightens also moves the object across it, which is no slip.
        farthest_m = max(farthest_m, float((np.array(truth.object_position_m) - at) @ rig.world.down))
        speed_m_s = float(np.array(truth.object_velocity_m_s) @ rig.world.down)
        if moved_s is None and farthest_m > _NOTICEABLE_M:
            moved_s = rig.time_s
        if noticed_s is None and one.reflex and rig.reflexes["slip"].events > slips_before:
            noticed_s = rig.time_s
        if noticed_s is not None and stood_s is None and speed_m_s < _STANDS_M_S:
            stood_s = rig.time_s
        if truth.object_lost:
            break
    outcome.kept = not rig.world.truth.object_lost and farthest_m < 0.02
    outcome.offset_mm = 1e3 * farthest_m
    if moved_s is not None and noticed_s is not None:
        outcome.noticed_ms = 1e3 * (noticed_s - moved_s)
    # An object moves without sliding where foam and fingers give way, and a touch that moves along cannot tell.
    outcome.details["slid_mm"] = 1e3 * slid_m
    if slid_s is not None and noticed_s is not None:
        outcome.details["noticed_after_sliding_ms"] = 1e3 * (noticed_s - slid_s)
    if noticed_s is not None and stood_s is not None:
        outcome.stopped_ms = 1e3 * (stood_s - noticed_s)
    outcome.details["max_grip_n"] = _grip_n(rig)
    noticed_well = moved_s is None or (outcome.noticed_ms is not None and outcome.noticed_ms <= _NOTICED_MS)
    outcome.ok = outcome.kept and farthest_m < _ALLOWED_M and (noticed_well or not one.reflex)
    return outcome


def sliding_m_s(truth: HandTruth) -> float:
    """Mean speed at which the object slides over the skin, weighted by force; 0 where it moves with the skin [m/s]."""
    touching = truth.patches.values()
    force_n = sum(one.force_n for one in touching)
    return sum(one.force_n * one.sliding_m_s for one in touching) / force_n if force_n > 0.0 else 0.0


def hold(one: Run) -> Outcome:
    """Grasp, release the holder, and let nothing happen: no slip may be reported."""
    rig, outcome = _grasped(one)
    if rig is None:
        return outcome
    begin_s, before, at = rig.time_s, outcome.details["slips_before"], rig.object_m()
    rig.run(_HELD_S)
    outcome.kept = not rig.world.truth.object_lost
    outcome.offset_mm = 1e3 * float(np.linalg.norm(rig.object_m() - at))
    told = rig.reflexes["slip"].events - before if one.reflex else 0
    outcome.details.update(false_slips=told, held_s=rig.time_s - begin_s)
    outcome.ok = outcome.kept and told == 0
    return outcome


def _grasped(one: Run) -> tuple[Any, Outcome]:
    """The hand with a cylinder in it that nothing else holds any more; None where it was not grasped."""
    draw = one.draw()
    world = HandWorldConfig(
        seed=one.seed,
        pose="thumb_up",
        object="cylinder",
        object_held=True,
        object_size_m=draw.uniform(0.022, 0.028),
        object_mass_kg=draw.uniform(0.14, 0.18),
        object_x_m=draw.uniform(-0.003, 0.003),
    )
    # A light grip, which carries little more than the object.
    rig = one.rig(world, one.options(*(("sharp", "slip") if one.reflex else ("sharp",)), grip_force_n=0.15))
    outcome = Outcome(kept=False, details={"mass_kg": world.object_mass_kg})
    if not rig.grasp():
        outcome.details["failed"] = "not grasped"
        return None, outcome
    outcome.details["grip_grasped_n"] = _grip_n(rig)
    rig.world.holder.let_go()
    rig.run(_SETTLED_S)
    # Much more than before the release is a grip that a false slip has made firm: what then is pulled hardly moves.
    outcome.details["grip_before_n"] = _grip_n(rig)
    outcome.details["slips_before"] = rig.reflexes["slip"].events if one.reflex else 0
    return rig, outcome


def _grip_n(rig: Any) -> float:
    """Force that the skin feels now, the sum over its patches [N]."""
    return sum(one.force_n for one in rig.regions)
