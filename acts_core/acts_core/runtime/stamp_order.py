# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The order of stamps in a stream, and whether its clock was set."""

from __future__ import annotations

from enum import Enum

NS_PER_S = 1_000_000_000
"""Nanoseconds in a second."""

# A stamp farther ahead than this does not follow the one before; in a slow stream, so many of its intervals.
_GAP_NS = NS_PER_S // 20
_GAP_INTERVALS = 5

# So many in a row that follow one another, but not the stream, are a stream whose clock was set, or that has paused. Of
# them, only those of different streams are farther apart than this.
_CONFIRMED = 5
_SLOWEST_NS = NS_PER_S


class Order(Enum):
    """What a stamp is to the stream before it."""

    NEXT = "it continues the stream"
    STRAY = "it is repeated, late, or of another clock: not to be used"
    ANEW = "the stream begins anew with it: what was remembered of the one before does not belong to it"


class StampOrder:
    """Follows the stamps of a stream, whatever its clock does.

    A single wrong stamp, a second ahead or a year back, is left out and changes nothing. Where a clock was set, or the
    stream has paused, five messages in a row follow one another, and are followed from the fifth on.
    """

    def __init__(self) -> None:
        self._newest_ns: int | None = None
        self._gap_ns = _GAP_NS
        self._stray_ns = 0
        self._strays_in_a_row = 0

    def step(self, stamp_ns: int) -> Order:
        """Update by the stamp of the next message [ns]."""
        if self._newest_ns is None:
            self._newest_ns = stamp_ns
            return Order.ANEW
        if 0 < stamp_ns - self._newest_ns <= self._gap_ns:
            self._newest_ns, self._strays_in_a_row = stamp_ns, 0
            return Order.NEXT
        interval_ns, self._stray_ns = stamp_ns - self._stray_ns, stamp_ns
        is_in_a_row = self._strays_in_a_row > 0 and 0 < interval_ns <= _SLOWEST_NS
        self._strays_in_a_row = self._strays_in_a_row + 1 if is_in_a_row else 1
        if self._strays_in_a_row < _CONFIRMED:
            return Order.STRAY
        self._newest_ns, self._strays_in_a_row = stamp_ns, 0
        self._gap_ns = max(_GAP_NS, _GAP_INTERVALS * interval_ns)
        return Order.ANEW
