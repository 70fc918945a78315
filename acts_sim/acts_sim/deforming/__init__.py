# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Soft objects that meet a skin for some milliseconds: their pressure, and the true outline of where they touch.

In comes an object; out come full frames at a high rate, and the outline at any time.
"""

from acts_sim.deforming.bodies import BODIES, Body, body_named
from acts_sim.deforming.soft_contact import SoftContact, soft_contact

__all__ = ["BODIES", "Body", "SoftContact", "body_named", "soft_contact"]
