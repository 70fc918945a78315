# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Publishers whose failures end nothing, and notice of a second publisher of a topic: a forger, or a second launch."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.logging import get_logger
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile

from acts_ros.log import STEADY
from acts_ros.middleware import NOT_SENT, reason_of
from acts_ros.qos import overridable

# Fast DDS keeps a process that was killed in the graph for 20 s, beside the one that was started in its place.
SAME_NAME_S = 25.0
"""Publishers of one name are reported when they have been there for so long [s]."""

_UNKNOWN = "_NODE_NAME_UNKNOWN_"

# Fast DDS waits 0.1 s for each.
_ATTEMPTS_LATCHED = 3
# Shortest time between two lines in the log about a topic, and between two attempts after the first few.
_PERIOD_S = 1.0


class TolerantPublisher(Publisher):
    """The `publisher_class` of every node: logs that a message was not published, where that of rclpy raises.

    Fast DDS gives a message up when its own threads do not let go of a writer within 0.1 s, as on a machine that has no
    CPU time for them. Raised, this would end the node, or a thread that holds a robot or a hand.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        # Kept: when a line was written last is known to this logger only, not to another one of its name.
        self._log = get_logger("acts_ros")
        self._turn = threading.Lock()
        # The newest message, if the middleware has not taken it and it is to be kept for late joiners.
        self._owed: Any = None

    def publish(self, msg: Any) -> None:
        """Publish; one that is kept for late joiners, and does not come again soon, is tried until it is taken.

        A few times at once, and then once a second from a thread of its own.
        """
        if self.qos_profile.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
            self._is_taken(msg, 1)
            return
        with self._turn:
            is_owing = self._owed is not None
            self._owed = None if self._is_taken(msg, _ATTEMPTS_LATCHED) else msg
            if self._owed is not None and not is_owing:
                threading.Thread(target=self._go_on, name="acts_owed", daemon=True).start()

    def _go_on(self) -> None:
        # Until the publisher, or its context, is destroyed.
        with suppress(rclpy_implementation.InvalidHandle, rclpy_implementation.RCLError):
            while True:
                time.sleep(_PERIOD_S)
                with self._turn:
                    if self._owed is None or self._is_taken(self._owed, 1):
                        self._owed = None
                        return

    def _is_taken(self, msg: Any, attempts: int) -> bool:
        for left in reversed(range(attempts)):
            try:
                super().publish(msg)
            except rclpy_implementation.RCLError as error:
                if not str(error).startswith(NOT_SENT):
                    raise
                if not left:
                    self._log.warning(
                        f"a message on {self.topic_name} was not published: {reason_of(error)}",
                        throttle_duration_sec=_PERIOD_S,
                        throttle_time_source_type=STEADY,
                    )
            else:
                return True
        return False


def published(profile: QoSProfile) -> dict[str, Any]:
    """Keyword arguments for a `TolerantPublisher` whose quality of service a params file may override."""
    return {**overridable(profile), "publisher_class": TolerantPublisher}


class OnlyPublishers:
    """Watches topics that have one publisher each.

    Parameters
    ----------
    node : Node
        Whose view of the graph is used; topics are resolved by its names.
    topics : sequence of str
    clock : callable
        Returns a time that never goes back [s].
    """

    def __init__(self, node: Node, topics: Sequence[str], clock: Callable[[], float] = time.monotonic) -> None:
        self._node = node
        self._topics = tuple(node.resolve_topic_name(topic) for topic in topics)
        self._clock = clock
        self._since_s: dict[str, float] = {}

    def problem(self) -> str:
        """Topics with several publishers, and the names of these nodes; empty where there is none."""
        return "; ".join(filter(None, map(self._problem_of, self._topics)))

    def _problem_of(self, topic: str) -> str:
        # Counting takes microseconds, and the rest is needed only rarely.
        if self._node.count_publishers(topic) < 2:
            self._since_s.pop(topic, None)
            return ""
        names = [
            _full_name(info.node_namespace, info.node_name) for info in self._node.get_publishers_info_by_topic(topic)
        ]
        if len(names) < 2:
            # One of them has gone meanwhile.
            return ""
        since_s = self._since_s.setdefault(topic, self._clock())
        if len(set(names)) == 1 and self._clock() - since_s < SAME_NAME_S:
            return ""
        return f"{topic} has {len(names)} publishers ({', '.join(sorted(names))}): end all but one"


def _full_name(namespace: str, name: str) -> str:
    if name == _UNKNOWN:
        return "a program without a node"
    return f"{namespace.rstrip('/')}/{name}"
