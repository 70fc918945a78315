# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics of the reconstruction node with images, and those for viewers that draw by themselves."""

from __future__ import annotations

import time

from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import Image

from acts_core.runtime import RateLimit
from acts_recon.images import mono16, rgb8
from acts_recon.methods import Recovery
from acts_recon.nodes.age_publisher import AgePublisher
from acts_recon.nodes.frame_publisher import FramePublisher, RecoveredFrame
from acts_recon.nodes.series_publisher import LONGEST, SeriesPublisher
from acts_recon.settings import ReconstructionConfig
from acts_ros import qos
from acts_ros.messages import ImageFields, write_image
from acts_ros.publishers import published


class ImagesPublisher(FramePublisher):
    """Publishes images.

    ``image_raw`` (sensor_msgs/Image, mono16, counts), ``confidence`` (mono8, with the method ``fusion``), and, when
    they are due, ``image`` (rgb8), ``view/image_raw``, ``view/confidence``, ``view/age`` (32FC1, see `AgePublisher`)
    and ``view/contact_series`` (acts_msgs/ContactSeries; also as soon as it is full).

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recovery : Recovery
        Holds the image.
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recovery: Recovery) -> None:
        self._settings = settings
        self._recovery = recovery
        self._raw_publisher = node.create_publisher(Image, "image_raw", **published(qos.STREAM))
        self._confidence_publisher = node.create_publisher(Image, "confidence", **published(qos.STREAM))
        self._view_publisher = node.create_publisher(Image, "image", **published(qos.VIEW))
        self._view_raw_publisher = node.create_publisher(Image, "view/image_raw", **published(qos.VIEW))
        self._view_confidence_publisher = node.create_publisher(Image, "view/confidence", **published(qos.VIEW))
        self._ages = AgePublisher(node)
        self._series = SeriesPublisher(node)
        self._raw_limit = RateLimit(settings.image_raw_rate_hz)
        self._send_raw = self._send_confidence = False

    def set_rates(self, settings: ReconstructionConfig) -> None:
        """See `FramePublisher.set_rates`."""
        self._settings = settings
        self._raw_limit.set_rate(settings.image_raw_rate_hz)

    def look_for_subscribers(self) -> None:
        """See `FramePublisher.look_for_subscribers`."""
        self._ages.look_for_subscribers()
        self._series.look_for_subscribers()
        self._send_raw = self._raw_publisher.get_subscription_count() > 0
        self._send_confidence = self._confidence_publisher.get_subscription_count() > 0
        wanted = {
            "view/image_raw": self._view_raw_publisher.get_subscription_count() > 0,
            "view/confidence": self._view_confidence_publisher.get_subscription_count() > 0,
            "view/age": self._ages.is_wanted,
            "view/contact_series": self._series.is_wanted,
            "image": self._view_publisher.get_subscription_count() > 0,
        }
        self.viewed = [topic for topic, is_wanted in wanted.items() if is_wanted]
        self.is_wanted = self._send_raw or self._send_confidence or bool(self.viewed)

    def publish(self, frame: RecoveredFrame) -> None:
        """See `FramePublisher.publish`."""
        stamp_ns, frame_id, due = frame.stamp_ns, frame.header.frame_id, frame.due
        if self._series.is_wanted:
            if not self._series.takes(stamp_ns):
                self._series.publish(frame_id)
            self._series.add(stamp_ns, frame.sequence, frame.contact)
        if self._send_raw and self._raw_limit.due(time.monotonic()):
            self._publish_raw(self._raw_publisher, stamp_ns, frame_id)
        if self._send_confidence:
            self._publish_confidence(self._confidence_publisher, stamp_ns, frame_id)
        if "view/image_raw" in due:
            self._publish_raw(self._view_raw_publisher, stamp_ns, frame_id)
        if "view/confidence" in due:
            self._publish_confidence(self._view_confidence_publisher, stamp_ns, frame_id)
        if "view/age" in due:
            self._ages.publish(stamp_ns, frame_id, self._recovery, frame.duration_s)
        # Where viewers get few messages, or frames are many, sooner: no contact is left out.
        if "view/contact_series" in due or len(self._series) == LONGEST:
            self._series.publish(frame_id)
        if "image" in due:
            self._publish_view(stamp_ns, frame_id)

    def _publish_raw(self, publisher: Publisher, stamp_ns: int, frame_id: str) -> None:
        rows, cols = self._recovery.image.shape
        pixels = mono16(self._recovery.image)
        image = ImageFields(stamp_ns, frame_id, rows, cols, "mono16", False, 2 * cols, pixels)
        publisher.publish(write_image(image))

    def _publish_confidence(self, publisher: Publisher, stamp_ns: int, frame_id: str) -> None:
        confidence = self._recovery.confidence()
        if confidence is None:
            return
        rows, cols = confidence.shape
        image = ImageFields(stamp_ns, frame_id, rows, cols, "mono8", False, cols, confidence.tobytes())
        publisher.publish(write_image(image))

    def _publish_view(self, stamp_ns: int, frame_id: str) -> None:
        scale = self._settings.image_scale
        rows, cols = (scale * side for side in self._recovery.image.shape)
        pixels = rgb8(self._recovery.image, scale=scale, full_scale_counts=self._settings.image_full_scale_counts)
        image = ImageFields(stamp_ns, frame_id, rows, cols, "rgb8", False, 3 * cols, pixels)
        self._view_publisher.publish(write_image(image))
