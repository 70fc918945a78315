# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the loop of a hand says of itself."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

from acts_control.hand.motors import HandReading


class HandPhase(IntEnum):
    """What the hand does."""

    CONNECTING = 0
    RELEASED = 1
    ENABLED = 2
    RECOVERING = 3
    GIVEN_UP = 4

    @property
    def words(self) -> str:
        """For a person."""
        return self.name.lower().replace("_", " ")


@dataclass(frozen=True)
class HandStatus:
    """What the loop does, as of the last cycle.

    Attributes
    ----------
    phase : HandPhase
    reason : str
        Why, in words.
    reading : HandReading or None
        Newest one; None before the first and while the hand is not connected.
    goal_rad : tuple of float
        What was sent last [rad].
    cycles, late, unanswered, recovered : int
        Cycles so far; those that began more than half a period late; reads without an answer; motors started anew.
    """

    phase: HandPhase = HandPhase.CONNECTING
    reason: str = "not started"
    reading: HandReading | None = None
    goal_rad: tuple[float, ...] = ()
    cycles: int = 0
    late: int = 0
    unanswered: int = 0
    recovered: int = 0
