# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Test hooks: actions of a person at the robot, as text commands on a port of their own."""

from __future__ import annotations

import json

from acts_sim.ur import Controller

_KNOWN = "protective_stop [reason], emergency_stop, clear, state, orders"


def answer(controller: Controller, line: str) -> str:
    """Execute a line and return ``ok``, a JSON object for ``state``, or ``error: ...``."""
    word, _, rest = line.partition(" ")
    if word == "protective_stop":
        controller.protective_stop(rest or "test hook")
    elif word == "emergency_stop":
        controller.emergency_stop()
    elif word == "clear":
        controller.clear_stops()
    elif word == "state":
        return json.dumps(
            {
                "time_s": controller.time_s,
                "q_rad": controller.joints.q,
                "qd_rad_s": controller.joints.qd,
                "motion": type(controller.motion).__name__,
                "runtime": controller.runtime.name,
                "safety": controller.safety.name,
                "robot_mode": controller.robot_mode.name,
            }
        )
    elif word == "orders":
        return json.dumps(list(controller.orders))
    else:
        return f"error: unknown {word!r}; known are {_KNOWN}"
    return "ok"
