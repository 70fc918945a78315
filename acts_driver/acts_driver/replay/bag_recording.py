# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recorded `samples` messages out of a bag, as frames."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from acts_core.errors import PacketError, RecordingError
from acts_core.frames import SampleFrame
from acts_msgs.msg import TactileSamples
from acts_ros.bags import require_rosbags
from acts_ros.bags.skin_topics import SAMPLES
from acts_ros.messages import frame_of, message_of


class BagRecording:
    """One topic of a bag; times are the stamps of the messages, not those of the recorder.

    Parameters
    ----------
    path : Path
        Folder in rosbag2's layout, or an MCAP or SQLite file.
    topic : str
        Full name of the topic; empty for the only one of type TactileSamples.

    Attributes
    ----------
    note : str or None
        For a person: what is wrong with the bag; None where it is whole.
    first_ns : int
        Stamp of the first frame, whole microseconds.
    topic : str
        Its full name.

    Raises
    ------
    RecordingError
        There is no bag, no such topic, several to choose from, or no message on it that can be read with the installed
        definition.
    """

    def __init__(self, path: Path, topic: str) -> None:
        require_rosbags()
        from acts_ros.bags.reading import open_bag

        self._open = open_bag
        self._path = path
        with open_bag(path) as bag:
            self.note = bag.note
            self.topic = _choose(path, topic, bag.topics())
            try:
                bag.check_definition(self.topic)
            except RecordingError as error:
                raise RecordingError(f"the bag '{path}': {error}") from error
            _, self._end_ns = bag.span_ns([self.topic])
            first = next(bag.messages([self.topic]), None)
        if first is None:
            raise RecordingError(f"the bag '{path}' has no messages on {self.topic}")
        # Of the topic, not of the bag, in which others may have begun before it.
        self._begin_ns = first[1]
        self.first_ns = 1000 * next(self.frames()).board_us

    @property
    def length_us(self) -> int:
        """See `acts_driver.replay.recordings.SeekableRecording.length_us`; by the recorder's clock."""
        return (self._end_ns - self._begin_ns) // 1000

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        """One pass; see `acts_driver.replay.recordings.SeekableRecording.frames`."""
        from_ns = self._begin_ns + 1000 * from_us if from_us else None
        with self._open(self._path) as bag:
            if self.topic not in bag.topics():
                raise RecordingError(
                    f"the bag '{self._path}' has no topic {self.topic} any more: it is another one now"
                )
            for number, (_, _, data) in enumerate(bag.messages([self.topic], from_ns)):
                try:
                    yield frame_of(message_of(data, TactileSamples))
                except PacketError as error:
                    raise RecordingError(
                        f"message {number} of {self.topic} in '{self._path}' cannot be read: {error}; was it recorded "
                        "with another version of acts_msgs?"
                    ) from error


def _choose(path: Path, topic: str, types: dict[str, str]) -> str:
    fitting = sorted(name for name, kind in types.items() if kind == SAMPLES)
    if topic and topic not in fitting:
        raise RecordingError(f"the bag '{path}' has no topic {topic} of {SAMPLES}; it has {_listed(fitting)}")
    if not fitting or (len(fitting) > 1 and not topic):
        raise RecordingError(
            f"the bag '{path}' has {_listed(fitting)} of {SAMPLES}; needed is one: say which (the driver's "
            "parameter replay_topic, or the namespace after `acts view`)"
            if fitting
            else f"the bag '{path}' has no topic of {SAMPLES}, only {_listed(sorted(types))}"
        )
    return topic or fitting[0]


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"
