# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images of one skin in a bag: recorded, or recovered from samples like in the node reconstruction."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import Image

from acts_core.array import TOUCH_COUNTS
from acts_core.errors import ActsError, ArrayError, RecordingError
from acts_msgs.msg import Baseline, TactileSamples
from acts_recon.frame_pipeline import RepeatedFrameError
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.settings import ReconstructionConfig, ReconstructionSettings
from acts_ros.messages import baseline_of, frame_of, ns_of, stamp_ns_of
from acts_tools.bags.messages import image_counts, messages, samples_with_baseline
from acts_tools.export.topics import Choice
from acts_tools.export.tracks import Track, Values, contact_found, contacts_found

# Cosine between images of the same touches; they may be recovered by other methods, or with another baseline.
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
    is_whole : bool
        Whether every taxel that is not dead had been measured by then.
    """

    stamp_ns: int
    image: NDArray[np.uint16]
    contact: Values | None = None
    contacts: Values | None = None
    is_whole: bool = True


@dataclass
class Refused:
    """Frames that could not be used, as the node reconstruction leaves them out.

    Attributes
    ----------
    count : int
        Their number.
    first : str
        Which was the first, and why.
    """

    count: int = 0
    first: str = ""

    def add(self, which: str) -> None:
        """Count one more."""
        self.count += 1
        self.first = self.first or which


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
        yield Seen(ns_of(message.header.stamp), image)


def recovered_frames(
    bag: Any, path: Path, topic: str, beside: str | None, choice: Choice, refused: Refused
) -> Iterator[Seen]:
    """Images recovered from samples, with their contacts, by the defaults of the node reconstruction.

    Parameters
    ----------
    bag : acts_ros.bags.reading.Bag
        Open.
    path : Path
        Path of the bag, for errors.
    topic, beside : str
        Topics of the samples and of the baseline; None for no baseline.
    choice : Choice
        With the layout and the dead taxels of the skin.
    refused : Refused
        Gets the frames that are left out: of another array than the first, or with taxels that it does not have.

    Raises
    ------
    RecordingError
        The array does not fit the layout or the dead taxels, the baseline does not fit the array, a message is
        damaged, or all frames are left out.
    """
    recovery: FrameRecovery | None = None
    made = 0
    for where, samples, baseline in samples_with_baseline(bag, path, topic, beside):
        try:
            if recovery is None:
                recovery = FrameRecovery(_settings(samples, choice))
            if baseline is not None:
                _subtract(recovery, baseline, f"{beside} in '{path}'")
        except RecordingError:
            raise
        except ActsError as error:
            raise RecordingError(f"{where}: {error}") from error
        try:
            seen = _seen(recovery, samples)
        except RepeatedFrameError:
            continue
        except ArrayError as error:
            refused.add(f"{where}: {error}")
            continue
        made += 1
        yield seen
    if refused.count and not made:
        raise RecordingError(refused.first)


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
        None where the recovered images are not like the recorded ones: then the layout is another.
    """
    contact, contacts, likeness = Track[Values](), Track[Values](), _Likeness()
    shown = next(recorded, None)
    for seen in frames:
        if shown is not None and seen.stamp_ns >= shown.stamp_ns:
            # Before, a recovered image lacks what the recorded one shows.
            if seen.is_whole:
                likeness.add(seen.image, shown.image)
            shown = next((one for one in recorded if one.stamp_ns > seen.stamp_ns), None)
        assert seen.contact is not None
        assert seen.contacts is not None
        contact.add(seen.stamp_ns, seen.contact)
        contacts.add(seen.stamp_ns, seen.contacts)
    return (contact, contacts) if likeness.may_be_same else None


class _Likeness:
    """Whether pairs of images may show the same touch: the cosine over all of them together.

    Attributes
    ----------
    may_be_same : bool
        True also where no recorded image shows touch.
    """

    def __init__(self) -> None:
        self._have_same_shape = True
        self._product = self._recovered = self._recorded = 0.0

    def add(self, recovered: NDArray[np.uint16], recorded: NDArray[np.uint16]) -> None:
        """Compare two images; a recorded one without touch does not tell."""
        if recovered.shape != recorded.shape:
            self._have_same_shape = False
        # Without a touch, an image says nothing of where the taxels lie.
        elif recorded.max() >= TOUCH_COUNTS:
            a, b = recovered.ravel().astype(np.float64), recorded.ravel().astype(np.float64)
            self._product += float(a @ b)
            self._recovered += float(a @ a)
            self._recorded += float(b @ b)

    @property
    def may_be_same(self) -> bool:
        if not self._recorded:
            return self._have_same_shape
        return self._have_same_shape and self._product > _LEAST_LIKENESS * math.sqrt(self._recovered * self._recorded)


def _settings(samples: TactileSamples, choice: Choice) -> ReconstructionConfig:
    return ReconstructionSettings(
        rows=samples.rows, cols=samples.cols, layout=choice.layout, dead_taxels=choice.dead_taxels
    )


def _subtract(recovery: FrameRecovery, message: Baseline, where: str) -> None:
    try:
        recovery.set_baseline(*baseline_of(message, *recovery.size))
    except ArrayError as error:
        raise RecordingError(f"{where}: {error}") from error


def _seen(recovery: FrameRecovery, samples: TactileSamples) -> Seen:
    stamp_ns = stamp_ns_of(samples)
    recovery.step(frame_of(samples), stamp_ns)
    image = np.rint(recovery.recovery.image).astype(np.uint16)
    age_s, dead = recovery.recovery.age_s, recovery.recovery.dead
    is_whole = age_s is None or bool(np.isfinite(age_s if dead is None else age_s[~dead.in_picture]).all())
    return Seen(stamp_ns, image, contact_found(recovery.contact), contacts_found(recovery.blobs), is_whole)
