# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Stamps of messages as numbers."""

from __future__ import annotations

from builtin_interfaces.msg import Time


def seconds_of(stamp: Time) -> float:
    """ROS time of a stamp [s], within a quarter of a microsecond."""
    return float(stamp.sec + 1e-9 * stamp.nanosec)
