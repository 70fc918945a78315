# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The exported part of a bag: one skin, its contacts and the joints, at common times."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.runtime import NS_PER_S
from acts_core.skin import layout
from acts_core.words import counted
from acts_msgs.msg import RegionContacts
from acts_ros.bags import require_rosbags
from acts_tools.bags.messages import messages
from acts_tools.export.frames import Refused, Seen, contacts_in, recorded_frames, recovered_frames
from acts_tools.export.topics import NO_JOINTS, Choice, ChosenTopics, chosen_topics
from acts_tools.export.tracks import CONTACT_COLUMNS, Joints, Track, Values, contact_track, contacts_track, joint_track

_REGIONS = "acts_msgs/msg/RegionContacts"
_WITHOUT_NUMBERS = "left out, with values that are no numbers"

# Rows are repeated for at most this time, because a bag whose clock was set would fill the disk [s].
_PAUSE_MAX_S = 60.0

# An area is a whole number of taxels, at most 4096, in single precision.
_WHOLE = 1e-3


@dataclass(frozen=True)
class Row:
    """Newest data at one time. Ages are the times since their measurement [s].

    Attributes
    ----------
    stamp_ns : int
        ROS time [ns].
    time_s : float
        Time since the first row [s].
    image : np.ndarray [shape=(rows, cols), dtype=uint16]
        Counts.
    contact : np.ndarray [shape=(7,), dtype=float64] or None
        Columns are `CONTACT_COLUMNS`; None where the recording has none.
    contacts : np.ndarray [shape=(n, 9), dtype=float64] or None
        Columns are `CONTACTS_COLUMNS`; None where the recording has none.
    joints : np.ndarray [shape=(k,), dtype=float64] or None
        Columns are `Recording.joint_columns`; None where the recording has none.
    """

    stamp_ns: int
    time_s: float
    image_age_s: float
    image: NDArray[np.uint16]
    contact_age_s: float
    contact: Values | None
    contacts: Values | None
    joints_age_s: float
    joints: Values | None


@dataclass
class Recording:
    """An open bag, from which one skin is exported; `rows` reads it."""

    name: str
    skin: str
    rate_hz: float
    joint_columns: tuple[str, ...]
    early: int = 0
    """Number of frames without a row: before the first contact or joint state."""
    backward: int = 0
    """Number of frames without a row: not newer than one before."""
    uses_layout: bool = False
    """Whether something is recovered, so that the layout makes a difference."""
    hint: str = ""
    """For the user: what may be meant otherwise; empty where there is nothing."""
    topic: str = ""
    """Of the frames."""
    _ahead_ns: int = 0
    _newest_ns: int = 0
    _notes: tuple[str, ...] = ()
    _refused: Refused = field(default_factory=Refused)
    _frames: Iterator[Seen] = field(default_factory=lambda: iter(()))
    _contact: Track[Values] | None = None
    _contacts: Track[Values] | None = None
    _joints: Track[Values] | None = None

    def notes(self) -> list[str]:
        """For the user, once the rows are read: what was left out, what is wrong with the bag, what may be meant."""
        early = (
            f"{counted(self.early, 'frame')} left out, from before all else in the bag had come once"
            if self.early
            else ""
        )
        backward = _backward(counted(self.backward, "frame"), self._ahead_ns, self.topic) if self.backward else ""
        refused = (
            f"{counted(self._refused.count, 'frame')} left out, of which the first is {self._refused.first}"
            if self._refused.count
            else ""
        )
        return [sentence for sentence in (early, backward, refused, *self._notes, self.hint) if sentence]

    def rows(self) -> Iterator[Row]:
        """All rows in order; can be read once.

        Raises
        ------
        RecordingError
            There is nothing to export, the bag is damaged, or a pause is too long.
        """
        tracks = [track for track in (self._contact, self._contacts, self._joints) if track is not None]
        begin_ns = max((track.stamps_ns[0] for track in tracks), default=0)
        made = 0
        for row in self._at_rate(begin_ns) if self.rate_hz else self._one_a_frame(begin_ns):
            yield row
            made += 1
        if not made:
            raise RecordingError(f"'{self.name}' has no row of {self.skin or '/'}: {self._without_rows(begin_ns)}")

    def _one_a_frame(self, begin_ns: int) -> Iterator[Row]:
        """A row for each frame since all topics have come once, at `begin_ns`."""
        first_ns = 0
        for seen in self._ascending():
            if seen.stamp_ns < begin_ns:
                self.early += 1
                continue
            first_ns = first_ns or seen.stamp_ns
            yield self._row(seen.stamp_ns, first_ns, seen)

    def _at_rate(self, begin_ns: int) -> Iterator[Row]:
        """`rate_hz` rows a second since all topics have come once, each of the newest frame."""
        first_ns, made = 0, 0
        before: Seen | None = None
        for seen in self._ascending():
            # Before all topics have come once, nothing is repeated.
            pause_ns = 0 if before is None else seen.stamp_ns - max(before.stamp_ns, begin_ns)
            if pause_ns > _PAUSE_MAX_S * NS_PER_S:
                raise RecordingError(
                    f"'{self.name}' has no frame of {self.skin or '/'} for {pause_ns * 1e-9:.0f} s; "
                    f"rows are repeated for at most {_PAUSE_MAX_S:.0f} s: export it with --rate 0, or record less"
                )
            self.early += seen.stamp_ns < begin_ns
            first_ns = first_ns or max(seen.stamp_ns, begin_ns)
            while before is not None and (due_ns := self._due_ns(first_ns, made)) < seen.stamp_ns:
                # The last frame before all else has a row after all: it is the newest one then.
                self.early -= not made and before.stamp_ns < begin_ns
                yield self._row(due_ns, first_ns, before)
                made += 1
            before = seen
        while before is not None and (due_ns := self._due_ns(first_ns, made)) <= before.stamp_ns:
            yield self._row(due_ns, first_ns, before)
            made += 1

    def _without_rows(self, begin_ns: int) -> str:
        """Why there is no row, though all topics have come once at `begin_ns`."""
        if self.early:
            return (
                f"all {self.early} frames are from before the first contact, contacts or joint state in it, the last "
                f"{(begin_ns - self._newest_ns) * 1e-9:.3f} s before; joint states can be left out by --joints none"
            )
        return f"its {self.backward} frames have no stamp" if self.backward else "its topic has no messages"

    def _ascending(self) -> Iterator[Seen]:
        for seen in self._frames:
            if seen.stamp_ns > self._newest_ns:
                self._newest_ns = seen.stamp_ns
                yield seen
            else:
                self.backward += 1
                self._ahead_ns = max(self._ahead_ns, self._newest_ns - seen.stamp_ns)

    def _due_ns(self, first_ns: int, number: int) -> int:
        return first_ns + round(number * NS_PER_S / self.rate_hz)

    def _row(self, stamp_ns: int, first_ns: int, seen: Seen) -> Row:
        contact_ns, contact = (seen.stamp_ns, seen.contact) if self._contact is None else self._contact.at(stamp_ns)
        contacts = seen.contacts if self._contacts is None else self._contacts.at(stamp_ns)[1]
        joints_ns, joints = (stamp_ns, None) if self._joints is None else self._joints.at(stamp_ns)
        return Row(
            stamp_ns=stamp_ns,
            time_s=(stamp_ns - first_ns) * 1e-9,
            image_age_s=(stamp_ns - seen.stamp_ns) * 1e-9,
            image=seen.image,
            contact_age_s=(stamp_ns - contact_ns) * 1e-9,
            contact=contact,
            contacts=contacts,
            joints_age_s=(stamp_ns - joints_ns) * 1e-9,
            joints=joints,
        )


@contextmanager
def open_recording(path: Path, choice: Choice) -> Iterator[Recording]:
    """Open a bag to export one skin of it.

    Images and contacts are the recorded ones (``image_raw``, ...), or are recovered from ``samples``.

    Raises
    ------
    RecordingError
        There is no bag, it does not contain what `choice` selects, or it contains several and `choice` selects none.
    ArrayError, SettingsError
        There is no such layout.
    """
    require_rosbags()
    layout(choice.layout)
    # Imported here, because it imports rosbags, which a ROS installation may lack.
    from acts_ros.bags.reading import open_bag

    with open_bag(path) as bag:
        topics = chosen_topics(bag, path, choice)
        joints = joint_track(bag, path, topics.joints, numbers_only=choice.numbers_only) if topics.joints else Joints()
        if choice.joints not in ("", NO_JOINTS) and not joints.track.stamps_ns:
            why = "; ".join(joints.notes) or "no message names joints and says something of them"
            raise RecordingError(f"'{path}' has no joint states to export on {topics.joints}: {why}")
        refused = Refused()
        found = _contacts_of(bag, path, topics, choice, refused)
        if topics.images:
            frames = recorded_frames(bag, path, topics.images)
        else:
            frames = recovered_frames(bag, path, topics.samples, topics.baseline, choice, refused)
            if found.note:
                frames = (replace(seen, contacts=None) for seen in frames)
        yield Recording(
            name=str(path),
            skin=topics.skin,
            rate_hz=choice.rate_hz,
            topic=topics.images or topics.samples,
            joint_columns=joints.columns,
            uses_layout=found.uses_layout,
            hint=_layout_hint(bag, path, topics.skin, choice.layout) if found.uses_layout else "",
            _notes=(
                *found.left_out,
                *_left_out(joints.track, topics.joints),
                *([found.note] if found.note else []),
                *joints.notes,
                bag.note or "",
            ),
            _refused=refused,
            _frames=frames,
            _contact=found.contact if found.contact.stamps_ns else None,
            _contacts=found.contacts if found.contacts.stamps_ns else None,
            _joints=joints.track if joints.track.stamps_ns else None,
        )


@dataclass(frozen=True)
class _FoundContacts:
    """The total contact and the single ones beside the frames; their tracks are empty where they are not known.

    `left_out` says which messages are left out; `uses_layout`: something is recovered, so that the layout makes a
    difference; `note` says why contacts are not known.
    """

    contact: Track[Values]
    contacts: Track[Values]
    left_out: tuple[str, ...]
    uses_layout: bool
    note: str


def _contacts_of(bag: Any, path: Path, topics: ChosenTopics, choice: Choice, refused: Refused) -> _FoundContacts:
    """The recorded contacts; beside recorded images, those that lack are found in the samples."""
    contact = contact_track(bag, path, topics.contact, numbers_only=choice.numbers_only)
    contacts = contacts_track(bag, path, topics.contacts, numbers_only=choice.numbers_only)
    left_out = (*_left_out(contact, topics.contact), *_left_out(contacts, topics.contacts))
    are_recorded = bool(contact.stamps_ns and contacts.stamps_ns)
    uses_layout = not topics.images or bool(topics.samples and not are_recorded)
    other_taxels = ""
    if uses_layout and not contacts.stamps_ns:
        other_taxels = _other_taxels(contact, topics.contact, choice.layout)
    if not (topics.images and uses_layout):
        return _FoundContacts(contact, contacts, left_out, uses_layout, other_taxels)
    found = contacts_in(
        recovered_frames(bag, path, topics.samples, topics.baseline, choice, refused),
        recorded_frames(bag, path, topics.images),
    )
    if found is None:
        note = (
            f"contacts were not recorded, and are left out: with the layout {choice.layout} {topics.samples} does not "
            f"give the images of {topics.images}; export it with --layout NAME, as the driver had it"
        )
        return _FoundContacts(contact, contacts, left_out, uses_layout, note)
    return _FoundContacts(
        contact if contact.stamps_ns else found[0],
        contacts if contacts.stamps_ns or other_taxels else found[1],
        (*left_out, *_left_out(found[0], topics.samples)),
        uses_layout,
        other_taxels,
    )


def _left_out(track: Track[Values], topic: str) -> list[str]:
    """Which messages of a topic are left out, in words."""
    words = []
    if track.backward:
        words.append(_backward(f"{counted(track.backward, 'message')} of {topic}", track.ahead_ns))
    if track.without_numbers:
        words.append(f"{counted(track.without_numbers, 'message')} of {topic} {_WITHOUT_NUMBERS}")
    return words


def _backward(which: str, ahead_ns: int, topic: str = "") -> str:
    """That some are left out because one before is newer; where it is much newer, by how much, which tells why."""
    words = f"{'of ' + topic + ', ' if topic else ''}up to {ahead_ns // NS_PER_S} s ahead"
    far = f" ({words})" if ahead_ns >= NS_PER_S else ""
    return f"{which} left out, not newer than one before{far}: was a clock set?"


def _other_taxels(contact: Track[Values], topic: str, name: str) -> str:
    """That the recorded contact is of taxels of another size than the layout's, so that what is found is misplaced."""
    sizes_m = {(patch.pitch_m, patch.row_pitch_m) for patch in layout(name).patches}
    areas_m2 = np.array(contact.values).reshape(-1, len(CONTACT_COLUMNS))[:, CONTACT_COLUMNS.index("area_m2")]
    areas_m2 = areas_m2[np.isfinite(areas_m2) & (areas_m2 > 0)]
    if len(sizes_m) != 1 or not areas_m2.size:
        return ""
    ((pitch_m, row_pitch_m),) = sizes_m
    taxels = areas_m2 / (pitch_m * row_pitch_m)
    if np.mean(np.abs(taxels - np.rint(taxels)) < _WHOLE) > 0.5:
        return ""
    return (
        f"contacts one by one were not recorded, and are left out: the areas of {topic} are not of taxels of "
        f"{1e3 * pitch_m:g} x {1e3 * row_pitch_m:g} mm, those of the layout {name}; export it with --layout NAME, as "
        "the driver had it, or with a layout file that has the pitch"
    )


def _layout_hint(bag: Any, path: Path, skin: str, layout_name: str) -> str:
    """That the skin has several patches, where its layout was not given."""
    topic = f"{skin}/regions"
    if layout_name != "square" or bag.topics().get(topic) != _REGIONS:
        return ""
    bag.check_definition(topic)
    first = next(messages(bag, path, topic, RegionContacts), None)
    if first is None or len(first.regions) < 2:
        return ""
    return (
        f"{topic} has {len(first.regions)} patches: with --layout NAME, as the driver had it, images are those of the "
        "patches, and what is recovered does not pass from one to another"
    )
