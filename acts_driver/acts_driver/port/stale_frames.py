# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Stale frames: those of an earlier session that a board's USB buffer still holds when the port is opened again."""

from __future__ import annotations

import time
from collections.abc import Callable

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, Reply, UnknownReply
from acts_driver.protocols import Decoder

# What waits in a board comes within milliseconds; a machine may be busy.
_HELD_S = 0.1


class StaleFrames:
    """Drops the frames that came before a board's reply to this host: they may be of an earlier session.

    The USB buffer of a Teensy keeps up to 8 KB that a host did not read, and sends them to the next host. A reply to
    the earlier host may be among them, so the last one counts that came before it was known which board this is.

    Parameters
    ----------
    decoder : Decoder
        Decodes the stream.

    Attributes
    ----------
    is_over : bool
        Whether all frames from now on are of this session: `new` need not be called any more.
    """

    def __init__(self, decoder: Decoder) -> None:
        self._decoder = decoder
        self._before_answer = 0
        self.is_over = False

    def receive(self, message: BoardMessage) -> None:
        """Note a reply; called with every message while bytes are decoded."""
        if isinstance(message, Reply | UnknownReply) and not self.is_over:
            self._before_answer = self._decoder.frames

    def new(self, frames: list[SampleFrame], *, is_known: bool) -> list[SampleFrame]:
        """The frames of this session.

        Parameters
        ----------
        frames : list of SampleFrame
            All that were just decoded.
        is_known : bool
            Whether the board has replied, or is known not to.
        """
        if not is_known:
            return []
        self.is_over = True
        first = self._decoder.frames - len(frames)
        return frames[max(self._before_answer - first, 0) :]


class HeldBack:
    """Holds frames back that have no time of their own, until what waited when the port was opened has been read.

    They are dated by their arrival, so those of an earlier session would be taken for present ones, and such a board
    gives no reply that would tell them apart.

    Parameters
    ----------
    needed : bool
        Whether the frames have no time of their own; of others none is held back.
    """

    def __init__(self, *, needed: bool) -> None:
        self._needed = needed
        self._until_s: float | None = None

    def opened(self) -> None:
        """Tell that the port was opened."""
        if self._needed:
            self._until_s = time.monotonic() + _HELD_S

    def wait(self, catch_up: Callable[[], bool]) -> None:
        """Wait until what waited has been read; `catch_up` waits for all that has arrived, and says whether it is."""
        until_s = self._until_s
        if until_s is not None:
            time.sleep(_HELD_S)
            # Unless the port was lost and opened again meanwhile.
            if catch_up() and self._until_s == until_s:
                self._until_s = None

    def holds(self, waits: Callable[[], bool]) -> bool:
        """Whether the frames that were just decoded may have waited; `waits` says whether more bytes do."""
        until_s = self._until_s
        if until_s is None:
            return False
        if time.monotonic() >= until_s and not waits():
            self._until_s = None
        return True
