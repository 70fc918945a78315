# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topic ``impacts`` of the reconstruction node: touches that begin, and what they were when they are over."""

from __future__ import annotations

from array import array

import numpy as np
from numpy.typing import NDArray
from rclpy.node import Node
from std_msgs.msg import Header

from acts_msgs.msg import Impact as ImpactMessage
from acts_recon.impacts import Impact, ImpactDetector
from acts_recon.methods import Recovery
from acts_ros import qos
from acts_ros.messages import ns_of, set_stamp


class ImpactsPublisher:
    """Looks for touches in every image, and publishes acts_msgs/Impact, while somebody listens.

    Parameters
    ----------
    node : Node
    detector : ImpactDetector
    """

    def __init__(self, node: Node, detector: ImpactDetector) -> None:
        self._detector = detector
        self._publisher = node.create_publisher(ImpactMessage, "impacts", **qos.overridable(qos.STREAM))
        self.is_wanted = False

    def reset(self) -> None:
        """Forget all images: the next one is not of the same board, or long after."""
        self._detector.reset()

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        send = self._publisher.get_subscription_count() > 0
        if send and not self.is_wanted:
            self._detector.reset()
        self.is_wanted = send

    def publish(self, header: Header, sequence: int, end_s: float, duration_s: float, recovery: Recovery) -> None:
        """Look at the image of a frame, and publish what has begun and what is over.

        Parameters
        ----------
        header : Header
            Of the frame.
        sequence : int
            The frame's number.
        end_s, duration_s : float
            When the frame's last measurement ended, and how long all of them took [s].
        recovery : Recovery
            Holds the image.
        """
        if not self.is_wanted:
            return
        found = self._detector.step(
            end_s, duration_s, recovery.image, recovery.sigma, recovery.age_s, recovery.measured
        )
        for impact in found:
            self._publisher.publish(_message(header, sequence, end_s, impact))


def _message(header: Header, sequence: int, end_s: float, impact: Impact) -> ImpactMessage:
    message = ImpactMessage(header=header, sequence=sequence, number=impact.number, is_over=impact.is_over)
    message.kind = int(impact.kind)
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
