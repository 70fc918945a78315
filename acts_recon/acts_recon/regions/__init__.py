# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What each patch of a skin feels: force, centre, area, peak, spread, sharpness, motion and slip.

In comes the image with its layout; out comes a `RegionContact` for every patch that is touched.
"""

from acts_recon.regions.regions import Regions
from acts_recon.regions.sharpness import SharpnessConfig

__all__ = ["Regions", "SharpnessConfig"]
