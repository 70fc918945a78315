# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``regions`` of the reconstruction node: what each patch of the skin feels."""

from __future__ import annotations

import time

from rclpy.node import Node

from acts_core.runtime import RateLimit
from acts_msgs.msg import RegionContacts
from acts_recon.methods import Recovery
from acts_recon.regions import Regions
from acts_ros import qos
from acts_ros.messages import write_regions


class RegionsPublisher:
    """Finds what the patches feel in every image, and publishes acts_msgs/RegionContacts, while somebody listens.

    Parameters
    ----------
    node : Node
    regions : Regions
    rate_hz : float
        Largest rate [Hz]; 0: every image.
    """

    def __init__(self, node: Node, regions: Regions, rate_hz: float) -> None:
        self._regions = regions
        self._publisher = node.create_publisher(RegionContacts, "regions", **qos.overridable(qos.STREAM))
        self._limit = RateLimit(rate_hz)
        self.is_wanted = False

    def set_rate(self, rate_hz: float) -> None:
        """Change the largest rate [Hz]."""
        self._limit.set_rate(rate_hz)

    def reset(self) -> None:
        """Forget all images: the next one is not of the same board, or long after."""
        self._regions.reset()

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        send = self._publisher.get_subscription_count() > 0
        if send and not self.is_wanted:
            self._regions.reset()
        self.is_wanted = send

    def publish(self, stamp_ns: int, frame_id: str, sequence: int, recovery: Recovery) -> None:
        """Find what the patches feel in the image of a frame, and publish it.

        Parameters
        ----------
        stamp_ns : int
            Of the frame [ns].
        frame_id : str
            Of the skin.
        sequence : int
            The frame's number.
        recovery : Recovery
            Holds the image.
        """
        if not (self.is_wanted and self._limit.due(time.monotonic())):
            return
        found = self._regions.step(stamp_ns * 1e-9, recovery.image, recovery.measured, recovery.age_s)
        self._publisher.publish(write_regions(stamp_ns, frame_id, sequence, found))
