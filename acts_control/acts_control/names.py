# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names and small translations that the three nodes share."""

from __future__ import annotations

from typing import Any

STATE_TOPIC = "ball/state"
REFERENCE_TOPIC = "ball/reference"
STATUS_TOPIC = "ball/status"
TILT_TOPIC = "ball/tilt"
CONTACT_TOPIC = "contact"
STATISTICS_TOPIC = "contact_statistics"

CLOCK_REASON = "robot and touch are real, and are stamped by it"
"""Why the nodes do not run on simulated time."""

_NS_PER_S = 1_000_000_000


def to_ns(stamp: Any) -> int:
    """A builtin_interfaces/Time as nanoseconds."""
    return int(stamp.sec * _NS_PER_S + stamp.nanosec)


def set_stamp(stamp: Any, time_ns: int) -> None:
    """Write nanoseconds into a builtin_interfaces/Time."""
    stamp.sec, stamp.nanosec = divmod(time_ns, _NS_PER_S)
