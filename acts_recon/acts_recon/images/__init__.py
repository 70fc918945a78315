# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is true of every tactile image: its borders, its noise, its baseline, and what a frame must be.

In come frames and layouts; out come tables and checks by which the methods of recovery work, and images as bytes.
"""

from acts_recon.images.baseline import BaselineSubtraction
from acts_recon.images.borders import Borders, borders_of, grown
from acts_recon.images.image import mono16, rgb8
from acts_recon.images.placed_samples import PlacedSamples
from acts_recon.images.uncertainty import (
    ERR_TOGETHER,
    FAR,
    NOISE_COUNTS,
    Variances,
    root_deviation,
    slope_table,
    variances,
)
from acts_recon.images.uncertainty_kernels import force_of, taxel_variances

__all__ = [
    "ERR_TOGETHER",
    "FAR",
    "NOISE_COUNTS",
    "BaselineSubtraction",
    "Borders",
    "PlacedSamples",
    "Variances",
    "borders_of",
    "force_of",
    "grown",
    "mono16",
    "rgb8",
    "root_deviation",
    "slope_table",
    "taxel_variances",
    "variances",
]
