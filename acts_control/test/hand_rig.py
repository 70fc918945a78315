# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A hand for tests of reflexes: what its regions feel is made, its joints follow their goals at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from acts_control.hand.control import HandSupervisor, SupervisorConfig
from acts_control.hand.description import LEAP_RIGHT, HandKinematics
from acts_control.hand.motors import HandReading
from acts_control.hand.reflexes import HandState, Reflex, Sensed
from acts_control.hand.reflexes.sharp_avoidance import SharpAvoidance, SharpAvoidanceConfig
from acts_control.hand.reflexes.slip_prevention import SlipPrevention, SlipPreventionConfig
from acts_core.skin import RegionContact

LEAP = HandKinematics(LEAP_RIGHT)
NAMES = LEAP_RIGHT.names
DT_S = 0.004
TAXEL_M2 = 9e-6


def joints_of(finger: str) -> list[int]:
    """Numbers of the joints that close a finger of the LEAP hand."""
    return [NAMES.index(name) for name in LEAP_RIGHT.fingers[finger].closes]


def region(name: str, force_n: float = 0.0, taxels: int = 9, **more: Any) -> RegionContact:
    """A region of the LEAP hand that feels a blunt contact."""
    link = LEAP_RIGHT.regions[name].link
    if force_n == 0.0:
        return RegionContact(name, link)
    share = min(1.0, 2.0 / taxels)
    given = {
        "area_m2": taxels * TAXEL_M2,
        "peak_n": share * force_n,
        "concentration": share,
        "normal": (-1.0, 0.0, 0.0),
    }
    given["centre_m"] = LEAP_RIGHT.regions[name].centre_m
    return RegionContact(name, link, taxels, force_n, **{**given, **more})


def all_regions(*pressed: RegionContact) -> list[RegionContact]:
    """All 13, of which those given feel something."""
    given = {one.name: one for one in pressed}
    return [given.get(name, region(name)) for name in LEAP_RIGHT.regions]


def sensed(*pressed: RegionContact, time_s: float = 0.0, state: HandState = HandState.HOLDING, **more: Any) -> Sensed:
    """One moment of the hand."""
    q = more.pop("q_rad", np.full(16, 0.3))
    given = {"q_rad": q, "goal_rad": q + 0.03, "current_ma": np.full(16, 100.0), "step_rad_s": np.full(16, 1.2)}
    regions = {one.name: one for one in all_regions(*pressed)}
    return Sensed(time_s, DT_S, state, LEAP, regions=regions, **{**given, **more})


class RigidHand:
    """A supervisor whose joints are where they were sent, up to where something stops them."""

    def __init__(self, *reflexes: tuple[str, Reflex], **settings: Any) -> None:
        self.supervisor = HandSupervisor(LEAP, dict(reflexes), SupervisorConfig(**settings))
        self.q = np.zeros(16)
        self.goal = np.zeros(16)
        self.stops: dict[str, float] = {}
        self.now_s = 10.0

    def reading(self) -> HandReading:
        current = np.clip((self.goal - self.q) * 3000.0, -350.0, 350.0)
        return HandReading(tuple(self.q), (0.0,) * 16, tuple(current), (30,) * 16, ("",) * 16)

    def step(self, pressed: Sequence[RegionContact] | None = (), steps: int = 1) -> HandState:
        """Go on; None: no touch comes."""
        for _ in range(steps):
            self.now_s += DT_S
            if pressed is not None:
                self.supervisor.touch(all_regions(*pressed), self.now_s - 0.002, self.now_s)
            self.goal = np.asarray(self.supervisor.step(self.reading(), self.goal.tolist(), self.now_s, DT_S))
            self.q = self.goal.copy()
            for name, stop in self.stops.items():
                k = NAMES.index(name)
                self.q[k] = min(self.q[k], stop)
        return self.supervisor.status.state

    def angle(self, joint: str) -> float:
        return float(self.goal[NAMES.index(joint)])


GRIPPED = [region(f"{finger}_distal", 0.8) for finger in LEAP_RIGHT.fingers]
TIP = region("index_distal", 0.5, 1, sharpness=10.0)


def a_hand(**settings: float) -> RigidHand:
    sharp, slip = SharpAvoidance(SharpAvoidanceConfig()), SlipPrevention(SlipPreventionConfig())
    hand = RigidHand(("slip", slip), ("sharp", sharp), **settings)
    hand.supervisor.restart(recovered=False)
    hand.step([])
    return hand


def a_holding_hand() -> RigidHand:
    hand = a_hand(grip_settle_s=0.02)
    assert hand.supervisor.grasp() == ""
    assert hand.step(GRIPPED, steps=20) is HandState.HOLDING
    return hand
