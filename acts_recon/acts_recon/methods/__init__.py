# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The methods of recovery that the node and `acts evaluate` offer: a method is a module here and a line in `registry`.

In come the samples of frame after frame; out come images, their uncertainty if the method has one, and the contact.
"""

from acts_recon.methods.fusion import Fusion
from acts_recon.methods.method import Method, NoSettings, SkinSetup
from acts_recon.methods.per_frame import PerFrame, PerFrameConfig
from acts_recon.methods.recovery import Recovery
from acts_recon.methods.registry import METHODS

__all__ = ["METHODS", "Fusion", "Method", "NoSettings", "PerFrame", "PerFrameConfig", "Recovery", "SkinSetup"]
