# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Slip on one patch of skin, from images whose taxels were all measured at once."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.skin import SkinPatch
from acts_recon.images import require_image
from acts_recon.slip.config import SlipConfig
from acts_recon.slip.watch import NOISE_COUNTS, Slip, SlipWatch


class SlipDetector:
    """Watches one patch; `acts_recon.slip.watch.SlipWatch` watches many, and taxels measured at different times.

    Parameters
    ----------
    rows, cols : int
        Size of the patch.
    pitch_m : float
        Distance of neighbouring taxels [m].
    config : SlipConfig, optional
    noise_counts : float
        Standard deviation of a taxel of the images [counts].

    Raises
    ------
    ArrayError
        For a patch smaller than 3 by 3, or a pitch or noise that is not above 0.
    """

    def __init__(
        self, rows: int, cols: int, pitch_m: float, config: SlipConfig | None = None, noise_counts: float = NOISE_COUNTS
    ) -> None:
        if not 0.0 < pitch_m < math.inf:
            raise ArrayError(f"pitch_m = {pitch_m}: allowed is a finite number above 0 (m)")
        patch = SkinPatch("patch", 0, rows, 0, cols, pitch_m=pitch_m, row_pitch_m=pitch_m)
        self._watch = SlipWatch(rows, cols, [patch], config, noise_counts)
        self.config = self._watch.config
        self._shape = (rows, cols)
        self._counts = np.zeros(1)

    def reset(self) -> None:
        """Start anew, for instance after a pause."""
        self._watch.reset()

    def step(self, time_s: float, image: NDArray[np.float32]) -> Slip:
        """Update by the next image.

        Parameters
        ----------
        time_s : float
            Its time; where it goes back, or on by more than half a second, everything begins anew [s].
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts above the baseline, finite; not kept.

        Raises
        ------
        ArrayError
            When it has another shape or type, or it or the time is not finite.
        """
        require_image("image", image, self._shape)
        self._counts[0] = image.sum()
        if not (math.isfinite(time_s) and math.isfinite(self._counts[0])):
            # What is kept of them would tell of slip in all that follows.
            raise ArrayError(
                f"an image at {time_s} s whose counts add up to {self._counts[0]}: both must be finite; leave it out"
            )
        (slip,) = self._watch.step(time_s, image, self._counts)
        return slip
