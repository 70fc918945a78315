# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images and objects that the board recovered itself, with the stamps of their frames."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from typing import TypeAlias

from acts_core.frames import SampleFrame
from acts_core.wire import BoardImage, BoardMessage, BoardObject

BoardResult: TypeAlias = BoardImage | BoardObject

_KEPT = 256


class BoardResults:
    """Matches results with the frames that they were made of, so that both have the same stamp.

    A result follows its frame on the wire, mostly in a later read but sometimes in the same one. One whose frame was
    not accepted (lost, repeated, of a wrong size) is dropped: there is no time to stamp it with.

    Attributes
    ----------
    results : int
        Results that were given a stamp.
    dropped : int
        Results whose frame was not accepted.
    """

    def __init__(self) -> None:
        # By number and board time: a board that was reset uses the numbers again.
        self._stamps: OrderedDict[tuple[int, int], int] = OrderedDict()
        self._waiting: list[BoardResult] = []
        self.results = 0
        self.dropped = 0

    def receive(self, message: BoardMessage) -> None:
        """Keep a message of the board until `stamped` if it is a result."""
        if isinstance(message, BoardImage | BoardObject):
            self._waiting.append(message)

    def has_results(self) -> bool:
        """Whether any result waits for `stamped`."""
        return bool(self._waiting)

    def stamped(self, accepted: Sequence[tuple[SampleFrame, int]]) -> list[tuple[BoardResult, int]]:
        """The results that were taken since the last call, with the stamps of their frames.

        Parameters
        ----------
        accepted : sequence of (SampleFrame, int)
            The frames of the same read, as `FrameStream.accept` returns them; none where there were none.
        """
        stamps = self._stamps
        for frame, stamp_ns in accepted:
            stamps[frame.sequence, frame.board_us] = stamp_ns
        while len(stamps) > _KEPT:
            stamps.popitem(last=False)
        if not self._waiting:
            return []
        waiting, self._waiting = self._waiting, []
        found = [(result, stamps.get((result.sequence, result.board_us))) for result in waiting]
        matched = [(result, stamp_ns) for result, stamp_ns in found if stamp_ns is not None]
        self.results += len(matched)
        self.dropped += len(found) - len(matched)
        return matched
