# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What all methods of recovery use: borders between patches, dead taxels, noise, the baseline, and checks of a frame.

In come frames and layouts; out come tables, checked samples, and images as bytes of messages.
"""

from acts_recon.images.baseline import BaselineSubtraction
from acts_recon.images.borders import Borders, borders_of
from acts_recon.images.dead_taxels import NO_DEAD, DeadTable, DeadTaxels, DeadTaxelsConfig, fill_dead
from acts_recon.images.frame_check import LONGEST_PAUSE_S, require_image, require_recovered, require_times
from acts_recon.images.image import mono16, rgb8
from acts_recon.images.placed_samples import PlacedSamples
from acts_recon.images.uncertainty import (
    ERR_TOGETHER,
    FAR,
    LEAST_NOISE_COUNTS,
    NOISE_COUNTS,
    slope_table,
)
from acts_recon.images.uncertainty_kernels import SMALLEST_DIVISOR, force_of, taxel_variances

__all__ = [
    "ERR_TOGETHER",
    "FAR",
    "LEAST_NOISE_COUNTS",
    "LONGEST_PAUSE_S",
    "NOISE_COUNTS",
    "NO_DEAD",
    "SMALLEST_DIVISOR",
    "BaselineSubtraction",
    "Borders",
    "DeadTable",
    "DeadTaxels",
    "DeadTaxelsConfig",
    "PlacedSamples",
    "borders_of",
    "fill_dead",
    "force_of",
    "mono16",
    "require_image",
    "require_recovered",
    "require_times",
    "rgb8",
    "slope_table",
    "taxel_variances",
]
