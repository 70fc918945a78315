# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``outlines`` of the reconstruction node: the outline of each contact."""

from __future__ import annotations

import time
from array import array
from concurrent.futures import Future

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.runtime import RateLimit, background
from acts_msgs.msg import Outline as OutlineMessage
from acts_recon.methods import Recovery
from acts_recon.outlines import Outline, OutlineTracer, load
from acts_ros import qos


class OutlinesPublisher:
    """Finds the outlines in every image, and publishes acts_msgs/Outline, while somebody listens.

    Parameters
    ----------
    node : Node
    tracer : OutlineTracer
    rate_hz : float
        Largest rate while no contact is young [Hz]; 0: every frame.
    """

    def __init__(self, node: Node, tracer: OutlineTracer, rate_hz: float) -> None:
        self._tracer = tracer
        self._publisher = node.create_publisher(OutlineMessage, "outlines", **qos.overridable(qos.STREAM))
        self._limit = RateLimit(rate_hz)
        self.is_wanted = False
        self._loaded: Future[None] | None = None

    def set_rate(self, rate_hz: float) -> None:
        """Change the largest rate while no contact is young [Hz]; 0: every frame."""
        self._limit.set_rate(rate_hz)

    def reset(self) -> None:
        """Forget all contacts: the next frame is not of the same board, or long after."""
        self._tracer.reset()

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        send = self._publisher.get_subscription_count() > 0
        if send and self._loaded is None:
            # Importing takes longer than a frame.
            self._loaded = background.begin(load)
        send = send and self._loaded is not None and self._loaded.done()
        if send and not self.is_wanted:
            self._tracer.reset()
        self.is_wanted = send

    def publish(
        self,
        header: Header,
        sequence: int,
        indices: NDArray[np.uint16],
        counts: NDArray[np.uint16],
        end_s: float,
        duration_s: float,
        recovery: Recovery,
    ) -> None:
        """Find the outlines in a frame, and publish them.

        Parameters
        ----------
        header : Header
            Of the frame.
        sequence : int
            The frame's number.
        indices, counts, end_s, duration_s
            Of the frame, as of `Method.step`, which has accepted them.
        recovery : Recovery
            Holds the image.
        """
        if not self.is_wanted:
            return
        if not self._limit.due(time.monotonic()) and self._tracer.skip(end_s, recovery.image):
            return
        for outline in self._tracer.step(indices, counts, end_s, duration_s, recovery.image):
            self._publisher.publish(_message(header, sequence, end_s, outline))


def _message(header: Header, sequence: int, end_s: float, outline: Outline) -> OutlineMessage:
    message = OutlineMessage(header=header, sequence=sequence, number=outline.number)
    message.before_stamp = end_s - outline.time_s
    message.centre.x, message.centre.y = outline.centre_m
    message.area, message.growth = outline.area_m2, outline.growth_m2_s
    message.perimeter, message.orientation = outline.perimeter_m, outline.orientation_rad
    message.x, message.y = (array("f", values.astype(np.float32).tobytes()) for values in (outline.x_m, outline.y_m))
    return message
