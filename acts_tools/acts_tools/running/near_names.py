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
    near = in_namespaces[:_MOST]
    if not near and known:
        nearest = max(known, key=lambda one: _likeness(name, one))
        near = [nearest] if _likeness(name, nearest) >= _NEAR else []
    return f"; did you mean {' or '.join(near)}?" if near else ""


def _likeness(name: str, other: str) -> float:
    """From 0 to 1; of two names in one namespace, which says nothing of what was meant, that of their last parts."""
    namespace, _, last = name.rpartition("/")
    others_namespace, _, others_last = other.rpartition("/")
    words = (last, others_last) if namespace == others_namespace else (name, other)
    return difflib.SequenceMatcher(None, *words).ratio()


def near_topic(node: Node, topic: str) -> str:
    """`did_you_mean` of the topics that somebody publishes."""
    topics = (one for one, _ in node.get_topic_names_and_types())
    return did_you_mean(topic, (one for one in topics if node.count_publishers(one)))
