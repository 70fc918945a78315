# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images of one skin in a bag: recorded, or recovered from samples like in the node reconstruction."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import Image

from acts_core.errors import ActsError, ArrayError, RecordingError
from acts_msgs.msg import Baseline, TactileSamples
from acts_recon.contacts import BlobTracker
from acts_recon.images import BaselineSubtraction
from acts_recon.settings import ReconstructionSettings
from acts_ros.messages import frame_of, stamp_ns_of
from acts_tools.bags.messages import image_counts, messages, parsed
from acts_tools.export.tracks import Values, contact_found, contacts_found
from acts_tools.export.tracks import stamp_ns_of as header_stamp_ns

# A sequence number this far ahead means that the board has restarted.
_HALF_SEQUENCE = 1 << 31


@dataclass(frozen=True)
class Seen:
    """One image.

    Attributes
    ----------
    stamp_ns : int
        Time of its last measurement, ROS time [ns].
    image : np.ndarray [shape=(rows, cols), dtype=uint16]
        Counts minus the baseline, 0 to 1023.
    contact, contacts : np.ndarray or None
        Columns are `CONTACT_COLUMNS` and `CONTACTS_COLUMNS`; None for a recorded image.
    """

    stamp_ns: int
    image: NDArray[np.uint16]
    contact: Values | None = None
    contacts: Values | None = None


def recorded_frames(bag: Any, path: Path, topic: str) -> Iterator[Seen]:
    """Images of a topic in counts, such as ``image_raw``.

    Raises
    ------
    RecordingError
        A message is no image in counts.
    """
    for number, message in enumerate(messages(bag, path, topic, Image)):
        yield Seen(header_stamp_ns(message), image_counts(message, f"message {number} of {topic} in '{path}'"))


def recovered_frames(bag: Any, path: Path, topic: str, beside: str | None, layout: str) -> Iterator[Seen]:
    """Images recovered from samples, with their contacts, by the defaults of the node reconstruction.

    Parameters
    ----------
    bag : acts_ros.bags.reading.Bag
        Open.
    path : Path
        Path of the bag, for errors.
    topic, beside : str
        Topics of the samples and of the baseline; None for no baseline.
    layout : str
        Name or file, as in `acts_core.skin.layout`.

    Raises
    ------
    RecordingError
        Frames do not fit the layout, the baseline does not fit the frames, or a message is damaged.
    """
    recovery: _Recovery | None = None
    latest: Baseline | None = None
    number = -1
    for name, _, data in bag.messages([topic] if beside is None else [topic, beside]):
        if name == beside:
            latest = parsed(data, Baseline, f"a message of {beside} in '{path}'")
            if recovery is not None:
                recovery.subtract(latest)
            continue
        number += 1
        where = f"message {number} of {topic} in '{path}'"
        samples = parsed(data, TactileSamples, where)
        try:
            if recovery is None:
                recovery = _Recovery(samples.rows, samples.cols, layout)
                if latest is not None:
                    recovery.subtract(latest)
            yield recovery.step(samples)
        except ActsError as error:
            raise RecordingError(f"{where}: {error}") from error


class _Recovery:
    """Recovers frame by frame like the node."""

    def __init__(self, rows: int, cols: int, layout: str) -> None:
        settings = ReconstructionSettings(rows=rows, cols=cols, layout=layout)
        self._size = (rows, cols)
        self._recovery = settings.recovery()
        self._tracker = BlobTracker(
            self._recovery.geometry, self._recovery.response, settings.blob_config(), self._recovery.borders
        )
        self._baseline = BaselineSubtraction(rows * cols)
        self._last_sequence: int | None = None

    def subtract(self, message: Baseline) -> None:
        self._baseline.set(np.asarray(message.baseline, dtype=np.float32), np.asarray(message.valid, dtype=np.bool_))

    def step(self, samples: TactileSamples) -> Seen:
        frame, stamp_ns = frame_of(samples), stamp_ns_of(samples)
        if (frame.rows, frame.cols) != self._size:
            raise ArrayError(
                f"a frame of {frame.rows} x {frame.cols} taxels after those of {self._size[0]} x {self._size[1]}: "
                "export one array a time"
            )
        last, self._last_sequence = self._last_sequence, frame.sequence
        if last is not None and (frame.sequence - last - 1) % (2 * _HALF_SEQUENCE) >= _HALF_SEQUENCE:
            self._recovery.reset()
            self._tracker.reset()
        counts = self._baseline.apply(frame.indices, frame.counts)
        found = self._recovery.step(frame.indices, counts, stamp_ns * 1e-9, frame.duration_us * 1e-6)
        blobs = self._tracker.step(self._recovery.image, stamp_ns * 1e-9, self._recovery.sigma)
        image = np.rint(self._recovery.image).astype(np.uint16)
        return Seen(stamp_ns, image, contact_found(found), contacts_found(tuple(blobs)))
