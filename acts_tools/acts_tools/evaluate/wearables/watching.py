# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A worn skin as the reconstruction sees it: baseline, fusion and the detector of impacts."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.sampling import SkinMap
from acts_core.skin import Layout
from acts_recon.fusion import known_noise
from acts_recon.images import BaselineSubtraction
from acts_recon.impacts import Impact
from acts_recon.settings import ReconstructionSettings
from acts_sim.wearables import WORN_RATE_HZ, WornScene
from acts_tools.evaluate.scene_frames import DETECTOR_TOUCH_COUNTS, Frame, frames_of

SCHEME = "tracking"
THRESHOLD_COUNTS = 60
"""Above which the board follows a taxel, as shipped: of raw counts, so above the offsets."""


class Watcher:
    """Looks at the frames of one skin.

    Parameters
    ----------
    arranged : Layout
    noise_counts : float
        Of a reading.
    """

    def __init__(self, arranged: Layout, noise_counts: float) -> None:
        self.skin_map = None if arranged.is_matrix else SkinMap.of(arranged)
        settings = ReconstructionSettings(
            rows=arranged.matrix_rows,
            cols=arranged.matrix_cols,
            layout=arranged.name,
            touch_counts=DETECTOR_TOUCH_COUNTS,
            noise_counts=known_noise(noise_counts),
        )
        self.recovery = settings.recovery()
        self._baseline = BaselineSubtraction(arranged.taxels.size)
        self._detector = settings.impact_detector(self.recovery)

    def set_baseline(self, counts: NDArray[np.float32]) -> None:
        """What each taxel of the matrix reads untouched; np.ndarray [shape=(size,), dtype=float32]."""
        self._baseline.set(counts, np.ones(counts.size, dtype=bool))

    def reset(self) -> None:
        """Forget all frames."""
        self.recovery.reset()
        self._detector.reset()

    def step(self, frame: Frame) -> tuple[Impact, ...]:
        """What is told after the next frame."""
        recovery = self.recovery
        counts = self._baseline.apply(frame.indices, frame.counts)
        recovery.step(frame.indices, counts, frame.end_s, frame.duration_s)
        return self._detector.step(
            frame.end_s, frame.duration_s, recovery.image, recovery.sigma, recovery.age_s, recovery.measured
        )

    def watch(self, shown: WornScene, m: int, noise_counts: float, seed: int) -> list[tuple[float, Impact]]:
        """What is told of a scene, each with the end of the frame that told it [s]."""
        self.reset()
        self.set_baseline(shown.baseline)
        return [
            (frame.end_s, impact)
            for frame in frames_of(
                shown.frames, WORN_RATE_HZ, SCHEME, m, THRESHOLD_COUNTS, noise_counts, seed, self.skin_map
            )
            for impact in self.step(frame)
        ]
