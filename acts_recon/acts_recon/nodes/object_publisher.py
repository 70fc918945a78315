# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``object`` of the reconstruction node: which of the known objects presses."""

from __future__ import annotations

import time
from array import array

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.runtime import RateLimit
from acts_msgs.msg import ObjectClass
from acts_recon.classifiers import ObjectRecogniser
from acts_ros import qos


class ObjectPublisher:
    """Classifies frames and publishes acts_msgs/ObjectClass, while somebody listens.

    Parameters
    ----------
    node : Node
    recogniser : ObjectRecogniser
    rate_hz : float
        Largest rate; 0: every frame.
    """

    def __init__(self, node: Node, recogniser: ObjectRecogniser, rate_hz: float) -> None:
        self._recogniser = recogniser
        self._limit = RateLimit(rate_hz)
        self._publisher = node.create_publisher(ObjectClass, "object", **qos.overridable(qos.STREAM))
        self._message = ObjectClass()
        self.is_wanted = False

    def set_rate(self, rate_hz: float) -> None:
        """Change the largest rate; 0: every frame."""
        self._limit.set_rate(rate_hz)

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        self.is_wanted = self._publisher.get_subscription_count() > 0

    def reset(self) -> None:
        """The board began anew: what it showed before counts no more."""
        self._recogniser.reset()

    def publish(
        self,
        header: Header,
        sequence: int,
        indices: NDArray[np.uint16],
        counts: NDArray[np.uint16],
        end_s: float,
        duration_s: float,
    ) -> None:
        """Classify a frame that has been recovered, and publish what it shows."""
        if not self.is_wanted:
            return
        if not self._limit.due(time.monotonic()):
            self._recogniser.update(indices, counts, end_s, duration_s)
            return
        result = self._recogniser.step(indices, counts, end_s, duration_s)
        message = self._message
        message.header = header
        message.sequence = sequence
        message.class_number = result.best if result.touched else ObjectClass.NO_OBJECT
        message.name = self._recogniser.library.names[result.best] if result.touched else ""
        message.confidence = result.confidence
        message.residuals = array("f", result.residuals.astype(np.float32).tobytes())
        self._publisher.publish(message)
