# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether somebody wants the torque of a hand on or off, and the answer to who asked for that."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable


class PendingAnswer:
    """An answer that is known once something has happened, or nobody waits for it any longer.

    Parameters
    ----------
    is_known : threading.Event
    words : callable
        The answer, once it is to be given: why not, or nothing.
    timeout_s : float
        For how long it is waited for [s].
    """

    def __init__(self, is_known: threading.Event, words: Callable[[], str], timeout_s: float) -> None:
        self._is_known = is_known
        self._words = words
        self._until_s = time.monotonic() + timeout_s

    def poll(self) -> str | None:
        """The answer; None as long as it is to be waited for."""
        if not self._is_known.is_set() and time.monotonic() < self._until_s:
            return None
        return self._words()

    def told_as(self, words: str) -> PendingAnswer:
        """The same, with another answer."""
        return PendingAnswer(self._is_known, lambda: words, self._until_s - time.monotonic())

    def wait(self) -> str:
        """The answer, when it is known."""
        self._is_known.wait(max(self._until_s - time.monotonic(), 0.0))
        return self._words()


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
        Whether it is, and has not come on since that was asked for.
    why_off : str
        Why it is not, in words; empty before anybody has asked for that.
    on_is_known, off_is_known : threading.Event
        Set once it is known what has become of the last wish for torque, and of the last one for none.
    """

    def __init__(self, *, is_on: bool) -> None:
        self.is_on = self.is_under_way = is_on
        self.why_off = ""
        self.on_is_known, self.off_is_known = threading.Event(), threading.Event()
        self.off_is_known.set()

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

    def has_come_on(self) -> None:
        """The torque is on, as was wanted."""
        self.is_under_way = False
        self.on_is_known.set()

    def tell_all(self) -> None:
        """Whatever was asked for, the status of the loop says what has become of it."""
        self.on_is_known.set()
        self.off_is_known.set()
