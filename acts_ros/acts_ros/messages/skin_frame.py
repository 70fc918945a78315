# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The tf2 frame of a skin, which has the same name in all messages."""

from __future__ import annotations

import re

from rclpy.node import Node

from acts_core.errors import SettingsError

_LEGAL = re.compile(r"[^\s/][^\s]*")


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
    if frame_id in ("", "none"):
        return node.get_namespace().strip("/").replace("/", "_") or "skin"
    if not _LEGAL.fullmatch(frame_id):
        raise SettingsError(
            f"frame_id={frame_id!r}: a frame of tf2 has no blanks and does not begin with /; "
            "empty or none names it as the namespace"
        )
    return frame_id
