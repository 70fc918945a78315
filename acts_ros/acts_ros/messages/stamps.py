# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Stamps of messages as numbers, and numbers as stamps."""

from __future__ import annotations

from builtin_interfaces.msg import Time

from acts_core.runtime import NS_PER_S


def ns_of(stamp: Time) -> int:
    """ROS time of a stamp [ns]."""
    return int(stamp.sec * NS_PER_S + stamp.nanosec)


def seconds_of(stamp: Time) -> float:
    """ROS time of a stamp [s], within a quarter of a microsecond."""
    return float(stamp.sec + 1e-9 * stamp.nanosec)


def set_stamp(stamp: Time, time_ns: int) -> None:
    """Write ROS time [ns] into a stamp."""
    stamp.sec, stamp.nanosec = divmod(time_ns, NS_PER_S)
