"""Topic ``object`` of the reconstruction node: which of the known objects presses."""

from __future__ import annotations

import time
from array import array

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node

from acts_msgs.msg import ObjectClass, TactileSamples
from acts_recon.classification import Classifier
from acts_recon.rate_limit import RateLimit
from acts_ros import qos


class ObjectPublisher:
    """Classifies frames and publishes acts_msgs/ObjectClass, while somebody listens.

    Parameters
    ----------
    node : Node
    classifier : Classifier
    rate_hz : float
        Largest rate; 0: every frame.
    """

    def __init__(self, node: Node, classifier: Classifier, rate_hz: float) -> None:
        self._classifier = classifier
        self._limit = RateLimit(rate_hz)
        self._publisher = node.create_publisher(ObjectClass, "object", **qos.overridable(qos.STREAM))
        self._message = ObjectClass()
        self._send = False

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        self._send = self._publisher.get_subscription_count() > 0

    def publish(self, samples: TactileSamples, indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> None:
        """Classify a frame that has been found to fit the array, and publish what it shows."""
        if not self._send or not self._limit.due(time.monotonic()):
            return
        result = self._classifier.step(indices, counts)
        message = self._message
        message.header = samples.header
        message.sequence = samples.sequence
        message.class_number = result.best if result.touched else ObjectClass.NO_OBJECT
        message.name = self._classifier.library.names[result.best] if result.touched else ""
        message.confidence = result.confidence
        message.residuals = array("f", result.residuals.astype(np.float32).tobytes())
        self._publisher.publish(message)
