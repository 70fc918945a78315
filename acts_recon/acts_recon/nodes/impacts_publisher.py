# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``impacts`` of the reconstruction node: touches that begin, join others, or are over."""

from __future__ import annotations

from array import array

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from std_msgs.msg import Header

from acts_msgs.msg import Impact as ImpactMessage
from acts_recon.impacts import Impact
from acts_recon.methods import Recovery
from acts_recon.nodes.frame_publisher import RecoveredFrame, TopicPublisher
from acts_recon.settings import ReconstructionConfig
from acts_ros.messages import ns_of, set_stamp


class ImpactsPublisher(TopicPublisher):
    """Looks for touches in every image, and publishes acts_msgs/Impact.

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recovery : Recovery
        Holds the image.
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recovery: Recovery) -> None:
        super().__init__(node, ImpactMessage, "impacts", settings)
        self._recovery = recovery
        self._detector = settings.impact_detector(recovery)

    def reset(self) -> None:
        """See `FramePublisher.reset`."""
        self._detector.reset()

    def publish(self, frame: RecoveredFrame) -> None:
        """See `FramePublisher.publish`."""
        recovery, end_s = self._recovery, frame.end_s
        found = self._detector.step(
            end_s, frame.duration_s, recovery.image, recovery.sigma, recovery.age_s, recovery.measured
        )
        for impact in found:
            self._publisher.publish(_message(frame.header, frame.sequence, end_s, impact))


def _message(header: Header, sequence: int, end_s: float, impact: Impact) -> ImpactMessage:
    message = ImpactMessage(header=header, sequence=sequence, number=impact.number, is_over=impact.is_over)
    message.kind = int(impact.kind)
    message.joined = impact.joined
    message.bounced = impact.bounced
    # Seconds since 1970 leave too few digits: what counts is how long before the stamp.
    onset_ns = max(ns_of(header.stamp) - round((end_s - impact.onset_s) * 1e9), 0)
    set_stamp(message.onset, onset_ns)
    message.onset_sigma = impact.onset_sd_s
    message.duration = impact.duration_s
    message.frames = impact.frames
    message.position.x, message.position.y = impact.x_m, impact.y_m
    message.peak_force, message.peak_force_sigma = impact.peak_n, impact.peak_sd_n
    message.impulse, message.impulse_sigma = impact.impulse_n_s, impact.impulse_sd_n_s
    message.direction, message.direction_sigma = impact.direction_rad, impact.direction_sd_rad
    message.velocity.x, message.velocity.y = impact.velocity_m_s
    message.velocity_sigma.x, message.velocity_sigma.y = impact.velocity_sd_m_s
    message.time = _floats(impact.time_s - impact.onset_s)
    message.force = _floats(impact.force_n)
    message.path_x, message.path_y = _floats(impact.path_x_m), _floats(impact.path_y_m)
    return message


def _floats(values: NDArray[np.float64]) -> array[float]:
    return array("f", values.astype(np.float32).tobytes())
