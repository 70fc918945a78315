# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``view/age`` of the reconstruction node: how old what is known of each taxel is, for viewers."""

from __future__ import annotations

import numpy as np
from rclpy.node import Node
from sensor_msgs.msg import Image

from acts_recon.methods import Recovery
from acts_ros import qos
from acts_ros.messages import ImageFields, write_image
from acts_ros.publishers import published


class AgePublisher:
    """Publishes an image, 32FC1 [s]: 0 where the newest frame measured a taxel, else its age; inf: never measured.

    Parameters
    ----------
    node : Node
    """

    def __init__(self, node: Node) -> None:
        self._publisher = node.create_publisher(Image, "view/age", **published(qos.VIEW))
        self.is_wanted = False
        """Whether somebody listens."""

    def look_for_subscribers(self) -> None:
        """To be called now and then."""
        self.is_wanted = self._publisher.get_subscription_count() > 0

    def publish(self, stamp_ns: int, frame_id: str, recovery: Recovery, duration_s: float) -> None:
        """Publish the ages after a frame of this duration [s]; a method that does not know them publishes none."""
        if recovery.age_s is None:
            return
        age_s = np.where(recovery.age_s <= duration_s, np.float32(0.0), recovery.age_s)
        pixels = age_s.astype("<f4", copy=False).tobytes()
        rows, cols = age_s.shape
        self._publisher.publish(
            write_image(ImageFields(stamp_ns, frame_id, rows, cols, "32FC1", False, 4 * cols, pixels))
        )
