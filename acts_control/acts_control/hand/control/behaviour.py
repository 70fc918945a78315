# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The interface of what decides where the joints of a hand go; the loop of the hand calls it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from acts_control.hand.motors import HandReading


class Behaviour(Protocol):
    """Moves a hand by itself, where no commands do. All calls come from the loop's thread."""

    def restart(self, *, recovered: bool) -> None:
        """The torque is on again, every joint holds where it is; `recovered`: after motors had failed or stopped."""

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Sequence[float]:
        """Called with each reading while the torque is on.

        Parameters
        ----------
        reading : HandReading
        goal_rad : sequence of float
            What was sent last [rad].
        now_s, dt_s : float
            By `loop_rate.steady_s`, and since the step before [s].

        Returns
        -------
        sequence of float
            Where every joint is to go [rad].
        """

    def waited(self, seconds: float) -> None:
        """Motors did not answer for so long, and there was no step: nobody stood still [s]."""

    def sent(self, began_s: float, sent_s: float) -> None:
        """What `step` asked for has been sent; when its cycle began, and now, by `loop_rate.steady_s` [s]."""
