# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics of the three nodes, and why they run on the system's clock."""

from __future__ import annotations

STATE_TOPIC = "ball/state"
REFERENCE_TOPIC = "ball/reference"
STATUS_TOPIC = "ball/status"
TILT_TOPIC = "ball/tilt"
CONTACT_TOPIC = "contact"
STATISTICS_TOPIC = "contact_statistics"

CLOCK_REASON = "robot and touch are real, and are stamped by it"
"""Why the nodes do not run on simulated time."""
