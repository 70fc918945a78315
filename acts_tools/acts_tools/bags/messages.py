# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages out of a bag, checked; what cannot be used is told by its number and topic."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import Image

from acts_core.array import COUNT_MAX
from acts_core.errors import PacketError, RecordingError
from acts_msgs.msg import Baseline, TactileSamples
from acts_ros.messages import message_of, ns_of

_Message = TypeVar("_Message")


def messages(bag: Any, path: Path, topic: str, kind: type[_Message]) -> Iterator[_Message]:
    """All messages of a topic, in their order.

    Parameters
    ----------
    bag : acts_ros.bags.reading.Bag
        Open.
    path : Path
        Of the bag, for errors.
    topic : str
    kind : type
        Of its messages.

    Raises
    ------
    RecordingError
        One cannot be read.
    """
    for number, (_, _, data) in enumerate(bag.messages([topic])):
        yield parsed(data, kind, f"message {number} of {topic} in '{path}'")


def parsed(data: bytes, kind: type[_Message], where: str) -> _Message:
    """A message out of its bytes.

    Raises
    ------
    RecordingError
        The bytes are no such message; `where` says which.
    """
    try:
        return message_of(data, kind)
    except PacketError as error:
        raise RecordingError(
            f"{where} cannot be read: {error}; was it recorded with another version of its package?"
        ) from error


def samples_with_baseline(
    bag: Any, path: Path, topic: str, beside: str | None
) -> Iterator[tuple[str, TactileSamples, Baseline | None]]:
    """All samples of a topic in their order, each with words for where it is and the baseline that is newest then.

    Parameters
    ----------
    bag, path
        As of `messages`.
    topic, beside : str
        Topics of the samples and of the baseline, see `acts_ros.bags.skin_topics`; None for no baseline.

    Returns
    -------
    iterator of (str, TactileSamples, Baseline or None)
        The baseline is None where it is that of the samples before. The first one in the bag also holds for samples
        that came before it, from its stamp on.

    Raises
    ------
    RecordingError
        A message cannot be read.
    """
    # It is latched, so a recorder may hear it after samples that it was determined before.
    waiting = None if beside is None else next(messages(bag, path, beside, Baseline), None)
    number = heard = 0
    latest: Baseline | None = None
    for name, _, data in bag.messages([topic] if beside is None else [topic, beside]):
        if name == beside:
            if heard:
                latest = parsed(data, Baseline, f"message {heard} of {beside} in '{path}'")
            elif waiting is not None:
                latest, waiting = waiting, None
            heard += 1
            continue
        where = f"message {number} of {topic} in '{path}'"
        samples = parsed(data, TactileSamples, where)
        if waiting is not None and ns_of(waiting.header.stamp) <= ns_of(samples.header.stamp):
            latest, waiting = waiting, None
        yield where, samples, latest
        number, latest = number + 1, None


def is_in_counts(bag: Any, path: Path, topic: str) -> bool:
    """Whether the first image of a topic is one in counts, as of ``image_raw``; parameters as of `messages`."""
    first = next(messages(bag, path, topic, Image), None)
    return first is not None and first.encoding == "mono16"


def image_counts(image: Image, where: str) -> NDArray[np.uint16]:
    """Counts of an image of a skin.

    Returns
    -------
    np.ndarray [shape=(rows, cols), dtype=uint16]
        0 to 1023.

    Raises
    ------
    RecordingError
        It has another encoding than mono16, is not whole, or holds other values; `where` says which.
    """
    data = bytes(image.data)
    step = image.step
    is_whole = bool(data) and image.width > 0 and step >= 2 * image.width and len(data) == step * image.height
    if image.encoding != "mono16" or not is_whole:
        raise RecordingError(
            f"{where} is an image {image.width} x {image.height}, "
            f"{image.encoding}, of {len(data)} bytes: needed is mono16, whole and of one pixel or more"
        )
    rows = np.frombuffer(data, dtype=np.uint8).reshape(image.height, step)[:, : 2 * image.width]
    frame = np.ascontiguousarray(rows).view(">u2" if image.is_bigendian else "<u2").astype(np.uint16)
    return checked(frame, where)


def checked(frame: NDArray[np.uint16], where: str) -> NDArray[np.uint16]:
    """The frame, whose counts are allowed ones.

    Raises
    ------
    RecordingError
        They are not; `where` says which frame.
    """
    if frame.max() > COUNT_MAX:
        raise RecordingError(f"{where} holds {frame.max()} counts; allowed is 0 to {COUNT_MAX}")
    return frame
