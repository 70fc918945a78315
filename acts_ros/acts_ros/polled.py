"""Subscriptions that are read when their reader is due, instead of calling back for every message.

A callback a message costs a wake-up, and a reader that is held up gets to the newest message only behind all older
ones. A polled subscription wakes nobody: the middleware keeps the last messages, and the reader takes all of them at
once when its own cycle begins.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from copy import copy
from typing import Any, Generic, TypeVar

from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription

from acts_ros.qos import overridable

M = TypeVar("M")


class PolledSubscription(Generic[M]):
    """See `PollingNode.create_polled_subscription`."""

    def __init__(self, subscription: Subscription) -> None:
        self._subscription = subscription

    @property
    def topic_name(self) -> str:
        """Full name of the topic."""
        return str(self._subscription.topic_name)

    def take_all(self) -> list[tuple[M, int]]:
        """What has arrived since the last call, oldest first; from any thread, one at a time.

        Returns
        -------
        list of (message, int)
            With the time at which the middleware received the message, or else the present, by the system's clock
            [ns].
        """
        taken: list[tuple[M, int]] = []
        subscription = self._subscription
        # The handle is kept alive while it is used: another thread may destroy the node.
        handle = subscription.handle
        with handle:
            while len(taken) < subscription.qos_profile.depth:
                found = handle.take_message(subscription.msg_type, subscription.raw)
                if found is None:
                    break
                message, info = found
                # Not every middleware notes it.
                taken.append((message, info["received_timestamp"] or time.time_ns()))
        return taken


class PollingNode(Node):
    """A node with subscriptions that no executor knows of."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        self._polled: set[Subscription] = set()
        super().__init__(*arguments, **options)

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """What executors look at: all but the polled ones."""
        return (subscription for subscription in super().subscriptions if subscription not in self._polled)

    def create_polled_subscription(
        self, kind: type[M], topic: str, profile: QoSProfile, *, depth: int | None = None
    ) -> PolledSubscription[M]:
        """Subscribe; to be called before the node is given to an executor, or on the executor's thread.

        Parameters
        ----------
        kind : type
            Message type.
        topic : str
            Name.
        profile : QoSProfile
            Quality of service, which a params file may override.
        depth : int or None
            How many messages are kept between two readings; None: as the profile says. Of more the oldest are lost.
        """
        return PolledSubscription(self._subscribe(kind, topic, profile, depth, raw=False))

    def create_raw_polled_subscription(
        self, kind: type, topic: str, profile: QoSProfile, *, depth: int | None = None
    ) -> PolledSubscription[bytes]:
        """As `create_polled_subscription`; messages are the bytes that were sent, for who needs only some of them."""
        return PolledSubscription(self._subscribe(kind, topic, profile, depth, raw=True))

    def destroy_polled_subscription(self, polled: PolledSubscription[Any]) -> None:
        """Subscribe no longer; nobody may be reading it meanwhile."""
        self.destroy_subscription(polled._subscription)
        self._polled.discard(polled._subscription)

    def _subscribe(self, kind: type, topic: str, profile: QoSProfile, depth: int | None, *, raw: bool) -> Subscription:
        profile = copy(profile)
        if depth is not None:
            profile.depth = depth
        subscription = self.create_subscription(kind, topic, _never, raw=raw, **overridable(profile))
        self._polled.add(subscription)
        return subscription


def _never(_message: Any) -> None:
    raise AssertionError("a polled subscription is not called back")
