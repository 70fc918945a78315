# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A control loop on an arm in this process: what its tests have in common."""

from __future__ import annotations

import time
from collections.abc import Callable

from waiting import wait_for

from acts_control.ball import Ball, BallReport, ControlLoop, Phase, Reference, ReferenceReport

ORDERLY_END = ["end_tilting", "release", "disconnect"]

Make = Callable[..., ControlLoop]


def feel(loop: ControlLoop, x_m: float = 0.02, age_s: float = 0.0) -> None:
    """A ball at rest, and the centre as reference."""
    now_ns = time.time_ns()
    loop.ball = BallReport(now_ns - round(age_s * 1e9), True, Ball(x_m, 0.0, 0.0, 0.0))
    loop.reference = ReferenceReport(now_ns, Reference(0.0, 0.0))


def balance(loop: ControlLoop) -> None:
    """Keep touch fresh until the loop is closed and the plate tilted."""

    def tilted() -> bool:
        feel(loop)
        return loop.status.phase is Phase.BALANCING and abs(loop.status.tilt_commanded_rad[1]) > 0.02

    wait_for(tilted, lambda: f"balancing, {loop.status}")


def await_stop(loop: ControlLoop) -> str:
    wait_for(lambda: loop.status.phase is Phase.STOPPED, lambda: f"a stop, {loop.status}")
    return loop.status.reason
