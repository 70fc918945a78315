# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Impacts: one report when a touch begins, and one when it is over, with time, force, path, direction and kind.

In come images, the standard deviation of each taxel and the time at which it was measured; out come `Impact` reports.
"""

from acts_recon.impacts.config import ImpactConfig
from acts_recon.impacts.detector import ImpactDetector
from acts_recon.impacts.footprint_fit import Footprint, fit_footprint
from acts_recon.impacts.impact import UNKNOWN_DIRECTION_SD_RAD, Impact, Kind

__all__ = ["UNKNOWN_DIRECTION_SD_RAD", "Footprint", "Impact", "ImpactConfig", "ImpactDetector", "Kind", "fit_footprint"]
