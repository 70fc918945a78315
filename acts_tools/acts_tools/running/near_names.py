# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What somebody may have meant by a name that nothing in the graph has."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rclpy.node import Node

NOTICE_S = 3.0
"""After this time without a publisher a command says so [s]; one that runs is found sooner."""

_NEAR = 0.7
_MOST = 3


def did_you_mean(name: str, names: Iterable[str]) -> str:
    """Words for the end of a message, such as ``; did you mean /plate/contact?``; empty where no name is near.

    Parameters
    ----------
    name : str
        What was given, such as ``/contact`` or ``/plate/contct``.
    names : iterable of str
        Those that exist. If some are `name` in a namespace, these are meant, the first three of them.
    """
    known = sorted(set(names) - {name})
    in_namespaces = [one for one in known if name.startswith("/") and one.endswith(name)]
    near = in_namespaces[:_MOST] or difflib.get_close_matches(name, known, n=1, cutoff=_NEAR)
    return f"; did you mean {' or '.join(near)}?" if near else ""


def near_topic(node: Node, topic: str) -> str:
    """`did_you_mean` of the topics that somebody publishes."""
    topics = (one for one, _ in node.get_topic_names_and_types())
    return did_you_mean(topic, (one for one in topics if node.count_publishers(one)))
