# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of the simulated controller, and data of the UR5e."""

from __future__ import annotations

import math
from dataclasses import dataclass

from acts_core.robots import ur5e
from acts_core.settings import setting, validate

CYCLE_HZ = 500
"""Cycles per second of an e-Series controller."""

CYCLE_S = 1.0 / CYCLE_HZ

VERSION = (5, 11, 1, 108318)
"""Reported PolyScope version. From 5.23 on, ``ur_rtde`` uses other registers."""

POSITION_LIMIT_RAD = 2.0 * math.pi
"""Joint range of the UR5e: +-360 degrees (data sheet)."""

SPEED_LIMIT_RAD_S = math.pi
"""Largest joint speed of the UR5e: 180 degrees/s (data sheet)."""

ACCELERATION_LIMIT_RAD_S2 = 40.0
"""Largest joint acceleration of a motion command. The robot itself limits torque, not acceleration."""


@dataclass(frozen=True)
class UrControllerConfig:
    """How the simulated robot behaves."""

    q0_rad: tuple[float, ...] = setting(
        ur5e.LEVEL_Q_RAD,
        "joint angles at the start, base to wrist 3 [rad]; by default with the flange level and facing up",
        minimum=-POSITION_LIMIT_RAD,
        maximum=POSITION_LIMIT_RAD,
        length=ur5e.JOINTS,
    )
    speed_limit_rad_s: float = setting(
        SPEED_LIMIT_RAD_S, "largest joint speed [rad/s]", minimum=0.01, maximum=2 * SPEED_LIMIT_RAD_S
    )
    acceleration_limit_rad_s2: float = setting(
        ACCELERATION_LIMIT_RAD_S2, "largest joint acceleration [rad/s2]", minimum=0.1, maximum=1000.0
    )
    stop_deceleration_rad_s2: float = setting(
        10.0, "deceleration when a program ends or a safety stop happens [rad/s2]", minimum=0.1, maximum=1000.0
    )
    start_delay_s: float = setting(
        0.1, "time from the upload of a program to its start [s]; ur_rtde waits 5 s", minimum=0.0, maximum=4.0
    )
    unlock_after_s: float = setting(
        5.0, "time after which a protective stop can be unlocked [s]", minimum=0.0, maximum=3600.0
    )

    def __post_init__(self) -> None:
        validate(self)
