# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Read full frames from a bag: images in counts, or samples of full frames."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import Image

from acts_core.errors import ArrayError, RecordingError
from acts_msgs.msg import TactileSamples
from acts_recon.images import BaselineSubtraction
from acts_ros.bags import require_rosbags
from acts_ros.bags.skin_topics import IMAGE, SAMPLES, baseline_topic
from acts_ros.messages import baseline_of
from acts_tools.bags.messages import checked, image_counts, is_in_counts, messages, samples_with_baseline

_NEEDED = (
    "needed is one of type acts_msgs/msg/TactileSamples whose frames are rasters (every taxel measured: scheme "
    "raster), or of type sensor_msgs/msg/Image with encoding mono16 (image_raw)"
)


def bag_frames(path: Path, topic: str = "") -> tuple[NDArray[np.uint16], str]:
    """Read all full frames of one topic.

    From samples the baseline in the bag (topic ``baseline`` of the same skin) is subtracted, as in the reconstruction.
    The baseline of images is subtracted already.

    Parameters
    ----------
    path : Path
        Folder in rosbag2's layout, or an MCAP file.
    topic : str
        Full name; empty for the only one with full frames.

    Returns
    -------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts, 0 to 1023.
    topic : str
        Topic of the frames.

    Raises
    ------
    RecordingError
        There is no bag, it is damaged, or no topic (or several, where none was given) has full frames.
    """
    require_rosbags()
    # Imports rosbags, which a ROS installation need not have.
    from acts_ros.bags.reading import open_bag

    with open_bag(path) as bag:
        if bag.note:
            print(f"note: {bag.note}", file=sys.stderr)
        types = bag.topics()
        if topic:
            if types.get(topic) not in (IMAGE, SAMPLES):
                raise RecordingError(
                    f"the bag '{path}' has {f'{types[topic]} on' if topic in types else 'no topic'} {topic}; "
                    f"{_NEEDED}. It has {_listed(sorted(types))}"
                )
        else:
            fitting = [name for name in sorted(types) if _is_full(bag, path, name, types[name])]
            if len(fitting) != 1:
                raise RecordingError(
                    f"the bag '{path}' has full frames on {_listed(fitting)}: choose one with --topic"
                    if fitting
                    else f"the bag '{path}' has no topic of full frames, only {_listed(sorted(types))}; {_NEEDED}"
                )
            topic = fitting[0]
        bag.check_definition(topic)
        read = _images(bag, path, topic) if types[topic] == IMAGE else _rasters(bag, path, topic, types)
        frames = list(read)
    if not frames:
        raise RecordingError(f"the bag '{path}' has no messages on {topic}")
    if len({frame.shape for frame in frames}) > 1:
        raise RecordingError(f"frames of different sizes on {topic} in '{path}': needed are those of one array")
    return np.stack(frames), topic


def _is_full(bag: Any, path: Path, topic: str, kind: str) -> bool:
    """Whether the first message of a topic contains a full frame."""
    if kind == IMAGE:
        return is_in_counts(bag, path, topic)
    if kind == SAMPLES:
        samples = next(messages(bag, path, topic, TactileSamples), None)
        return samples is not None and len(samples.indices) == samples.rows * samples.cols
    return False


def _images(bag: Any, path: Path, topic: str) -> Iterator[NDArray[np.uint16]]:
    for number, image in enumerate(messages(bag, path, topic, Image)):
        yield image_counts(image, f"message {number} of {topic} in '{path}'")


def _rasters(bag: Any, path: Path, topic: str, types: dict[str, str]) -> Iterator[NDArray[np.uint16]]:
    beside = baseline_topic(types, topic)
    subtraction: BaselineSubtraction | None = None
    for where, samples, baseline in samples_with_baseline(bag, path, topic, beside):
        size = samples.rows * samples.cols
        indices = np.asarray(samples.indices, dtype=np.uint16)
        counts = np.asarray(samples.counts, dtype=np.uint16)
        if len(indices) != size or len(counts) != size or size == 0 or np.unique(indices).size != size:
            raise RecordingError(
                f"{where} holds {len(indices)} samples of {samples.rows} x {samples.cols} taxels: to learn from, every "
                "taxel must have been measured; record with the sampling scheme raster"
            )
        if indices.max() >= size:
            raise RecordingError(f"{where} holds index {indices.max()}; {size} taxels have 0 to {size - 1}")
        if baseline is not None:
            subtraction = BaselineSubtraction(size)
            try:
                fields = baseline_of(baseline, samples.rows, samples.cols)
                subtraction.set(fields.counts, fields.valid)
            except ArrayError as error:
                raise RecordingError(f"{beside} in '{path}' does not fit {topic}: {error}") from error
        frame = np.zeros(size, dtype=np.uint16)
        frame[indices] = counts if subtraction is None else subtraction.apply(indices, counts)
        yield checked(frame.reshape(samples.rows, samples.cols), where)


def _listed(names: list[str]) -> str:
    return ", ".join(names) or "none"
