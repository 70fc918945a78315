# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Publish a bag's messages at the rate at which they were recorded."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher

from acts_core.errors import RecordingError
from acts_ros.bags import qos
from acts_ros.bags.reading import Bag
from acts_ros.bags.storages import SET_BACK_NS
from acts_ros.publishers import TolerantPublisher

_ACKNOWLEDGE_S = 1.0
# A pause that nobody who plays a bag takes for its end [s].
_PAUSE_S = 10.0


@dataclass
class PlayReport:
    """Result of playing.

    Attributes
    ----------
    published : int
        Messages published.
    worst_lateness_s : float
        Largest delay of a message after its due time [s].
    """

    published: int = 0
    worst_lateness_s: float = 0.0


class Player:
    """Publishes the topics of a bag with the quality of service they were recorded with.

    Parameters
    ----------
    node : Node
        Node of the publishers; it need not spin.
    bag : Bag
        An open bag.
    topics : sequence of str or None
        Topics to play; None for all.
    say : callable
        Called with a line for the user.
    offset_s : float
        Leave out so much of the bag's beginning [s].

    Raises
    ------
    RecordingError
        A topic is not in the bag, no topic can be played, or none has a message after the offset.
    """

    def __init__(
        self,
        node: Node,
        bag: Bag,
        topics: Sequence[str] | None,
        say: Callable[[str], None],
        offset_s: float = 0.0,
    ) -> None:
        self.report = PlayReport()
        self._bag = bag
        self._say = say
        self._publishers: dict[str, Publisher] = {}
        types = bag.topics()
        # One that is named twice would have two publishers, of which only one says something.
        for topic in dict.fromkeys(types if topics is None else topics):
            if topic not in types:
                raise RecordingError(f"the bag has no topic '{topic}' (it has: {', '.join(sorted(types)) or 'none'})")
            try:
                kind = bag.message_class(topic)
            except RecordingError as error:
                say(f"not played: {topic}: {error}")
                continue
            profile = qos.for_publisher(bag.recorded_qos(topic), bag.message_count(topic))
            self._publishers[topic] = node.create_publisher(kind, topic, profile, publisher_class=TolerantPublisher)
        if not self._publishers:
            raise RecordingError("the bag has no topic that can be played")
        self._from_ns = self._begin_ns(offset_s) if offset_s else None

    def play(self, rate: float, sleep_until: Callable[[float], bool]) -> bool:
        """Publish all messages once.

        Parameters
        ----------
        rate : float
            Speed; 2 plays twice as fast.
        sleep_until : callable
            Sleeps until a time of the monotonic clock [s]; returns False to stop.

        Returns
        -------
        bool
            False when it was stopped.

        Raises
        ------
        RecordingError
            The bag is damaged; everything before the damage has been published.
        """
        started_s = time.monotonic()
        first_ns: int | None = None
        last_ns = 0
        for topic, stamp_ns, data in self._bag.messages(list(self._publishers), self._from_ns):
            if first_ns is None:
                first_ns = stamp_ns
            elif stamp_ns < last_ns - SET_BACK_NS:
                # A clock was set while it was recorded: it goes on at once, and not all that follows.
                first_ns += stamp_ns - last_ns
            last_ns = stamp_ns
            # Every deadline is relative to the start, so that delays do not accumulate.
            deadline_s = started_s + (stamp_ns - first_ns) * 1e-9 / rate
            pause_s = deadline_s - time.monotonic()
            if pause_s > _PAUSE_S:
                after_s = (stamp_ns - first_ns) * 1e-9
                self._say(
                    f"paused: the next message is due in {pause_s:.0f} s, {after_s:.0f} s after the first; if a clock "
                    "was set while the bag was recorded, --start-offset leaves out what is before"
                )
            if not sleep_until(deadline_s):
                return False
            self.report.worst_lateness_s = max(self.report.worst_lateness_s, time.monotonic() - deadline_s)
            self._publishers[topic].publish(data)
            self.report.published += 1
        return True

    def _begin_ns(self, offset_s: float) -> int:
        """Stamp at an offset from the bag's beginning [ns], after which there are messages."""
        begin_ns, end_ns = self._bag.span_ns(list(self._bag.topics()))
        length_s = (end_ns - begin_ns) * 1e-9
        played = list(self._publishers)
        if offset_s <= length_s:
            from_ns = begin_ns + round(offset_s * 1e9)
            if next(self._bag.messages(played, from_ns), None) is not None:
                return from_ns
        raise RecordingError(
            f"nothing to play {offset_s:g} s after the bag's beginning: it is {length_s:.3f} s long, and the topics "
            f"to play are {', '.join(sorted(played))}; give a smaller offset"
        )

    def finish(self) -> None:
        """Wait until reliable subscribers have received the last messages, for a second at most in all."""
        deadline_s = time.monotonic() + _ACKNOWLEDGE_S
        for publisher in self._publishers.values():
            left_s = max(deadline_s - time.monotonic(), 0.0)
            publisher.wait_for_all_acked(Duration(nanoseconds=int(left_s * 1e9)))
