# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Subscribe to topics as they appear, and write their serialised messages to a bag."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from acts_core.errors import PacketError, RecordingError
from acts_core.names import is_hidden
from acts_core.runtime import SequenceNumbers
from acts_ros.bags import qos
from acts_ros.bags.message_types import Definitions, message_class
from acts_ros.bags.skin_topics import SAMPLES
from acts_ros.bags.writing import BagWriter
from acts_ros.clocks import boot_time_s
from acts_ros.executor import destroy_subscription
from acts_ros.messages import sequence_of

try:
    from rclpy.event_handler import SubscriptionEventCallbacks, UnsupportedEventTypeError
except ImportError:  # Humble
    from rclpy.qos_event import SubscriptionEventCallbacks, UnsupportedEventTypeError


# A topic that came regularly has ended or paused when nothing came for so many of its mean intervals, and so long [s].
_ENDED_INTERVALS = 20
_ENDED_S = 1.0
_REGULAR_MESSAGES = 10

# Of the others that have the number of a frame not every frame has a message.
_OF_EVERY_FRAME = (SAMPLES, "acts_msgs/msg/Contact")


@dataclass
class TopicRecord:
    """Counts of one recorded topic.

    Attributes
    ----------
    topic, message_type : str
        Its name and type.
    received : int
        Messages written.
    lost : int or None
        Messages that the middleware reports as lost; None when it does not report.
    first_s, last_s : float
        Times of reception of the first and the last message, CLOCK_BOOTTIME [s]: a machine that sleeps is a pause.
    """

    topic: str
    message_type: str
    received: int = 0
    lost: int | None = 0
    first_s: float = 0.0
    last_s: float = 0.0
    _gaps: list[tuple[float, float]] = field(default_factory=list)
    _numbers: SequenceNumbers = field(default_factory=SequenceNumbers)

    @property
    def missing(self) -> int | None:
        """Frames missing by the numbers of the messages, wherever they were lost; None for messages without numbers."""
        return self._numbers.lost if self.message_type in _OF_EVERY_FRAME else None

    def number(self, data: bytes) -> None:
        """Count what is missing before a serialised message.

        The middleware does not report what falls out of a full queue, as while a slow disk holds up the recorder.
        """
        if self.message_type in _OF_EVERY_FRAME:
            # Whoever reads the bag is told of what is no such message.
            with suppress(PacketError):
                self._numbers.step(sequence_of(data))

    def add(self, now_s: float) -> None:
        """Count a message that is received now."""
        if not self.received:
            self.first_s = now_s
        elif now_s - self.last_s > _ENDED_S:
            # All that may turn out to be a pause: at most one a second.
            self._gaps.append((self.last_s, now_s - self.last_s))
        self.last_s = now_s
        self.received += 1

    def pauses(self) -> list[tuple[float, float]]:
        """When nothing came in the midst of a topic that came regularly: begin and length [s], the longest first."""
        if self.received < _REGULAR_MESSAGES or not self._gaps:
            return []
        pauses = sorted(self._gaps, key=lambda gap: -gap[1])
        # Of the rest: a long pause would make up for the interval that it is measured by.
        interval_s = (self.last_s - self.first_s - pauses[0][1]) / (self.received - 2)
        return [pause for pause in pauses if pause[1] > max(_ENDED_S, _ENDED_INTERVALS * interval_s)]

    def silent_s(self, now_s: float) -> float | None:
        """For how long nothing has come of a topic that came regularly [s]; None where it still comes, or never did."""
        if self.received < _REGULAR_MESSAGES:
            return None
        interval_s = (self.last_s - self.first_s) / (self.received - 1)
        silence_s = now_s - self.last_s
        return silence_s if silence_s > max(_ENDED_S, _ENDED_INTERVALS * interval_s) else None


class Recorder:
    """Records topics of a graph.

    Parameters
    ----------
    node : Node
        Node of the subscriptions; the caller spins it.
    bag : BagWriter
        Bag for the messages.
    topics : sequence of str or None
        Full names of the topics; None for all that are not hidden.
    say : callable
        Called with a line for the user.

    Attributes
    ----------
    records : dict of str to TopicRecord
        Of every topic that is recorded, by its name.
    """

    def __init__(self, node: Node, bag: BagWriter, topics: Sequence[str] | None, say: Callable[[str], None]) -> None:
        self.records: dict[str, TopicRecord] = {}
        self._node = node
        self._bag = bag
        self._topics = topics
        self._say = say
        self._definitions = Definitions()
        self._handles: dict[str, Any] = {}
        self._subscriptions: dict[str, Subscription] = {}
        self._refused: set[str] = set()

    def discover(self) -> None:
        """Find new topics and subscribe to them; to be called regularly."""
        for topic, types in self._node.get_topic_names_and_types():
            if topic in self._refused or not self._wanted(topic):
                continue
            offers = self._node.get_publishers_info_by_topic(topic)
            if not offers:
                continue  # without a publisher, its type and quality of service are unknown
            if topic in self.records:
                self._relax(topic, offers)
                continue
            try:
                self._add(topic, types, offers)
            except RecordingError as error:
                self._refused.add(topic)
                self._say(f"not recorded: {topic}: {error}")

    def close(self) -> None:
        """Destroy the subscriptions; nothing is written after that."""
        for subscription in self._subscriptions.values():
            destroy_subscription(self._node, subscription)
        self._subscriptions.clear()

    def missing(self) -> list[str]:
        """Requested topics that have not appeared."""
        return [topic for topic in self._topics or () if topic not in self.records and topic not in self._refused]

    def silent(self) -> list[str]:
        """Topics that have appeared, but without a message."""
        return sorted(topic for topic, record in self.records.items() if not record.received)

    @property
    def is_complete(self) -> bool:
        """Whether there are messages of every requested topic; with all topics, whether there are any."""
        if self._topics is None:
            return any(record.received for record in self.records.values())
        return not (self.missing() or self.refused() or self.silent())

    def refused(self) -> list[str]:
        """Topics that have appeared and cannot be recorded."""
        return sorted(self._refused)

    def _wanted(self, topic: str) -> bool:
        if self._topics is not None:
            return topic in self._topics
        return not is_hidden(topic)

    def _add(self, topic: str, types: list[str], offers: list[TopicEndpointInfo]) -> None:
        if len(types) != 1:
            raise RecordingError(f"it is published with several types: {', '.join(types)}")
        kind = message_class(types[0])
        definition, type_hash = self._definitions.describe(types[0])
        offered = qos.to_bag([offer.qos_profile for offer in offers])
        self._handles[topic] = self._bag.add_topic(topic, types[0], definition, type_hash, offered)
        self.records[topic] = TopicRecord(topic, types[0])
        self._subscribe(topic, kind, qos.for_subscription(offers))
        self._say(f"recording {topic} ({types[0]})")

    def _relax(self, topic: str, offers: list[TopicEndpointInfo]) -> None:
        """Subscribe again if a new publisher is not compatible with the present subscription."""
        if qos.is_too_strict(self._subscriptions[topic].qos_profile, offers):
            destroy_subscription(self._node, self._subscriptions[topic])
            kind = message_class(self.records[topic].message_type)
            self._subscribe(topic, kind, qos.for_subscription(offers))

    def _subscribe(self, topic: str, kind: type, profile: QoSProfile) -> None:
        record = self.records[topic]
        callback = partial(self._on_message, record, self._handles[topic])
        events = SubscriptionEventCallbacks(message_lost=partial(_on_lost, record))
        create = partial(self._node.create_subscription, kind, topic, callback, profile, raw=True)
        try:
            self._subscriptions[topic] = create(event_callbacks=events)
        except UnsupportedEventTypeError:
            record.lost = None
            self._subscriptions[topic] = create()

    def _on_message(self, record: TopicRecord, handle: Any, data: bytes) -> None:
        self._bag.write(handle, data)
        record.number(data)
        record.add(boot_time_s())


def _on_lost(record: TopicRecord, status: Any) -> None:
    record.lost = (record.lost or 0) + int(status.total_count_change)
