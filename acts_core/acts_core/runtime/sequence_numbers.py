# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The numbers of the messages of a stream: which are missing, also where a second source mixes its own with them."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

_MODULUS = 1 << 32
_HALF = 1 << 31

# Places that numbers have jumped away from are remembered for so many messages. A number follows one of them where it
# is not farther ahead of it than this.
_PLACES = 8
_REMEMBERED = 64
_NEAR = 1000


class _Place(NamedTuple):
    """The last number before a jump, how many were counted as missing there, and the messages that had come by then."""

    number: int
    missing: int
    received: int


class SequenceNumbers:
    """Counts what is missing in a stream whose messages are numbered, modulo 2^32.

    A number that goes back is a source that began anew, not a loss. Where numbers jump ahead and then go on from before
    the jump, nothing was lost there: two sources publish, or a message was overtaken. Whether a stream of frames begins
    anew, `acts_recon.frame_order.FrameOrder` decides.

    Attributes
    ----------
    lost : int
        Numbers missing so far. It goes back where what was counted as missing comes after all.
    """

    def __init__(self) -> None:
        self.lost = 0
        self._last: int | None = None
        self._received = 0
        self._places: deque[_Place] = deque(maxlen=_PLACES)

    def step(self, sequence: int) -> int:
        """Count a message.

        Parameters
        ----------
        sequence : int
            Its number.

        Returns
        -------
        int
            Numbers missing before it.
        """
        last, self._last = self._last, sequence
        self._received += 1
        if last is None or sequence == last:
            return 0
        missing = (sequence - last - 1) % _MODULUS
        return self._jump(last, sequence, missing) if missing else 0

    def _jump(self, last: int, sequence: int, missing: int) -> int:
        lost = missing if missing < _HALF else 0
        before = self._place_before(sequence, missing)
        if before is not None:
            # The message before this one was another source's.
            self._places.remove(before)
            self.lost -= before.missing
            lost = (sequence - before.number - 1) % _MODULUS
        self._places.append(_Place(last, lost if before is None else 0, self._received))
        self.lost += lost
        return lost

    def _place_before(self, sequence: int, missing: int) -> _Place | None:
        """The place that a number follows more closely than the last number."""
        # So begins who begins anew, unless it is what comes next at a place that another source jumped away from.
        begins_anew = sequence == 0 and missing >= _HALF
        nearest, found = min(missing, _NEAR), None
        for place in self._places:
            ahead = (sequence - place.number - 1) % _MODULUS
            if begins_anew and (ahead or 0 < place.missing <= _NEAR):
                continue
            # What came after numbers that were missing is not among them.
            is_among = ahead < place.missing or not place.missing
            if ahead < nearest and is_among and self._received - place.received <= _REMEMBERED:
                nearest, found = ahead, place
        return found
