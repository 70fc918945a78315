"""Quality of service of the ACTS topics.

1 kHz topics are best effort, what a viewer shows is reliable, what describes a skin is kept for late joiners. Where a
publisher or subscription is made with `overridable`, a params file changes that by the standard ``qos_overrides``.
"""

from copy import copy
from typing import Any

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

STREAM = QoSProfile(
    reliability=ReliabilityPolicy.BEST_EFFORT,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    # A quarter of a second at 1 kHz: a subscriber that was not scheduled for that long still loses nothing.
    depth=256,
)
"""1 kHz topics: samples, contact, cop, image_raw."""

VIEW = QoSProfile(
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE,
    history=HistoryPolicy.KEEP_LAST,
    depth=5,
)
"""What viewers show, at most 30 Hz: image."""

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
"""Settings and baselines: the last one reaches late joiners."""


def overridable(profile: QoSProfile) -> dict[str, Any]:
    """Keyword arguments for a publisher or subscription whose quality of service a params file may override.

    The profile is copied: rclpy writes the overrides into the one it is given, and so into every later user's.
    """
    return {"qos_profile": copy(profile), "qos_overriding_options": QoSOverridingOptions.with_default_policies()}
