# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Notice that a topic which one node is meant to publish has a second publisher: a forger, or a second launch."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from rclpy.node import Node

# Fast DDS keeps a process that was killed in the graph for 20 s, beside the one that was started in its place.
SAME_NAME_S = 25.0
"""Publishers of one name are reported when they have been there for so long [s]."""

_UNKNOWN = "_NODE_NAME_UNKNOWN_"


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
        since_s = self._since_s.setdefault(topic, self._clock())
        if len(set(names)) == 1 and self._clock() - since_s < SAME_NAME_S:
            return ""
        return f"{topic} has {len(names)} publishers ({', '.join(sorted(names))}): end all but one"


def _full_name(namespace: str, name: str) -> str:
    if name == _UNKNOWN:
        return "a program without a node"
    return f"{namespace.rstrip('/')}/{name}"
