# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A finger of a hand that holds a cylinder is poked, by a tip of 1 mm or by a blunt end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from acts_control.hand.description import LEAP_RIGHT
from acts_sim.hand import BLUNT_RADIUS_M, LARGEST_RADIUS_M, SHARP_RADIUS_M, STEP_S, HandWorldConfig
from acts_tools.evaluate.hand.scenario import Outcome, Run, between_ms

_SPEED_M_S = 0.05
_TRAVEL_M = 0.006
_WATCHED_S = 0.4
_NOTICED_MS = 20.0
_ALLOWED_M = 0.002
_OPENS_RAD_S = 0.02
_FINGERS = ("index", "middle", "ring")


@dataclass
class _Poke:
    """When the tip of a poke touched, was noticed and the finger opened, if at all [s]; and how deep it went [m]."""

    touched_s: float | None = None
    noticed_s: float | None = None
    opened_s: float | None = None
    deepest_m: float = 0.0


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
        seed=one.world_seed,
        pose="palm_up",
        object="cylinder",
        object_size_m=draw.uniform(0.022, 0.028),
        object_held=True,
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
    poke = _watch_poke(one, rig, patch, joints, before)
    outcome.details["alarms"] = rig.reflexes["sharp"].events if one.reflex else 0
    outcome.penetration_mm = 1e3 * poke.deepest_m
    outcome.noticed_ms = between_ms(poke.touched_s, poke.noticed_s)
    outcome.stopped_ms = between_ms(poke.noticed_s, poke.opened_s)
    kept = {region.name for region in rig.regions if region.in_contact}
    others = {name for name in held if LEAP_RIGHT.regions[name].finger != finger}
    outcome.kept = others <= kept
    return outcome


def _watch_poke(one: Run, rig: Any, patch: str, joints: list[int], alarms_before: int) -> _Poke:
    """Watch for `_WATCHED_S` the tip on a patch, the reflex, and the joints that close this finger."""
    poke = _Poke()
    end_s = rig.time_s + _WATCHED_S
    q_rad = np.array(rig.world.truth.q_rad)
    while rig.time_s < end_s:
        rig.step()
        truth = rig.world.truth
        last, q_rad = q_rad, np.array(truth.q_rad)
        poke.deepest_m = max(poke.deepest_m, truth.tip_depth_m)
        if poke.touched_s is None and truth.patches[patch].tip_force_n > 0.0:
            poke.touched_s = rig.time_s
        if poke.noticed_s is None and one.reflex and rig.reflexes["sharp"].events > alarms_before:
            poke.noticed_s = rig.time_s
        opens_rad_s = -float((q_rad - last)[joints].min()) / STEP_S
        if poke.noticed_s is not None and poke.opened_s is None and opens_rad_s > _OPENS_RAD_S:
            poke.opened_s = rig.time_s
    return poke
