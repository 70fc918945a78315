# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Random numbers that are the same on every machine, on the board too."""

from __future__ import annotations


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
