# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``outlines`` of the reconstruction node: the outline of each contact."""

from __future__ import annotations

import time
from array import array
from concurrent.futures import Future

import numpy as np
from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.runtime import background
from acts_msgs.msg import Outline as OutlineMessage
from acts_recon.methods import Recovery
from acts_recon.nodes.frame_publisher import RecoveredFrame, TopicPublisher
from acts_recon.outlines import Outline, load
from acts_recon.settings import ReconstructionConfig


class OutlinesPublisher(TopicPublisher):
    """Finds the outlines in every image, and publishes acts_msgs/Outline.

    The rate is limited while no contact is young.

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recovery : Recovery
        Holds the image.
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recovery: Recovery) -> None:
        super().__init__(node, OutlineMessage, "outlines", settings)
        self._recovery = recovery
        self._tracer = settings.outline_tracer(recovery)
        self._loaded: Future[None] | None = None

    def reset(self) -> None:
        """See `FramePublisher.reset`."""
        self._tracer.reset()

    def look_for_subscribers(self) -> None:
        """See `FramePublisher.look_for_subscribers`; nothing is wanted before what it needs is imported."""
        if self._loaded is None and self._publisher.get_subscription_count() > 0:
            # Importing takes longer than a frame.
            self._loaded = background.begin(load)
        if self._loaded is not None and self._loaded.done():
            super().look_for_subscribers()

    def publish(self, frame: RecoveredFrame) -> None:
        """See `FramePublisher.publish`."""
        image, end_s = self._recovery.image, frame.end_s
        if not self._limit.due(time.monotonic()) and self._tracer.skip(end_s, image):
            return
        for outline in self._tracer.step(frame.once.indices, frame.once.counts, end_s, frame.duration_s, image):
            self._publisher.publish(_message(frame.header, frame.sequence, end_s, outline))

    def _rate_hz(self, settings: ReconstructionConfig) -> float:
        return settings.outlines_rate_hz


def _message(header: Header, sequence: int, end_s: float, outline: Outline) -> OutlineMessage:
    message = OutlineMessage(header=header, sequence=sequence, number=outline.number)
    message.before_stamp = end_s - outline.time_s
    message.centre.x, message.centre.y = outline.centre_m
    message.area, message.growth = outline.area_m2, outline.growth_m2_s
    message.perimeter, message.orientation = outline.perimeter_m, outline.orientation_rad
    message.x, message.y = (array("f", values.astype(np.float32).tobytes()) for values in (outline.x_m, outline.y_m))
    return message
