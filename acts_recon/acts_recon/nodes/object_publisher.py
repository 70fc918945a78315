# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics ``object`` and ``view/object`` of the reconstruction node: which of the known objects presses."""

from __future__ import annotations

import time
from array import array

import numpy as np
from rclpy.node import Node

from acts_core.runtime import RateLimit
from acts_msgs.msg import ObjectClass
from acts_recon.classifiers import ObjectRecogniser
from acts_recon.nodes.frame_publisher import FramePublisher, RecoveredFrame
from acts_recon.settings import ReconstructionConfig
from acts_ros import qos
from acts_ros.publishers import published

_VIEWED = "view/object"


class ObjectPublisher(FramePublisher):
    """Classifies frames and publishes acts_msgs/ObjectClass.

    For viewers there is besides, when it is due, the same message on ``view/object``. For them alone no more frames are
    classified than they are told of.

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recogniser : ObjectRecogniser
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recogniser: ObjectRecogniser) -> None:
        self._publisher = node.create_publisher(ObjectClass, "object", **published(qos.STREAM))
        self._view_publisher = node.create_publisher(ObjectClass, _VIEWED, **published(qos.VIEW))
        self._limit = RateLimit(settings.object_rate_hz)
        self._recogniser = recogniser
        self._message = ObjectClass()
        self._send = False
        # Kept until a frame is classified: where `object_rate_hz` is low, that is a later one.
        self._is_view_due = False

    def reset(self) -> None:
        """See `FramePublisher.reset`."""
        self._recogniser.reset()

    def set_rates(self, settings: ReconstructionConfig) -> None:
        """See `FramePublisher.set_rates`."""
        self._limit.set_rate(settings.object_rate_hz)

    def look_for_subscribers(self) -> None:
        """See `FramePublisher.look_for_subscribers`."""
        self._send = self._publisher.get_subscription_count() > 0
        self.viewed = [_VIEWED] if self._view_publisher.get_subscription_count() > 0 else []
        is_wanted = self._send or bool(self.viewed)
        if is_wanted and not self.is_wanted:
            self.reset()
        self.is_wanted = is_wanted

    def publish(self, frame: RecoveredFrame) -> None:
        """See `FramePublisher.publish`."""
        samples = frame.once.indices, frame.once.counts, frame.end_s, frame.duration_s
        self._is_view_due = self._is_view_due or _VIEWED in frame.due
        if not (self._send or self._is_view_due) or not self._limit.due(time.monotonic()):
            self._recogniser.update(*samples)
            return
        result = self._recogniser.step(*samples)
        message = self._message
        message.header = frame.header
        message.sequence = frame.sequence
        message.class_number = result.best if result.touched else ObjectClass.NO_OBJECT
        message.name = self._recogniser.library.names[result.best] if result.touched else ""
        message.confidence = result.confidence
        message.residuals = array("f", result.residuals.astype(np.float32).tobytes())
        if self._send:
            self._publisher.publish(message)
        if self._is_view_due:
            self._view_publisher.publish(message)
            self._is_view_due = False
