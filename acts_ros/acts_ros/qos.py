# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Quality of service of the ACTS topics.

1 kHz topics are best effort, topics for viewers are reliable, and descriptions of a skin are kept for late joiners.
For publishers and subscriptions made with `overridable`, ``qos_overrides`` in a params file can change this.
"""

from copy import copy
from typing import Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

STREAM = QoSProfile(
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    # A quarter of a second at 1 kHz: a subscriber that is delayed by less loses nothing.
    depth=256,
)
"""1 kHz topics: samples, contact, cop, image_raw."""

VIEW = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=5,
)
"""Topics for viewers, at most 30 Hz: image."""

STATE = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=50,
)
"""States, references and statistics up to a few hundred hertz."""

LATCHED = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
)
"""Settings and baselines: late joiners get the last one."""


def overridable(profile: QoSProfile) -> dict[str, Any]:
    """Keyword arguments for a publisher or subscription whose quality of service a params file may override.

    The profile is copied, because rclpy writes the overrides into the profile that it is given.
    """
    return {"qos_profile": copy(profile), "qos_overriding_options": QoSOverridingOptions.with_default_policies()}
