# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where somebody has told the joints of a hand to go, and when that is too old to be followed."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping

from acts_control.hand.description import HandDescription
from acts_control.hand.motors import HandError
from acts_control.loop_rate import steady_s

_NEVER_S = -1e9


class JointCommands:
    """Commands come from any thread; the thread of the hand's loop follows them.

    Parameters
    ----------
    hand : HandDescription
    stale_after_s : float
        How long a command counts [s].
    log : callable
        Takes a level and a sentence; called from the loop's thread.
    """

    def __init__(self, hand: HandDescription, stale_after_s: float, log: Callable[[str, str], None]) -> None:
        self._hand = hand
        self._stale_after_s = stale_after_s
        self._log = log
        self._index = {joint.name: k for k, joint in enumerate(hand.joints)}
        self._lock = threading.Lock()
        self._target: dict[int, float] = {}
        self._commanded_s = _NEVER_S
        self._looked_s = 0.0  # when commands were looked at last
        self._stood_still_s = _NEVER_S  # when they were again, after nobody had done so for long

    def take(self, angles_rad: Mapping[str, float]) -> None:
        """Take a command, see `HandLoop.command`."""
        if not angles_rad:
            raise HandError(f"a command without a joint; the hand's joints are {', '.join(self._index)}")
        unknown = next((name for name in angles_rad if name not in self._index), None)
        if unknown is not None:
            raise HandError(f"the hand has no joint {unknown[:64]!r}; its joints are {', '.join(self._index)}")
        broken = [f"{name} = {angle}" for name, angle in angles_rad.items() if not math.isfinite(angle)]
        if broken:
            raise HandError(f"{', '.join(broken)}: angles have to be finite")
        now_s = steady_s()
        with self._lock:
            if now_s - self._stood_still_s < self._stale_after_s:
                return
            if now_s - self._commanded_s > self._stale_after_s:
                self._target.clear()
            for name, angle in angles_rad.items():
                self._target[self._index[name]] = self._hand.joints[self._index[name]].clipped(angle)
            self._commanded_s = now_s

    def begin(self) -> None:
        """The torque has come on: what was wanted before is old. The loop follows commands from now on."""
        with self._lock:
            self._forget()
            self._looked_s = steady_s()

    def begin_again(self, took_s: float) -> None:
        """The torque is on again, which took so long [s]; what stopped the motors is yet to be noticed."""
        with self._lock:
            self._forget()
            self._looked_s += took_s

    def was_at_work(self, for_s: float) -> None:
        """The loop has not looked for so long because it was at work, and did not stand still [s]."""
        with self._lock:
            self._looked_s += for_s

    def look(self) -> None:
        """Notice where this program stood still: commands that have waited meanwhile come at once, as if new."""
        with self._lock:
            before_s, self._looked_s = self._looked_s, steady_s()
            still_s = self._looked_s - before_s
            if still_s > self._stale_after_s:
                self._forget()
                self._stood_still_s = self._looked_s
                old = f"commands are left out for {self._stale_after_s:g} s, because they may have waited"
                self._log("warning", f"this program stood still for {still_s:.1f} s: {old}")

    def targets(self, now_s: float) -> tuple[dict[int, float], str]:
        """Where joints are to go, by their numbers, and in words why; `now_s` by `steady_s` [s]."""
        self.look()
        with self._lock:
            fresh = now_s - self._commanded_s <= self._stale_after_s
            return (dict(self._target), "moving as commanded") if fresh else ({}, "holding")

    def _forget(self) -> None:
        """What was commanded is old, and nobody follows it."""
        self._target.clear()
        self._commanded_s = _NEVER_S
