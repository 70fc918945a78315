# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Search for the largest value that satisfies a condition, one trial at a time."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Search:
    """Doubles the value until the condition fails (or halves it until it holds), then bisects the interval.

    The caller makes the trials, so that several searches can take turns under the same load of the machine::

        while not search.done:
            search.answer(holds(search.value))

    Parameters
    ----------
    value : float
        First value to try, later the next one.
    minimum, maximum : float
        Smallest and largest value to try.
    resolution : float
        Relative width of the interval at which to stop, above 0.
    tries : int
        Number of failed trials in a row that reject a value, so that one stall of the machine does not.

    Attributes
    ----------
    good : float or None
        Largest value for which the condition held; None before the first.
    bad : float or None
        Smallest rejected value.
    done : bool
        Whether the search has ended.
    """

    value: float
    minimum: float
    maximum: float
    resolution: float
    tries: int
    good: float | None = None
    bad: float | None = None
    done: bool = False
    _failed: int = 0

    def answer(self, holds: bool) -> None:
        """Set whether the condition held at `value`, and choose the next value."""
        if holds:
            self.good = self.value
        else:
            self._failed += 1
            if self._failed < self.tries:
                return
            self.bad = self.value
        self._failed = 0
        if self.good is None:
            self.done = self.value <= self.minimum
            self.value = max(self.value / 2, self.minimum)
        elif self.bad is None:
            self.done = self.value >= self.maximum
            self.value = min(self.value * 2, self.maximum)
        else:
            self.done = self.bad - self.good <= self.resolution * self.good
            self.value = (self.good + self.bad) / 2
