# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Conversion of quality of service between the graph, bags, and our publishers and subscriptions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

_Policy = TypeVar("_Policy", ReliabilityPolicy, DurabilityPolicy)

_SUBSCRIPTION_DEPTH = 4096
_PUBLISHER_DEPTH = 256
_KEPT_MAX = 1000


def for_subscription(offers: Sequence[TopicEndpointInfo]) -> QoSProfile:
    """The strictest profile that is compatible with every publisher of a topic.

    Parameters
    ----------
    offers : sequence of TopicEndpointInfo
        The publishers; at least one.

    Returns
    -------
    QoSProfile
        Reliable or transient local only where every publisher offers it; the depth is four seconds at 1 kHz.
    """
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=_SUBSCRIPTION_DEPTH,
        reliability=_if_all(
            [offer.qos_profile.reliability for offer in offers],
            ReliabilityPolicy.RELIABLE,
            ReliabilityPolicy.BEST_EFFORT,
        ),
        durability=_if_all(
            [offer.qos_profile.durability for offer in offers],
            DurabilityPolicy.TRANSIENT_LOCAL,
            DurabilityPolicy.VOLATILE,
        ),
    )


def is_too_strict(present: QoSProfile, offers: Sequence[TopicEndpointInfo]) -> bool:
    """Whether a subscription gets nothing from one of the publishers, such as one that has joined since it was made.

    Parameters
    ----------
    present : QoSProfile
        Of the subscription, as `for_subscription` made it.
    offers : sequence of TopicEndpointInfo
        The publishers; at least one.
    """
    needed = for_subscription(offers)
    return (present.reliability == ReliabilityPolicy.RELIABLE and needed.reliability != ReliabilityPolicy.RELIABLE) or (
        present.durability == DurabilityPolicy.TRANSIENT_LOCAL and needed.durability != DurabilityPolicy.TRANSIENT_LOCAL
    )


def to_bag(profiles: Sequence[QoSProfile]) -> list[Qos]:
    """The profiles of a topic's publishers as a bag stores them."""
    return [
        Qos(
            history=QosHistory(int(profile.history)),
            depth=int(profile.depth),
            reliability=QosReliability(int(profile.reliability)),
            durability=QosDurability(int(profile.durability)),
            deadline=_time(profile.deadline),
            lifespan=_time(profile.lifespan),
            liveliness=QosLiveliness(int(profile.liveliness)),
            liveliness_lease_duration=_time(profile.liveliness_lease_duration),
            avoid_ros_namespace_conventions=bool(profile.avoid_ros_namespace_conventions),
        )
        for profile in profiles
    ]


def for_publisher(recorded: Sequence[Qos], message_count: int = 0) -> QoSProfile:
    """The profile to publish a recorded topic with.

    Parameters
    ----------
    recorded : sequence of Qos
        Profiles of the topic's publishers when it was recorded; may be empty.
    message_count : int
        Messages of the topic in the bag.

    Returns
    -------
    QoSProfile
        Reliable or transient local where at least one publisher was. The depth is at least the recorded one, and 256,
        for bursts. If transient local, it is at least as large as the number of messages, up to 1000, instead: each of
        several publishers had kept its own.
    """
    reliable = not recorded or any(profile.reliability is QosReliability.RELIABLE for profile in recorded)
    kept = any(profile.durability is QosDurability.TRANSIENT_LOCAL for profile in recorded)
    recorded_depth = max((profile.depth for profile in recorded), default=0)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=max(1, recorded_depth, min(message_count, _KEPT_MAX)) if kept else max(_PUBLISHER_DEPTH, recorded_depth),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE,
    )


def _if_all(offered: Sequence[_Policy], strict: _Policy, lenient: _Policy) -> _Policy:
    return strict if all(policy == strict for policy in offered) else lenient


def _time(duration: Duration) -> QosTime:
    seconds, nanoseconds = divmod(int(duration.nanoseconds), 10**9)
    return QosTime(seconds, nanoseconds)
