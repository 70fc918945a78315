# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a 1 kHz stream was like lately: smallest and largest values of short intervals. Knows no ROS."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

COLUMNS = ("time_s", "frames", "lost", "force_min_n", "force_max_n", "latency_min_ms", "latency_max_ms")
"""Of an interval: its beginning; frames in it and lost before them; force; from stamp to reception (NaN: not known)."""

_CLOCK_WENT_BACK_S = 1.0


class Place(NamedTuple):
    """How far somebody has read a `History`."""

    life: int = -1
    intervals: int = 0


class History:
    """The last intervals of a stream, in a ring of constant size.

    Parameters
    ----------
    interval_s : float
        Length of an interval [s].
    length_s : float
        For how long they are kept [s].
    """

    def __init__(self, interval_s: float = 0.008, length_s: float = 60.0) -> None:
        self._interval_s = interval_s
        self._ring = np.full((math.ceil(length_s / interval_s), len(COLUMNS)), np.nan)
        self._life = 0
        self._done = 0
        self._number: int | None = None
        self._row: list[float] = []

    def add(self, stamp_s: float, force_n: float, latency_ms: float, lost: int) -> None:
        """Take in a frame.

        Parameters
        ----------
        stamp_s : float
            Frames come in the order of their stamps. One a little older than the last counts with it; where time goes
            back by more than a second, all before is forgotten.
        force_n, latency_ms : float
            Latency NaN: not known.
        lost : int
            Frames missing before this one.
        """
        number = math.floor(stamp_s / self._interval_s)
        if self._number is not None and (number - self._number) * self._interval_s < -_CLOCK_WENT_BACK_S:
            self.forget()
        if self._number is None or number > self._number:
            self._close()
            self._number = number
            self._row = [number * self._interval_s, 1, lost, force_n, force_n, latency_ms, latency_ms]
            return
        row = self._row
        row[1] += 1
        row[2] += lost
        if force_n < row[3]:
            row[3] = force_n
        elif force_n > row[4]:
            row[4] = force_n
        # NaN beside a number gives the number; NaN is not equal to itself.
        if latency_ms < row[5] or row[5] != row[5]:
            row[5] = latency_ms
        if latency_ms > row[6] or row[6] != row[6]:
            row[6] = latency_ms

    def forget(self) -> None:
        """Begin anew."""
        self._life += 1
        self._done = 0
        self._number = None

    def since(self, place: Place) -> tuple[NDArray[np.float64], Place]:
        """What is complete and new to somebody.

        Parameters
        ----------
        place : Place
            As this method gave it last; a new one for all there is.

        Returns
        -------
        np.ndarray [shape=(n, 7), dtype=float64]
            `COLUMNS`, oldest first. Where the reader was away for longer than is kept, it begins with the oldest.
        Place
            For the next call. Another `Place.life` than before: forget what was read.
        """
        capacity = len(self._ring)
        read = place.intervals if place.life == self._life else 0
        numbers = np.arange(max(read, self._done - capacity), self._done) % capacity
        return self._ring[numbers], Place(self._life, self._done)

    def _close(self) -> None:
        if self._number is not None:
            self._ring[self._done % len(self._ring)] = self._row
            self._done += 1
