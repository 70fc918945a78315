# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of tf2 frames, and that of a skin, which is the same in all messages."""

from __future__ import annotations

import re

from rclpy.node import Node

from acts_core.errors import SettingsError
from acts_core.settings import is_given

_LEGAL = re.compile(r"[^\s\0/][^\s\0]*")


def check_frame_id(frame_id: str, further: str = "") -> None:
    """Refuse what tf2 does not take as the name of a frame.

    Parameters
    ----------
    frame_id : str
        The parameter.
    further : str
        What else is allowed, for the message.

    Raises
    ------
    SettingsError
        When it is empty, begins with / or has a blank.
    """
    if not _LEGAL.fullmatch(frame_id):
        raise SettingsError(
            f"frame_id={frame_id!r}: the name of a tf2 frame is not empty, has no blanks and does not begin with /"
            + (further and f"; {further}")
        )


def skin_frame(node: Node, frame_id: str) -> str:
    """Name of the tf2 frame of a node's skin.

    Parameters
    ----------
    node : rclpy.node.Node
        In the skin's namespace.
    frame_id : str
        The parameter; where it is empty or ``none``, the frame has the name of the namespace, with _ for /.

    Raises
    ------
    SettingsError
        When tf2 does not take the name.
    """
    if not is_given(frame_id):
        return node.get_namespace().strip("/").replace("/", "_") or "skin"
    check_frame_id(frame_id, "empty or none names it as the namespace")
    return frame_id
