"""Quality of service of the ACTS topics.

1 kHz topics are best effort, what a viewer shows is reliable, what describes a skin is kept for late joiners. Users
override them with the standard ``qos_overrides`` parameters where `OVERRIDABLE` is passed to a publisher.
"""

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

OVERRIDABLE = QoSOverridingOptions.with_default_policies()
"""Lets a params file override history, depth and reliability of a topic."""
