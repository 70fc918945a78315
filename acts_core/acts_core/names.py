# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of nodes, topics, namespaces and frames in ROS, and of skins and patches, as people write them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise

from acts_core.errors import SettingsError

ALLOWED = "letters, digits (not first) and _"
"""What a part of a name consists of, for messages."""

RULE = "consists of letters, digits and _, and does not begin with a digit"
"""The same, as the end of a sentence about a name."""

_LENGTH_MAX = 64
_TOPIC_LENGTH_MAX = 247
"""Of a topic or a service, in ROS."""

_BELOW_LENGTH_MAX = 64
"""Of what a node or a namespace puts behind its own name, such as ``/driver/query_board``."""

_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_FULL_NAME = re.compile(r"(/[A-Za-z_]\w*)+", re.ASCII)
_REMAP = re.compile(r"(?:[^:]*:)?(__ns|__node|__name):=(.*)", re.DOTALL)


def is_name(text: str) -> bool:
    """Whether a node may have this name."""
    return _NAME.fullmatch(text) is not None


def is_short_name(name: object) -> bool:
    """Whether a skin or a patch may have this name: that of a node, of up to 64 characters."""
    return isinstance(name, str) and len(name) <= _LENGTH_MAX and is_name(name)


def is_frame_name(name: object) -> bool:
    """Whether a frame may have this name: parts as in `is_name`, with a slash between them."""
    return isinstance(name, str) and is_full_name(f"/{name}")


def is_full_name(text: str) -> bool:
    """Whether a topic or namespace may have this name, which begins with a slash; not ``/`` alone."""
    return _FULL_NAME.fullmatch(text) is not None


def is_hidden(topic: str) -> bool:
    """Whether a topic is one that ROS itself uses, and people do not look at: a part of its name begins with _."""
    return any(part.startswith("_") for part in topic.split("/"))


def full_name(given: str, what: str = "topic", *, has_names_below: bool = False) -> str:
    """The name with one slash before it and none behind.

    Parameters
    ----------
    given : str
        As somebody writes it, such as ``/plate/contact`` or ``plate``.
    what : str
        What it names, for the message.
    has_names_below : bool
        Whether names of topics or services begin with it, as with a namespace or a node: it is shorter then.

    Raises
    ------
    SettingsError
        ROS has no such names, or none as long.
    """
    name = f"/{given.strip('/')}"
    if not is_full_name(name):
        raise SettingsError(f"{given!r} is no {what}: allowed are {ALLOWED}, parts with / between")
    longest = _TOPIC_LENGTH_MAX - (_BELOW_LENGTH_MAX if has_names_below else 0)
    if len(name) > longest:
        raise SettingsError(
            f"'{name[:_LENGTH_MAX]}...' is no {what}: it has {len(name)} characters, at most {longest} are allowed"
        )
    return name


def own_words(words: Sequence[str]) -> list[str]:
    """The words of a command line before ``--ros-args``: ``ros2 launch`` adds that and more to every program."""
    own = list(words)
    return own[: own.index("--ros-args")] if "--ros-args" in own else own


def check_remaps(words: Sequence[str]) -> None:
    """Refuse a namespace or name of a node on a command line (``-r __ns:=/9a``) that ROS would refuse by a riddle.

    Raises
    ------
    SettingsError
        It is not allowed.
    """
    given = list(words)
    given = given[given.index("--ros-args") :] if "--ros-args" in given else []
    for option, word in pairwise(given):
        rule = _REMAP.fullmatch(word) if option in ("-r", "--remap") else None
        if rule is None:
            continue
        kind, name = rule.groups()
        if kind == "__ns" and name != "/" and not is_full_name(name):
            raise SettingsError(
                f"{word}: {name!r} is no namespace: allowed are {ALLOWED}, each part with a / before it"
            )
        if kind != "__ns" and not is_name(name):
            raise SettingsError(f"{word}: {name!r} is no name of a node: allowed are {ALLOWED}")
