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
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.settings import ReconstructionConfig, ReconstructionSettings
from acts_ros.messages import frame_of, stamp_ns_of
from acts_tools.bags.messages import image_counts, messages, parsed
from acts_tools.export.tracks import Track, Values, contact_found, contacts_found
from acts_tools.export.tracks import stamp_ns_of as header_stamp_ns

# Without a taxel above it, an image says nothing of where the taxels lie.
_TOUCH_COUNTS = 60
# Cosine between images of the same touch; they may be recovered by other methods, or with another baseline.
_LEAST_LIKENESS = 0.5


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
        A message is no image in counts, or of another size than the first.
    """
    size: tuple[int, ...] = ()
    for number, message in enumerate(messages(bag, path, topic, Image)):
        where = f"message {number} of {topic} in '{path}'"
        image = image_counts(message, where)
        size = size or image.shape
        if image.shape != size:
            raise RecordingError(f"{where} is an image of {image.shape}, those before are of {size}")
        yield Seen(header_stamp_ns(message), image)


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
    recovery: FrameRecovery | None = None
    latest: Baseline | None = None
    number = -1
    for name, _, data in bag.messages([topic] if beside is None else [topic, beside]):
        if name == beside:
            latest = parsed(data, Baseline, f"a message of {beside} in '{path}'")
            if recovery is not None:
                _subtract(recovery, latest, f"{beside} in '{path}'")
            continue
        number += 1
        where = f"message {number} of {topic} in '{path}'"
        samples = parsed(data, TactileSamples, where)
        try:
            if recovery is None:
                recovery = FrameRecovery(_settings(samples, layout))
                if latest is not None:
                    _subtract(recovery, latest, f"{beside} in '{path}'")
            yield _seen(recovery, samples)
        except RecordingError:
            raise
        except ActsError as error:
            raise RecordingError(f"{where}: {error}") from error


def contacts_in(frames: Iterator[Seen], recorded: Iterator[Seen]) -> tuple[Track[Values], Track[Values]] | None:
    """The total contact and the single contacts of recovered images, where the images themselves were recorded.

    Parameters
    ----------
    frames : iterator of Seen
        Recovered.
    recorded : iterator of Seen
        The recorded images, in a pass of their own.

    Returns
    -------
    (Track, Track) or None
        None where a recovered image is not like the recorded one with the most touch: then the layout is another.
    """
    contact, contacts = Track[Values](), Track[Values]()
    most = max(recorded, key=lambda seen: int(seen.image.sum()), default=None)
    for seen in frames:
        if most is not None and seen.stamp_ns >= most.stamp_ns:
            if not _are_alike(seen.image, most.image):
                return None
            most = None
        assert seen.contact is not None
        assert seen.contacts is not None
        contact.add(seen.stamp_ns, seen.contact)
        contacts.add(seen.stamp_ns, seen.contacts)
    return contact, contacts


def _are_alike(recovered: NDArray[np.uint16], recorded: NDArray[np.uint16]) -> bool:
    """Whether two images may show the same touch; a recorded one without touch does not tell."""
    if recovered.shape != recorded.shape:
        return False
    if recorded.max() < _TOUCH_COUNTS:
        return True
    a, b = recovered.ravel().astype(np.float64), recorded.ravel().astype(np.float64)
    return bool(a.any()) and float(a @ b) >= _LEAST_LIKENESS * float(np.linalg.norm(a) * np.linalg.norm(b))


def _settings(samples: TactileSamples, layout: str) -> ReconstructionConfig:
    return ReconstructionSettings(rows=samples.rows, cols=samples.cols, layout=layout)


def _subtract(recovery: FrameRecovery, message: Baseline, where: str) -> None:
    try:
        recovery.set_baseline(
            np.asarray(message.baseline, dtype=np.float32),
            np.asarray(message.noise, dtype=np.float32),
            np.asarray(message.valid, dtype=np.bool_),
        )
    except ArrayError as error:
        raise RecordingError(f"{where}: {error}") from error


def _seen(recovery: FrameRecovery, samples: TactileSamples) -> Seen:
    stamp_ns = stamp_ns_of(samples)
    recovery.step(frame_of(samples), stamp_ns)
    image = np.rint(recovery.recovery.image).astype(np.uint16)
    return Seen(stamp_ns, image, contact_found(recovery.contact), contacts_found(tuple(recovery.blobs)))
