# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The topics that running nodes publish."""

from __future__ import annotations

from rclpy.node import Node

from acts_core.names import is_hidden


def published(node: Node) -> dict[str, str]:
    """Types by topic, in the order of their names, of what others than this node publish.

    Parameters
    ----------
    node : Node
        Known to the others for long enough, so that they are known to it.
    """
    own = (node.get_name(), node.get_namespace())
    found = {}
    for topic, types in sorted(node.get_topic_names_and_types()):
        offers = node.get_publishers_info_by_topic(topic)
        if not is_hidden(topic) and any((offer.node_name, offer.node_namespace) != own for offer in offers):
            found[topic] = ", ".join(types)
    return found
