# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Impacts: told at the first touch, and when over with time, force, path, direction and what kind of touch it was.

In come images with how sure they are and when each taxel was measured; out come touches that begin and that are over.
"""

from acts_recon.impacts.config import ImpactConfig
from acts_recon.impacts.detector import ImpactDetector
from acts_recon.impacts.footprint_fit import Footprint, fit_footprint
from acts_recon.impacts.impact import UNKNOWN_DIRECTION_SD_RAD, Impact, Kind

__all__ = ["UNKNOWN_DIRECTION_SD_RAD", "Footprint", "Impact", "ImpactConfig", "ImpactDetector", "Kind", "fit_footprint"]
