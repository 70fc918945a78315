# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``regions`` of the reconstruction node: what each patch of the skin feels."""

from __future__ import annotations

import time

from rclpy.node import Node

from acts_msgs.msg import RegionContacts
from acts_recon.methods import Recovery
from acts_recon.nodes.frame_publisher import RecoveredFrame, TopicPublisher
from acts_recon.regions import Regions
from acts_recon.settings import ReconstructionConfig
from acts_ros.messages import RegionsFields, write_regions


class RegionsPublisher(TopicPublisher):
    """Finds what the patches feel in every image, and publishes acts_msgs/RegionContacts.

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recovery : Recovery
        Holds the image.
    regions : Regions
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recovery: Recovery, regions: Regions) -> None:
        super().__init__(node, RegionContacts, "regions", settings)
        self._recovery = recovery
        self._regions = regions

    def reset(self) -> None:
        """See `FramePublisher.reset`."""
        self._regions.reset()

    def publish(self, frame: RecoveredFrame) -> None:
        """See `FramePublisher.publish`."""
        if not self._limit.due(time.monotonic()):
            return
        recovery = self._recovery
        found = self._regions.step(frame.end_s, recovery.image, recovery.measured, recovery.age_s)
        fields = RegionsFields(frame.stamp_ns, frame.header.frame_id, frame.sequence, found)
        self._publisher.publish(write_regions(fields))

    def _rate_hz(self, settings: ReconstructionConfig) -> float:
        return settings.regions_rate_hz
