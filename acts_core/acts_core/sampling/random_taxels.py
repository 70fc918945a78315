"""Random taxels, the same as the board draws."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

RANDOM_STREAM = 1
"""PCG32 stream that draws random taxels; the virtual board's noise has another."""


class Pcg32:
    """PCG-XSH-RR 64/32, the same random numbers as on the board (M. E. O'Neill, HMC-CS-2014-0905)."""

    _MULTIPLIER = 6364136223846793005
    _MASK64 = 2**64 - 1

    def __init__(self, seed: int, stream: int) -> None:
        self._increment = (stream << 1 | 1) & self._MASK64
        self._state = 0
        self.next()
        self._state = (self._state + seed) & self._MASK64
        self.next()

    def next(self) -> int:
        """A whole number from 0 to 2**32 - 1."""
        state = self._state
        self._state = (state * self._MULTIPLIER + self._increment) & self._MASK64
        shifted = ((state >> 18 ^ state) >> 27) & 0xFFFFFFFF
        rotation = state >> 59
        return (shifted >> rotation | shifted << (32 - rotation & 31)) & 0xFFFFFFFF

    def below(self, bound: int) -> int:
        """A whole number from 0 to ``bound - 1``, every one equally likely (D. Lemire, doi:10.1145/3230636)."""
        product = self.next() * bound
        if product & 0xFFFFFFFF < bound:
            unfair = (2**32 - bound) % bound
            while product & 0xFFFFFFFF < unfair:
                product = self.next() * bound
        return product >> 32


_NONE = np.empty(0, dtype=np.uint16)


class RandomTaxels:
    """Draws distinct taxels, frame after frame (the first steps of a Fisher-Yates shuffle that is never undone)."""

    def __init__(self, rows: int, cols: int, seed: int) -> None:
        self._taxels = np.arange(rows * cols, dtype=np.uint16)
        self._random = Pcg32(seed, RANDOM_STREAM)

    def draw(self, m: int, *, measured: NDArray[np.uint16] = _NONE) -> NDArray[np.uint16]:
        """`m` distinct taxel indices, none of those in `measured`; shape (m,), uint16."""
        taxels = self._taxels
        # Those that are not to be drawn go to the front, in their order, where the shuffle begins behind them.
        for i, index in enumerate(measured):
            self._swap(i, int(np.flatnonzero(taxels == index)[0]))
        first = len(measured)
        for i in range(first, first + m):
            self._swap(i, i + self._random.below(len(taxels) - i))
        return taxels[first : first + m].copy()

    def _swap(self, i: int, j: int) -> None:
        taxels = self._taxels
        taxels[i], taxels[j] = taxels[j], taxels[i]
