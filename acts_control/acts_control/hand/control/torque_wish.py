# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether somebody wants the torque of a hand on or off, and the answer to who asked for that."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from acts_control.hand.control.status import HandPhase, HandStatus

CUT_POWER = "motors that are silent may hold on: cut their power to be sure"
"""What is told of motors that have not said that their torque is off."""

# Who asks for torque or a release waits no longer for the motors' answers; where many are silent, it takes longer.
_ANSWER_S = 2.0
# How often that is looked at, and how much of the time since the look before counts: while this program stands still,
# so does the loop of the hand, and what motors say is not heard.
_LOOK_S = 0.02
_LONGEST_LOOK_S = 0.1


class PendingAnswer:
    """An answer that is known once something has happened, or two seconds have passed.

    Parameters
    ----------
    is_known : threading.Event
    words : callable
        The answer, once it is to be given: why not, or nothing.
    waits : bool
        Whether it is to be waited for at all.
    """

    def __init__(self, is_known: threading.Event, words: Callable[[], str], *, waits: bool) -> None:
        self._is_known = is_known
        self._words = words
        self._left_s = _ANSWER_S if waits else 0.0
        self._looked_s = time.monotonic()

    @classmethod
    def known(cls, words: str) -> PendingAnswer:
        """One that need not be waited for."""
        return cls(threading.Event(), lambda: words, waits=False)

    def poll(self) -> str | None:
        """The answer; None as long as it is to be waited for. To be called again and again until it is there."""
        before_s, self._looked_s = self._looked_s, time.monotonic()
        self._left_s -= min(self._looked_s - before_s, _LONGEST_LOOK_S)
        if not self._is_known.is_set() and self._left_s > 0.0:
            return None
        return self._words()

    def told_as(self, words: str) -> PendingAnswer:
        """The same, with another answer."""
        self._words = lambda: words
        return self

    def wait(self) -> str:
        """The answer, when it is known."""
        while (answer := self.poll()) is None:
            self._is_known.wait(_LOOK_S)
        return answer


class TorqueWish:
    """What was asked for last. Any thread may ask; the loop of the hand obeys, and tells that.

    Parameters
    ----------
    is_on : bool
        Whether the torque is wanted from the beginning.

    Attributes
    ----------
    is_on : bool
        Whether the torque is wanted.
    is_under_way : bool
        Whether it is, and has not come on since that was asked for, or since the hand was lost.
    is_served : bool
        Whether the loop of the hand runs.
    why_off : str
        Why it is not, in words; empty before anybody has asked for that.
    on_is_known, off_is_known : threading.Event
        Set once it is known what has become of the last wish for torque, and of the last one for none.
    """

    def __init__(self, *, is_on: bool) -> None:
        self.is_on = self.is_under_way = is_on
        self.is_served = False
        self.why_off = ""
        self.on_is_known, self.off_is_known = threading.Event(), threading.Event()
        self.off_is_known.set()

    @property
    def why_released(self) -> str:
        """Why a hand that is connected has no torque, in words, also where that was said before it was lost."""
        return (not self.is_on and self.why_off) or "connected"

    def on(self) -> None:
        """Somebody wants the torque on."""
        self.on_is_known.clear()
        self.is_under_way = self.is_under_way or not self.is_on
        self.is_on = True
        self.off_is_known.set()

    def off(self, why: str) -> None:
        """Somebody wants the torque off, or to stay off."""
        self.why_off = why
        self.is_on = self.is_under_way = False
        self.off_is_known.clear()
        self.on_is_known.set()

    def has_gone_off(self) -> None:
        """The torque has gone off though nobody wants that: where it is wanted, it is on its way again."""
        self.is_under_way = self.is_on

    def has_come_on(self) -> None:
        """The torque is on, as was wanted."""
        self.is_under_way = False
        self.on_is_known.set()

    def tell_all(self) -> None:
        """Whatever was asked for, the status of the loop says what has become of it."""
        self.on_is_known.set()
        self.off_is_known.set()

    def why_not_on(self, status: HandStatus) -> str:
        """Why the torque is off that was asked for, in words; empty where it is on."""
        if not self.is_served:
            return f"the hand's loop has ended: {status.reason}"
        if not self.is_on:
            return f"the torque is off: {self.why_off}"
        if status.phase is HandPhase.ENABLED and self.is_under_way:
            return f"the motors have not said within {_ANSWER_S:g} s that their torque is on; it was to go off before"
        if status.phase is HandPhase.ENABLED:
            return ""
        state = "not connected" if status.phase is HandPhase.CONNECTING else status.phase.words
        return f"the hand is {state} ({status.reason}); its torque comes on as soon as it can, unless it is released"

    def why_not_off(self, status: HandStatus) -> str:
        """Why the torque may be on that was asked to be off, in words; empty where it is off."""
        if not self.is_served:
            return f"the hand's loop has ended: {status.reason}"
        if self.is_on:
            return "the torque was asked for again meanwhile"
        if status.phase is HandPhase.CONNECTING:
            return f"the hand is not connected ({status.reason}); it is released as soon as it is; {CUT_POWER}"
        if not self.off_is_known.is_set():
            return f"the motors have not said within {_ANSWER_S:g} s that they are released; {CUT_POWER}"
        return ""
