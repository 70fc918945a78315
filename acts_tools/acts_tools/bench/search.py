"""Find the largest value at which something still holds, a question at a time."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Search:
    """Doubles until it does not hold (or halves until it does), then halves the interval.

    It asks nothing itself, so that several searches can take turns and meet the same weather::

        while not search.done:
            search.answer(holds(search.value))

    Parameters
    ----------
    value : float
        Where to start, and later what to try next.
    minimum, maximum : float
        Smallest and largest value to try.
    resolution : float
        Relative width of the interval at which to stop, above 0.
    tries : int
        How many times in a row the answer has to be no: one stall of the machine does not decide.

    Attributes
    ----------
    good : float or None
        Largest value for which the answer was yes; None as long as there was none.
    bad : float or None
        Smallest value that was given up.
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
        """Tell whether it held at `value`, and choose the next one."""
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
