# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Gait from insoles: steps, cadence, path of the centre of pressure, left against right.

In come force and centre of pressure of each foot over time, in any unit of force; out come steps, and a summary of the
walk.
"""

from acts_recon.gait.config import GaitConfig
from acts_recon.gait.foot import FootTracker
from acts_recon.gait.force_curve import force_and_centre
from acts_recon.gait.loads import Loads
from acts_recon.gait.step import Step
from acts_recon.gait.summary import FootGait, Gait, summarise
from acts_recon.gait.tracker import FEET, GaitTracker

__all__ = [
    "FEET",
    "FootGait",
    "FootTracker",
    "Gait",
    "GaitConfig",
    "GaitTracker",
    "Loads",
    "Step",
    "force_and_centre",
    "summarise",
]
