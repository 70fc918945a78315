# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Streams of frames for the tests of fusion: samples of what moves, and frames of anything at any time."""

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.sampling import Sampler, SamplingConfig

DURATION_S = 55 * 17.877e-6
SMALL = ArrayGeometry(rows=9, cols=13)

Frame = tuple[NDArray[np.uint16], NDArray[np.uint16]]


class Skin:
    """Samples a field that changes with time, each taxel at its own time, tracking what is pressed.

    Parameters
    ----------
    field : callable
        From time [s] to clean counts (rows, cols).
    """

    def __init__(self, field: Callable[[float], NDArray[np.floating]], *, noise: float = 0.0, m: int = 55) -> None:
        self.field = field
        self.noise = noise
        self.m = m
        rows, cols = field(0.0).shape
        self._rng = np.random.default_rng(3)
        self._sampler = Sampler(SamplingConfig("tracking", rows, cols, m, threshold_counts=15))

    def frame(self, end_s: float) -> Frame:
        first, last = self.field(end_s - DURATION_S), self.field(end_s)
        taken = 0

        def measure(row: int, col: int) -> int:
            nonlocal taken
            taken += 1
            share = taken / self.m
            clean = (1 - share) * first[row, col] + share * last[row, col]
            return int(np.clip(np.rint(clean + self.noise * self._rng.standard_normal()), 0, 1023))

        return self._sampler.frame(measure)


def sliding(speed_taxels_per_s: float, *, row: float = 16.0) -> Callable[[float], NDArray[np.floating]]:
    """A round contact that comes down within 10 ms and then slides along the columns."""
    r, c = np.indices((32, 32))

    def field(time_s: float) -> NDArray[np.floating]:
        col = 5.0 + speed_taxels_per_s * max(time_s - 0.02, 0.0)
        peak = 700 * min(max(time_s, 0.0) / 0.01, 1.0)
        return peak * np.exp(-((r - row) ** 2 + (c - col) ** 2) / (2 * 2.0**2))

    return field


@st.composite
def streams(draw: st.DrawFn) -> list[tuple[Frame, float, float]]:
    """Frames of any size with gaps, repeated times, jumps and samples that took longer than frames are apart."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    calm = draw(st.booleans())
    time_s = draw(st.floats(-1e6, 1e6))
    frames = []
    for step_s in draw(st.lists(st.sampled_from([1e-3, 1e-3, 1e-3, 0.0, 1e-7, 0.03, 0.4, 5.0, -2.0]), max_size=12)):
        time_s += step_s
        indices = rng.permutation(SMALL.size)[: rng.integers(1, SMALL.size + 1)].astype(np.uint16)
        field = 8 * rng.random(SMALL.size) if calm else 1300 * rng.random(SMALL.size) - 200
        counts = np.clip(field, 0, 1023).astype(np.uint16)[indices]
        frames.append(((indices, counts), time_s, float(rng.choice([0.0, 1e-3, 0.02]))))
    return frames
