# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether frames continue a stream or begin it anew, and whether two sources publish in turn."""

from __future__ import annotations

from typing import NamedTuple

_MODULUS = 1 << 32
_HALF = 1 << 31
# A source goes on with a number at most so much larger, and has ended where it does not among so many frames.
_NEAR = 64


class _Place(NamedTuple):
    """Where a source is: number and time of its newest frame [us]."""

    sequence: int
    time_us: int


class FrameOrder:
    """Follows a stream by the numbers and times of its frames.

    A number that goes back is of a board that began anew. Where numbers go on then from before, none began: frames of
    two sources come in turn, as where two nodes publish on the same topic. `acts_core.runtime.SequenceNumbers` looks at
    numbers in much the same way, but to count what is missing.

    Attributes
    ----------
    changes : int
        How often a frame was of the other one of two sources.
    restarts : int
        How often the stream began anew otherwise.
    """

    def __init__(self) -> None:
        self.changes = self.restarts = 0
        self._sequence = -1
        self._time_us = -1
        # Where numbers went back from, and for how many frames it is still remembered.
        self._other: _Place | None = None
        self._left = 0

    def step(self, sequence: int, time_us: int) -> bool:
        """Update by the next frame.

        Parameters
        ----------
        sequence : int
            Its number, modulo 2^32.
        time_us : int
            Its time by the clock of its source [us].

        Returns
        -------
        bool
            Whether the stream begins anew with it: what was remembered is of another board, or of another time of it.
        """
        if self._other is None and (0 < (sequence - self._sequence) % _MODULUS < _HALF or self._sequence < 0):
            self._sequence, self._time_us = sequence, time_us
            return False
        this, last = _Place(sequence, time_us), _Place(self._sequence, self._time_us)
        self._sequence, self._time_us = sequence, time_us
        is_other = self._other is not None and _is_nearer(this, self._other, last)
        self.changes += is_other
        if is_other or _ahead(this, last) <= 0:
            self.restarts += not is_other
            self._other, self._left = last, _NEAR
            return True
        self._left -= 1
        if self._left <= 0:
            self._other = None
        return False


def _ahead(this: _Place, last: _Place) -> int:
    """How many numbers a frame is after another one; negative where it is before it."""
    difference = (this.sequence - last.sequence) % _MODULUS
    return difference if difference < _HALF else difference - _MODULUS


def _is_nearer(this: _Place, other: _Place, last: _Place) -> bool:
    """Whether a frame continues the other source, and more closely than the last frame."""
    after_other, after_last = _ahead(this, other), _ahead(this, last)
    if not 0 < after_other <= _NEAR or this.time_us <= other.time_us:
        return False
    if after_last <= 0 or after_other != after_last:
        return after_last <= 0 or after_other < after_last
    # Clearly: a board that began anew twice comes by the number of its last life at about the time of that.
    return 2 * (this.time_us - other.time_us) < abs(this.time_us - last.time_us)
