# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What nodes say besides touch, as the page is told: a ball that is balanced, a hand and its joints, a known object.

Anybody in the domain can send such messages: texts and lists are cut, and what is no number is left out.
"""

from __future__ import annotations

import math
from typing import Any

from sensor_msgs.msg import JointState

from acts_msgs.msg import BalanceStatus, BallReference, BallState, HandStatus, ObjectClass

SHOWN = 64
"""Entries of a list that are shown at most: every page is sent all of them."""

TEXT = 200
"""Letters of a text that are shown at most."""

_NEAREST = 3
_LIBRARY_MAX = 1000


def _names(kind: type) -> dict[int, str]:
    """The states of a message in words."""
    return {getattr(kind, name): name.removeprefix("STATE_").lower() for name in dir(kind) if name.startswith("STATE_")}


_HAND_STATES = _names(HandStatus)
_BALANCE_STATES = _names(BalanceStatus)


def hand_state(message: HandStatus) -> dict[str, Any]:
    """What the hand does, why, and the reflexes that act."""
    return {
        "state": _HAND_STATES.get(message.state, str(message.state)),
        "reason": message.reason[:TEXT],
        "active": [name[:TEXT] for name in message.active[:SHOWN]],
        "events": [
            [name[:TEXT], int(count)]
            for name, count in zip(message.reflexes[:SHOWN], message.events[:SHOWN], strict=False)
        ],
    }


def joint_angles(message: JointState) -> list[list[Any]]:
    """Pairs of a joint's name and its position [rad]."""
    pairs = zip(message.name[:SHOWN], message.position[:SHOWN], strict=False)
    return [[name[:TEXT], position] for name, position in pairs if math.isfinite(position)]


def ball_place(message: BallState) -> dict[str, Any]:
    """Where the ball is [m]; None where that is not known."""
    return {"ball": _pair(message.position) if message.valid else None}


def ball_reference(message: BallReference) -> dict[str, Any]:
    """Where the ball should be [m], and on which part of its way."""
    return {"reference": _pair(message.position), "segment": message.segment[:TEXT]}


def balance_state(message: BalanceStatus) -> dict[str, Any]:
    """What the controller does and why, and the tilt of the plate [rad]."""
    return {
        "state": _BALANCE_STATES.get(message.state, str(message.state)),
        "reason": message.reason[:TEXT],
        "tilt_commanded": _pair(message.tilt_commanded),
        "tilt_measured": _pair(message.tilt_measured),
    }


def known_object(message: ObjectClass) -> dict[str, Any]:
    """The object that presses, by number and name, how sure that is, and the residuals of those that fit best.

    The number is None where nothing is pressed, the name empty where only the library has it, and the confidence None
    where there is nothing to compare with.
    """
    listed = enumerate(message.residuals[:_LIBRARY_MAX])
    residuals = [(residual, number) for number, residual in listed if math.isfinite(residual)]
    is_touched = message.class_number != ObjectClass.NO_OBJECT
    is_compared = is_touched and len(residuals) > 1 and math.isfinite(message.confidence)
    return {
        "number": message.class_number if is_touched else None,
        "name": message.name[:TEXT],
        "confidence": message.confidence if is_compared else None,
        "nearest": [[number, residual] for residual, number in sorted(residuals)[:_NEAREST]] if is_touched else [],
    }


def _pair(vector: Any) -> list[float] | None:
    x, y = float(vector.x), float(vector.y)
    return [x, y] if math.isfinite(x) and math.isfinite(y) else None
