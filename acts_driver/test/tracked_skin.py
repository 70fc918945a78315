# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A skin whose baseline is tracked, and the stream that it gets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.frames import SampleFrame, Scheme
from acts_driver.baseline import BaselineTracker
from acts_driver.baseline.baseline_config import BaselineConfig

ROWS, COLS = 6, 5
SIZE = ROWS * COLS
FRAME_NS = 10_000_000
CONFIG = BaselineConfig(tare_s=0.2, calibration_blocks=5, tau_s=5.0, hold_s=0.5)


class Skin:
    """A tracker and what its stream brings: `m` taxels a frame in turn, 100 frames a second."""

    def __init__(self, config: BaselineConfig = CONFIG, m: int = SIZE, noise: float = 1.5) -> None:
        self.tracker = BaselineTracker(ROWS, COLS, config)
        self.field = np.full((ROWS, COLS), 20.0)
        self.rng = np.random.default_rng(3)
        self.noise = noise
        self.m = m
        self.frames = 0
        self.now_ns = 1_790_000_000_000_000_000

    def run(self, seconds: float, field: NDArray | None = None) -> None:
        for _ in range(round(seconds * 100)):
            truth = (self.field if field is None else field).ravel()
            indices = ((np.arange(self.m) + self.frames * self.m) % SIZE).astype(np.uint16)
            noisy = truth[indices] + self.rng.normal(0, self.noise, self.m)
            counts = np.clip(np.rint(noisy), 0, 1023).astype(np.uint16)
            frame = SampleFrame(self.frames, 0, 0, Scheme.UNIFORM, ROWS, COLS, 0, indices, counts)
            self.tracker.observe([(frame, self.now_ns)])
            self.frames += 1
            self.now_ns += FRAME_NS

    def pressed(self, row: int = 2, col: int = 2, counts: float = 400.0) -> NDArray:
        field = self.field.copy()
        field[row : row + 2, col : col + 2] += counts
        return field
