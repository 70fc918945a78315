# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A held cylinder is pulled along its axis by 0.5, 1 or 2 times its weight, within 50 ms; or it is left alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from acts_sim.hand import HandTruth, HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome, Run, between_ms

LOADS = (0.5, 1.0, 2.0)
"""Forces, relative to the weight of the object."""

_RAMP_S = 0.05
_SETTLED_S = 0.6
_WATCHED_S = 1.0
_HELD_S = 10.0
_NOTICEABLE_M = 0.0002
_ALLOWED_M = 0.003
_KEPT_M = 0.02
_NOTICED_MS = 15.0
# Below this speed the object counts as at rest, and as not sliding: the foam still yields slightly.
_STANDS_M_S = 0.010


@dataclass
class _Pull:
    """When a pulled object moved, slid, was noticed, stuck and stood again [s]; how far it went and slid [m].

    An object moves without sliding where foam and fingers give way, and a touch that moves along cannot tell. So it
    sticks to the skin again before it stands.
    """

    moved_s: float | None = None
    slid_s: float | None = None
    noticed_s: float | None = None
    stuck_s: float | None = None
    stood_s: float | None = None
    farthest_m: float = 0.0
    slid_m: float = 0.0


def run(one: Run) -> Outcome:
    """Grasp, release the holder, load, observe."""
    rig, outcome = _grasped(one)
    if rig is None:
        return outcome
    load = LOADS[one.seed % len(LOADS)]
    outcome.details["load"] = load
    pull = _watch_pull(one, rig, load, outcome.details["slips_before"])
    outcome.kept = not rig.world.truth.object_lost and pull.farthest_m < _KEPT_M
    outcome.offset_mm = 1e3 * pull.farthest_m
    outcome.noticed_ms = between_ms(pull.moved_s, pull.noticed_s)
    outcome.details["slid_mm"] = 1e3 * pull.slid_m
    noticed_after_sliding_ms = between_ms(pull.slid_s, pull.noticed_s)
    if noticed_after_sliding_ms is not None:
        outcome.details["noticed_after_sliding_ms"] = noticed_after_sliding_ms
    outcome.stopped_ms = between_ms(pull.noticed_s, pull.stood_s)
    stopped_sliding_ms = between_ms(pull.noticed_s, pull.stuck_s)
    if stopped_sliding_ms is not None:
        outcome.details["stopped_sliding_ms"] = stopped_sliding_ms
    outcome.details["max_grip_n"] = _grip_n(rig)
    noticed_well = pull.moved_s is None or (outcome.noticed_ms is not None and outcome.noticed_ms <= _NOTICED_MS)
    outcome.ok = outcome.kept and pull.farthest_m < _ALLOWED_M and (noticed_well or not one.reflex)
    return outcome


def _watch_pull(one: Run, rig: Any, load: float, slips_before: int) -> _Pull:
    """Pull the object by `load` of its weights, and watch it until it is lost, or for `_WATCHED_S`."""
    pull, at = _Pull(), rig.object_m()
    rig.world.disturbances.pull_down(load, _RAMP_S)
    begin_s = before_s = rig.time_s
    while rig.time_s < begin_s + _WATCHED_S:
        rig.step()
        truth = rig.world.truth
        slides_m_s = sliding_m_s(truth)
        pull.slid_m += slides_m_s * (rig.time_s - before_s)
        before_s = rig.time_s
        if pull.slid_s is None and pull.slid_m > _NOTICEABLE_M:
            pull.slid_s = rig.time_s
        # Only along the pull: a grip that tightens also moves the object across it, which is no slip.
        along_m = float((np.array(truth.object_position_m) - at) @ rig.world.down)
        pull.farthest_m = max(pull.farthest_m, along_m)
        speed_m_s = float(np.array(truth.object_velocity_m_s) @ rig.world.down)
        if pull.moved_s is None and pull.farthest_m > _NOTICEABLE_M:
            pull.moved_s = rig.time_s
        if pull.noticed_s is None and one.reflex and rig.reflexes["slip"].events > slips_before:
            pull.noticed_s = rig.time_s
        if pull.noticed_s is not None and pull.stuck_s is None and slides_m_s < _STANDS_M_S:
            pull.stuck_s = rig.time_s
        if pull.noticed_s is not None and pull.stood_s is None and speed_m_s < _STANDS_M_S:
            pull.stood_s = rig.time_s
        if truth.object_lost:
            break
    return pull


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
        seed=one.world_seed,
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
