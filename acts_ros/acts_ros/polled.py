# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Subscriptions and services that are polled, instead of a callback for every message.

A callback per message wakes the process each time, and after a delay it reaches the newest message only after all
older ones. With a polled subscription the middleware queues the last messages, and the reader takes all of them at
once when its own cycle begins.

The callback of a service returns the answer, so the executor serves nothing else until it is known. A polled service is
answered whenever that is.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from copy import copy
from typing import Any, Generic, TypeVar

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.subscription import Subscription

from acts_ros.executor import destroy_subscription
from acts_ros.middleware import NOT_SENT, reason_of
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
        """Messages that have arrived since the last call, oldest first; from any thread, one at a time.

        Returns
        -------
        list of (message, int)
            Each with the time at which the middleware received it, or the present where that is unknown, by the
            system's clock [ns].
        """
        # Not every middleware records the time of reception.
        return [(message, info["received_timestamp"] or time.time_ns()) for message, info in self._take()]

    def take_newest(self) -> tuple[M, float] | None:
        """The newest message that has arrived since the last call, if any; from any thread, one at a time.

        Returns
        -------
        (message, float) or None
            How long it has waited since the middleware received it [s]; NaN where that is unknown.
        """
        found = list(self._take())
        if not found:
            return None
        message, info = found[-1]
        received_ns = info["received_timestamp"]
        return message, (time.time_ns() - received_ns) * 1e-9 if received_ns else math.nan

    def take_all_sent(self) -> list[tuple[M, int]]:
        """As `take_all`, each with the time at which it was sent by the system's clock [ns]; 0 where it is unknown."""
        return [(message, info["source_timestamp"]) for message, info in self._take()]

    def _take(self) -> Iterator[tuple[M, dict[str, int]]]:
        subscription = self._subscription
        # The handle is kept alive while it is used: another thread may destroy the node.
        handle = subscription.handle
        with handle:
            for _ in range(subscription.qos_profile.depth):
                found = handle.take_message(subscription.msg_type, subscription.raw)
                if found is None:
                    break
                yield found


class PolledService:
    """See `PollingNode.create_polled_service`."""

    def __init__(self, service: Service) -> None:
        self._service = service

    def take(self) -> tuple[Any, Any] | None:
        """The oldest request that nobody has taken yet, and its header; None where there is none."""
        handle = self._service.handle
        with handle:
            request, header = handle.service_take_request(self._service.srv_type.Request)
        return None if header is None else (request, header)

    def answer(self, response: Any, header: Any) -> None:
        """Send the answer to the request that came with this header; logs where the middleware does not take it."""
        try:
            self._service.send_response(response, header)
        except rclpy_implementation.RCLError as error:
            # Raised, it would keep others who wait from their answers.
            if not str(error).startswith(NOT_SENT):
                raise
            get_logger("acts_ros").warning(f"{self._service.srv_name}: {reason_of(error)}")


class PollingNode(Node):
    """A node with subscriptions and services that are hidden from executors."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        self._polled: set[Subscription] = set()
        self._polled_services: set[Service] = set()
        super().__init__(*arguments, **options)

    @property
    def subscriptions(self) -> Iterator[Subscription]:
        """Subscriptions that executors serve: all but the polled ones."""
        return (subscription for subscription in super().subscriptions if subscription not in self._polled)

    @property
    def services(self) -> Iterator[Service]:
        """Services that executors serve: all but the polled ones."""
        return (service for service in super().services if service not in self._polled_services)

    def create_polled_service(self, kind: type, name: str) -> PolledService:
        """Offer a service of which requests are taken and answered by the caller; to be called as the next one.

        Parameters
        ----------
        kind : type
            Service type.
        name : str
            Name.
        """
        service = self.create_service(kind, name, _never)
        self._polled_services.add(service)
        return PolledService(service)

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
            Length of the queue between two calls; None: as the profile says. If it is full, the oldest message is lost.
        """
        return PolledSubscription(self._subscribe(kind, topic, profile, depth, raw=False))

    def create_raw_polled_subscription(
        self, kind: type, topic: str, profile: QoSProfile, *, depth: int | None = None
    ) -> PolledSubscription[bytes]:
        """Like `create_polled_subscription`, but messages stay serialised bytes, for readers that skip some of them."""
        return PolledSubscription(self._subscribe(kind, topic, profile, depth, raw=True))

    def destroy_polled_subscription(self, polled: PolledSubscription[Any]) -> None:
        """Destroy a subscription that no thread is reading."""
        destroy_subscription(self, polled._subscription)
        self._polled.discard(polled._subscription)

    def _subscribe(self, kind: type, topic: str, profile: QoSProfile, depth: int | None, *, raw: bool) -> Subscription:
        profile = copy(profile)
        if depth is not None:
            profile.depth = depth
        subscription = self.create_subscription(kind, topic, _never, raw=raw, **overridable(profile))
        self._polled.add(subscription)
        return subscription


def _never(*_arguments: Any) -> None:
    raise AssertionError("what is polled is not called back")
