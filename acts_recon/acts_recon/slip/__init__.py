# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Slip: how far a pattern of pressure moves along the skin, and whether that is sliding.

In come images, one after another; out come the motion in metres and events of slip (docs/slip.md).
"""

from acts_recon.slip.config import SlipConfig
from acts_recon.slip.detector import SlipDetector
from acts_recon.slip.motion import SMALLEST_SIDE
from acts_recon.slip.watch import NO_SLIP, Slip, SlipWatch

__all__ = ["NO_SLIP", "SMALLEST_SIDE", "Slip", "SlipConfig", "SlipDetector", "SlipWatch"]
