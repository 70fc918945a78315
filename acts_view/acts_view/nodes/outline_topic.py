# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The topic ``outlines`` of one skin, polled: the newest outline of each contact."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from acts_msgs.msg import Outline
from acts_ros import qos
from acts_ros.polled import PollingNode
from acts_view.nodes.robot_states import SHOWN

_DEPTH = 64
_CORNERS_MAX = 512
# A contact that has ended sends nothing more.
_ENDED_S = 0.2


class OutlineTopic:
    """Subscribes to outlines; one call at a time, from the executor's thread, `take` from any.

    Parameters
    ----------
    node : PollingNode
    namespace : str
        Of the skin, with a slash before.
    """

    def __init__(self, node: PollingNode, namespace: str) -> None:
        self._node = node
        self._subscription = node.create_polled_subscription(Outline, f"{namespace}/outlines", qos.STREAM, depth=_DEPTH)
        self._newest: dict[int, tuple[float, NDArray[np.float32]]] = {}

    def take(self) -> list[NDArray[np.float32]]:
        """Corners of what touches now, each [shape=(n, 2)], x and y [m]."""
        now_s = time.monotonic()
        for message, _ in self._subscription.take_all():
            corners = _corners(message)
            if corners is not None:
                self._newest[message.number] = now_s, corners
        self._newest = {number: one for number, one in self._newest.items() if now_s - one[0] < _ENDED_S}
        return [corners for _, corners in list(self._newest.values())[:SHOWN]]

    def close(self) -> None:
        """Subscribe no longer."""
        self._node.destroy_polled_subscription(self._subscription)


def _corners(message: Outline) -> NDArray[np.float32] | None:
    """None for what is no polygon: anybody in the domain can send any."""
    if not 3 <= len(message.x) == len(message.y) <= _CORNERS_MAX:
        return None
    corners = np.column_stack((message.x, message.y)).astype(np.float32)
    return corners if np.isfinite(corners).all() else None
