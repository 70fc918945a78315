# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``object`` of the reconstruction node: which of the known objects presses."""

from __future__ import annotations

import time
from array import array

import numpy as np
from rclpy.node import Node

from acts_msgs.msg import ObjectClass
from acts_recon.classifiers import ObjectRecogniser
from acts_recon.nodes.frame_publisher import RecoveredFrame, TopicPublisher
from acts_recon.settings import ReconstructionConfig


class ObjectPublisher(TopicPublisher):
    """Classifies frames and publishes acts_msgs/ObjectClass.

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recogniser : ObjectRecogniser
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recogniser: ObjectRecogniser) -> None:
        super().__init__(node, ObjectClass, "object", settings)
        self._recogniser = recogniser
        self._message = ObjectClass()

    def reset(self) -> None:
        """See `FramePublisher.reset`."""
        self._recogniser.reset()

    def publish(self, frame: RecoveredFrame) -> None:
        """See `FramePublisher.publish`."""
        samples = frame.once.indices, frame.once.counts, frame.end_s, frame.duration_s
        if not self._limit.due(time.monotonic()):
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
        self._publisher.publish(message)

    def _rate_hz(self, settings: ReconstructionConfig) -> float:
        return settings.object_rate_hz
