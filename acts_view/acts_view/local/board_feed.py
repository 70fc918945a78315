# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What fills a recording of a board without a graph: the messages that its driver would publish."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rclpy.serialization import serialize_message

from acts_core.frames import SampleFrame
from acts_driver.baseline import Baseline
from acts_driver.nodes.baseline_services import baseline_message
from acts_ros import qos
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.qos import to_bag
from acts_ros.messages import SamplesMessage
from acts_view.recording.bounded_bag import BoundedBag


class BoardFeed:
    """See `acts_view.recording.recording.Feed`.

    Parameters
    ----------
    name : str
        Of the skin, with a slash before.
    baseline : Baseline or None
        In force at the beginning.
    count_lost : callable
        Gives how many frames the stream has lost so far.
    bag : BoundedBag
    """

    def __init__(self, name: str, baseline: Baseline | None, count_lost: Callable[[], int], bag: BoundedBag) -> None:
        definitions = Definitions()
        self._frame_id = name.strip("/")
        self._message = SamplesMessage(self._frame_id)
        self._bag = bag
        samples, base = (f"acts_msgs/msg/{kind}" for kind in ("TactileSamples", "Baseline"))
        self._samples = bag.add_topic(f"{name}/samples", samples, *definitions.describe(samples), to_bag([qos.STREAM]))
        self._baseline = bag.add_topic(f"{name}/baseline", base, *definitions.describe(base), to_bag([qos.LATCHED]))
        self._count_lost = count_lost
        self._lost_before = count_lost()
        self._is_closed = False
        if baseline is not None:
            self.set_baseline(baseline)

    @property
    def lost(self) -> int:
        """See `Feed`."""
        return self._count_lost() - self._lost_before

    def take(self, frames: Sequence[tuple[SampleFrame, int]]) -> None:
        """Write frames, each with its stamp [ns]; from one thread. After `close` it costs nothing."""
        if self._is_closed:
            return
        for frame, stamp_ns in frames:
            self._bag.write(self._samples, serialize_message(self._message.fill(frame, stamp_ns)))

    def set_baseline(self, baseline: Baseline) -> None:
        """Write a new one, until `close`."""
        if self._is_closed:
            return
        self._bag.write(self._baseline, serialize_message(baseline_message(baseline, self._frame_id)))

    def step(self) -> None:
        """See `Feed`; there is nothing to look for."""

    def close(self) -> None:
        """See `Feed`."""
        self._is_closed = True
