# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What fills a recording from the graph: the topics of the shown skins, both as they appear."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rclpy.node import Node

from acts_ros.bags.recorder import Recorder
from acts_view.recording.bounded_bag import BoundedBag

TOPICS = ("samples", "baseline", "contact", "joint_states")
"""What of a skin is recorded, where it is published: all else can be made of it again."""


class GraphFeed:
    """See `acts_view.recording.recording.Feed`.

    Parameters
    ----------
    node : Node
        Spun by somebody else; it gets the subscriptions.
    skins : callable
        Gives the namespaces of those that there are, each with a slash before.
    bag : BoundedBag
    """

    def __init__(self, node: Node, skins: Callable[[], Sequence[str]], bag: BoundedBag) -> None:
        self._skins = skins
        # The recorder sees what is added.
        self._topics: list[str] = []
        self._recorder = Recorder(node, bag, self._topics, node.get_logger().info)
        self.step()

    @property
    def lost(self) -> int:
        """See `Feed`."""
        # What falls out of a full queue, as while a disk is slow, the middleware does not report.
        return sum(max(record.lost or 0, record.missing or 0) for record in self._recorder.records.values())

    def step(self) -> None:
        """Look for new skins and topics."""
        topics = (f"{skin}/{topic}" for skin in self._skins() for topic in TOPICS)
        self._topics += [topic for topic in topics if topic not in self._topics]
        self._recorder.discover()

    def close(self) -> None:
        """Subscribe no longer."""
        self._recorder.close()
