# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The method ``fusion``: all samples so far (`acts_recon.fusion`)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_recon.fusion import FusionConfig, FusionEstimator
from acts_recon.methods.method import Method, NoSettings, SkinSetup


class Fusion(Method):
    """See `Method` and `FusionEstimator`."""

    summary = "the image is estimated from all samples so far"
    is_uncertainty_known = True

    def __init__(self, skin: SkinSetup, config: NoSettings | None = None) -> None:
        self._estimator = FusionEstimator(skin.geometry, FusionConfig(noise_counts=skin.noise_counts), skin.layout)
        self.image = self._estimator.image
        self.sigma = self._estimator.sigma
        self.age_s = self._estimator.age_s
        self.measured = self._estimator.measured

    def reset(self) -> None:
        """See `Method.reset`."""
        self._estimator.reset()

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        return self._estimator.step(indices, counts, end_s, duration_s)

    def set_noise(self, noise_counts: NDArray[np.float32], valid: NDArray[np.bool_]) -> None:
        """See `Method.set_noise`."""
        self._estimator.set_noise(noise_counts, valid)

    def confidence(self) -> NDArray[np.uint8]:
        """See `Method.confidence`."""
        return self._estimator.confidence()
