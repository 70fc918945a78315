# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``view/age`` of the reconstruction node: how old what is known of each taxel is, for viewers."""

from __future__ import annotations

from array import array

import numpy as np
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import Header

from acts_recon.methods import Recovery
from acts_ros import qos


class AgePublisher:
    """Publishes an image, 32FC1 [s]: 0 where the newest frame measured a taxel, else its age; inf: never measured.

    Parameters
    ----------
    node : Node
    rows, cols : int
        Of the images.
    """

    def __init__(self, node: Node, rows: int, cols: int) -> None:
        self._publisher = node.create_publisher(Image, "view/age", **qos.overridable(qos.VIEW))
        self._message = Image(height=rows, width=cols, encoding="32FC1", is_bigendian=0, step=4 * cols)
        self.is_wanted = False
        """Whether somebody listens."""

    def look_for_subscribers(self) -> None:
        """To be called now and then."""
        self.is_wanted = self._publisher.get_subscription_count() > 0

    def publish(self, header: Header, recovery: Recovery, duration_s: float) -> None:
        """Publish the ages after a frame of this duration [s]; a method that does not know them publishes none."""
        if recovery.age_s is None:
            return
        age_s = np.where(recovery.age_s <= duration_s, np.float32(0.0), recovery.age_s)
        self._message.header = header
        self._message.data = array("B", age_s.astype("<f4", copy=False).tobytes())
        self._publisher.publish(self._message)
