# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A node without ROS, of which a test decides who publishes and what comes; and contacts that come."""

from __future__ import annotations

from typing import Any

import numpy as np

from acts_ros.messages import ContactFields, SeriesFields, write_series

S_NS = 10**9


class MadeSubscription:
    def __init__(self, topic: str, *, is_raw: bool, depth: int | None) -> None:
        self.topic_name = topic
        self.is_raw = is_raw
        self._depth = depth
        self._waiting: list[tuple[Any, int]] = []

    def come(self, message: Any, received_ns: int) -> None:
        self._waiting.append((message, received_ns))
        if self._depth is not None:
            del self._waiting[: -self._depth]

    def take_all(self) -> list[tuple[Any, int]]:
        taken, self._waiting = self._waiting, []
        return taken

    def take_newest(self) -> tuple[Any, float] | None:
        taken = self.take_all()
        return (taken[-1][0], 0.5) if taken else None


class MadeNode:
    """In the place of a `PollingNode`."""

    def __init__(self, *published: str) -> None:
        self.published = set(published)
        """Topics that somebody publishes."""
        self.subscriptions: dict[str, MadeSubscription] = {}
        self.told: list[str] = []

    def come(self, topic: str, message: Any, received_ns: int = 0) -> None:
        """A message, or its bytes, of a topic; it reaches who has subscribed."""
        assert topic in self.published, topic
        if (subscription := self.subscriptions.get(topic)) is not None:
            assert subscription.is_raw == isinstance(message, bytes), topic
            subscription.come(message, received_ns)

    def create_polled_subscription(
        self, _kind: type, topic: str, _profile: Any, *, depth: int | None = None
    ) -> MadeSubscription:
        return self._create(topic, is_raw=False, depth=depth)

    def create_raw_polled_subscription(
        self, _kind: type, topic: str, _profile: Any, *, depth: int | None = None
    ) -> MadeSubscription:
        return self._create(topic, is_raw=True, depth=depth)

    def destroy_polled_subscription(self, subscription: MadeSubscription) -> None:
        assert self.subscriptions.pop(subscription.topic_name) is subscription

    def count_publishers(self, topic: str) -> int:
        return int(topic in self.published)

    def get_logger(self) -> MadeNode:
        return self

    def warning(self, text: str, **_options: Any) -> None:
        self.told.append(text)

    def _create(self, topic: str, *, is_raw: bool, depth: int | None) -> MadeSubscription:
        assert topic not in self.subscriptions, topic
        self.subscriptions[topic] = MadeSubscription(topic, is_raw=is_raw, depth=depth)
        return self.subscriptions[topic]


def contact(stamp_s: float, force_n: float = 1.0, sequence: int = 7, **changes: Any) -> ContactFields:
    """A contact with this stamp [s]."""
    fields = ContactFields(
        round(stamp_s * S_NS), "plate", sequence, True, 0.01, 0.02, force_n, 700.0, 1e-4, 9, 0.001, 0, 0, 0, 0, 0
    )
    return fields._replace(**changes)


def series(stamp_s: float, *ages_s: float, **changes: Any) -> bytes:
    """Bytes of a series of contacts that ends with this stamp [s]."""
    count = len(ages_s)
    fields = SeriesFields(
        newest=contact(stamp_s),
        age_s=np.array(ages_s, np.float32),
        force_n=np.arange(1, count + 1, dtype=np.float32),
        delay_s=np.full(count, 0.002, np.float32),
        missing=np.full(count, 3, np.uint32),
    )
    return write_series(fields._replace(**changes))
