# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Motors that vibrate on a skin.

In come a motor and how hard it is held; out come full frames at a high rate, and what really happened: the force.
"""

from acts_sim.vibrations.motor import VIBRATION_RATE_HZ, Motor, Vibration, vibration

__all__ = ["VIBRATION_RATE_HZ", "Motor", "Vibration", "vibration"]
