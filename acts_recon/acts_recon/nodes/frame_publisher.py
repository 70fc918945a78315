# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the publishers of the reconstruction node have in common, and what they are given of a frame."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from typing import NamedTuple

from rclpy.node import Node
from std_msgs.msg import Header

from acts_core.frames import SampleFrame
from acts_core.runtime import RateLimit
from acts_recon.contacts import Contact
from acts_recon.settings import ReconstructionConfig
from acts_ros import qos
from acts_ros.publishers import published


class RecoveredFrame(NamedTuple):
    """A frame that has been recovered.

    Attributes
    ----------
    header : Header
        Of its messages; the next frame overwrites it.
    stamp_ns : int
        The same stamp: end of the last measurement [ns].
    once : SampleFrame
        With each taxel once, less the baseline.
    every : SampleFrame
        With all samples, less the baseline.
    contact : Contact
        In the image.
    due : collection of str
        The topics for viewers to publish now.
    """

    header: Header
    stamp_ns: int
    once: SampleFrame
    every: SampleFrame
    contact: Contact
    due: Collection[str] = ()

    @property
    def sequence(self) -> int:
        """Number of the frame."""
        return self.once.sequence

    @property
    def end_s(self) -> float:
        """When the last measurement ended [s]."""
        return self.stamp_ns * 1e-9

    @property
    def duration_s(self) -> float:
        """How long the measurements of `once` took [s]."""
        return self.once.duration_us * 1e-6


class FramePublisher(ABC):
    """Publishes something of every frame, while somebody listens."""

    is_wanted = False
    """Whether somebody listens."""
    viewed: Collection[str] = ()
    """Topics for viewers that somebody listens to."""

    @abstractmethod
    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""

    @abstractmethod
    def publish(self, frame: RecoveredFrame) -> None:
        """Publish what is in a frame; to be called for each frame while it is wanted."""

    def reset(self) -> None:  # noqa: B027
        """Forget all frames: the next one is not of the same board, or long after."""

    def set_rates(self, settings: ReconstructionConfig) -> None:  # noqa: B027
        """Put changed parameters in force."""


class TopicPublisher(FramePublisher):
    """Publishes one topic.

    Parameters
    ----------
    node : Node
    kind : type
        Of the messages.
    topic : str
    settings : ReconstructionConfig
    """

    def __init__(self, node: Node, kind: type, topic: str, settings: ReconstructionConfig) -> None:
        self._publisher = node.create_publisher(kind, topic, **published(qos.STREAM))
        self._limit = RateLimit(self._rate_hz(settings))

    def look_for_subscribers(self) -> None:
        """See `FramePublisher.look_for_subscribers`."""
        is_wanted = self._publisher.get_subscription_count() > 0
        if is_wanted and not self.is_wanted:
            self.reset()
        self.is_wanted = is_wanted

    def set_rates(self, settings: ReconstructionConfig) -> None:
        """See `FramePublisher.set_rates`."""
        self._limit.set_rate(self._rate_hz(settings))

    def _rate_hz(self, settings: ReconstructionConfig) -> float:
        """Largest rate [Hz]; 0: every frame."""
        return 0.0
