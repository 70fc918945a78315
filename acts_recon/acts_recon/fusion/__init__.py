# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fusion of samples over time: an image at every frame out of all samples so far.

In come samples, frame after frame; out come the image and the standard deviation of each taxel. The tests compare
the kernels with a reference implementation in double precision.
"""

from acts_recon.fusion.fusion import FusionConfig, FusionEstimator
from acts_recon.fusion.fusion_state import known_noise

__all__ = ["FusionConfig", "FusionEstimator", "known_noise"]
