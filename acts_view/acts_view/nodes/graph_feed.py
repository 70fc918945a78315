# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What fills a recording from the graph: the topics of the shown skins, as they appear."""

from __future__ import annotations

from collections.abc import Sequence

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
    skins : sequence of str
        Their namespaces, each with a slash before.
    bag : BoundedBag
    """

    def __init__(self, node: Node, skins: Sequence[str], bag: BoundedBag) -> None:
        topics = [f"{skin}/{topic}" for skin in skins for topic in TOPICS]
        self._recorder = Recorder(node, bag, topics, node.get_logger().info)
        self.step()

    @property
    def lost(self) -> int:
        """See `Feed`."""
        return sum(record.lost or 0 for record in self._recorder.records.values())

    def step(self) -> None:
        """Look for new topics."""
        self._recorder.discover()

    def close(self) -> None:
        """Subscribe no longer."""
        self._recorder.close()
