# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Somebody who walks on two insoles.

In come cadence, weight and the time of standing; out come the frames of both insoles at any times, and the true steps.
"""

from acts_sim.walking.walk import Footfall, Walk, Walking, walk

__all__ = ["Footfall", "Walk", "Walking", "walk"]
