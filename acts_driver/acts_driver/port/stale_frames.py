# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Stale frames: those of an earlier session that a board's USB buffer still holds when the port is opened again."""

from __future__ import annotations

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, Reply, UnknownReply
from acts_driver.protocols import Decoder


class StaleFrames:
    """Drops the frames that came before a board's first reply, which may be of an earlier session.

    The USB buffer of a Teensy keeps up to 8 KB that a host did not read, and sends them to the next host.

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
        self._before_answer: int | None = None
        self.is_over = False

    def receive(self, message: BoardMessage) -> None:
        """Note the first reply; called with every message while bytes are decoded."""
        if isinstance(message, Reply | UnknownReply) and self._before_answer is None:
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
        return frames[max((self._before_answer or 0) - first, 0) :]
