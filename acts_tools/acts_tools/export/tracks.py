# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Time series in a bag: the total contact, single contacts, joint states."""

from __future__ import annotations

from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from operator import attrgetter
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import JointState

from acts_core.errors import RecordingError
from acts_core.words import counted
from acts_msgs.msg import Contact, Contacts
from acts_recon.contacts import Contact as FoundContact
from acts_recon.contacts import TrackedBlob
from acts_ros.messages import ns_of
from acts_tools.bags.messages import messages

Values = NDArray[np.float64]
Names = tuple[str, ...]

CONTACT_COLUMNS = ("in_contact", "x_m", "y_m", "force_n", "peak_counts", "area_m2", "spread_m")
"""Columns of the total contact; 0 without contact."""

CONTACTS_COLUMNS = ("number", "x_m", "y_m", "vx_m_s", "vy_m_s", "force_n", "peak_counts", "area_m2", "spread_m")
"""Columns of each contact."""

_JOINT_VALUES = ("position", "velocity", "effort")

_T = TypeVar("_T")


@dataclass
class Track(Generic[_T]):
    """Values over time.

    Attributes
    ----------
    stamps_ns : list of int
        Ascending, ROS time [ns].
    values : list
        Value at each stamp.
    backward : int
        Number of messages left out: not newer than one before.
    ahead_ns : int
        How far the one before was ahead of those, at most [ns].
    without_numbers : int
        Number of messages left out: with a value that is no number.
    """

    stamps_ns: list[int] = field(default_factory=list)
    values: list[_T] = field(default_factory=list)
    backward: int = 0
    ahead_ns: int = 0
    without_numbers: int = 0

    def add(self, stamp_ns: int, value: _T) -> None:
        """Append, unless it is not newer than the last."""
        if not self.stamps_ns or stamp_ns > self.stamps_ns[-1]:
            self.stamps_ns.append(stamp_ns)
            self.values.append(value)
        else:
            self.leave_out(self.stamps_ns[-1] - stamp_ns)

    def leave_out(self, ahead_ns: int) -> None:
        """Count a message that is not newer than one before, which is so far ahead [ns]."""
        self.backward += 1
        self.ahead_ns = max(self.ahead_ns, ahead_ns)

    def at(self, stamp_ns: int) -> tuple[int, _T]:
        """Stamp and value of the newest at or before a time, which must exist."""
        place = bisect_right(self.stamps_ns, stamp_ns) - 1
        return self.stamps_ns[place], self.values[place]


def contact_track(bag: Any, path: Path, topic: str, *, numbers_only: bool) -> Track[Values]:
    """The recorded contact, with `CONTACT_COLUMNS`; `numbers_only`: without messages that hold NaN or infinity."""
    return _track(bag, path, topic, Contact, contact_of_message, numbers_only)


def contacts_track(bag: Any, path: Path, topic: str, *, numbers_only: bool) -> Track[Values]:
    """The recorded contacts: arrays [shape=(n, 9)] with `CONTACTS_COLUMNS`; `numbers_only` as of `contact_track`."""
    return _track(bag, path, topic, Contacts, _contacts_of_message, numbers_only)


@dataclass(frozen=True)
class Joints:
    """Recorded joint states.

    Attributes
    ----------
    columns : tuple of str
        Such as ``knuckle.position``, of the joints in their order; velocity and effort where they are told.
    track : Track
        From the message on with which every joint has been told.
    notes : tuple of str
        For the user: what of them was left out.
    """

    columns: tuple[str, ...] = ()
    track: Track[Values] = field(default_factory=Track[Values])
    notes: tuple[str, ...] = ()


class _Told(NamedTuple):
    """What a joint state says: stamp [ns], names of the values and the values."""

    stamp_ns: int
    names: Names
    values: Values


def joint_track(bag: Any, path: Path, topic: str, *, numbers_only: bool) -> Joints:
    """Recorded joint states.

    Publishers may share the topic; what each of them says of its joints is kept until it says more.

    Parameters
    ----------
    bag : acts_ros.bags.reading.Bag
        Open.
    path : Path
        Of the bag, for errors.
    topic : str
    numbers_only : bool
        Whether NaN and infinity, by which drivers say that they do not know a value, count as not told, as does what
        is too large for single precision.

    Raises
    ------
    RecordingError
        A message has no stamp, so that nobody knows what it belongs to.
    """
    shared: dict[Names, Names] = {}
    told: list[_Told] = []
    unfit = 0
    for message in messages(bag, path, topic, JointState):
        told.append(_told(message, shared))
        unfit += not told[-1].names or _has_unfit(message)
    unstamped = sum(not one.stamp_ns for one in told)
    if unstamped:
        raise RecordingError(
            f"'{path}': {unstamped} of {len(told)} joint states on {topic} have no stamp, so that it is not known when "
            "they were; leave them out with --joints none"
        )
    notes = []
    if unfit:
        words = counted(unfit, "joint state has", "joint states have")
        notes.append(f"{topic}: {words} not as many numbers as names; such numbers are left out")
    repeated = {names for names in {one.names for one in told} if len(set(names)) < len(names)}
    if repeated:
        count = sum(one.names in repeated for one in told)
        words = counted(count, "joint state names", "joint states name")
        notes.append(f"{topic}: {words} a joint twice; what is said of it last is exported")
    if numbers_only:
        told, more = _numbers_of(told, shared)
        notes += more
    columns = tuple(dict.fromkeys(name for names in dict.fromkeys(one.names for one in told) for name in names))
    newest: dict[str, float] = {}
    # Of each column: publishers that share the topic may overtake one another.
    newest_ns: dict[str, int] = {}
    track: Track[Values] = Track()
    for stamp_ns, names, values in told:
        before_ns = max((newest_ns.get(name, 0) for name in names), default=0)
        if names and stamp_ns <= before_ns:
            track.leave_out(before_ns - stamp_ns)
            continue
        newest.update(zip(names, values.tolist(), strict=True))
        newest_ns.update(dict.fromkeys(names, stamp_ns))
        if not columns or len(newest) < len(columns):
            continue
        state = np.array([newest[name] for name in columns])
        if track.stamps_ns and stamp_ns <= track.stamps_ns[-1]:
            track.values[-1] = state
        else:
            track.add(stamp_ns, state)
    return Joints(columns, track, tuple(notes)) if track.stamps_ns else Joints(notes=tuple(notes))


def _numbers_of(told: list[_Told], shared: dict[Names, Names]) -> tuple[list[_Told], list[str]]:
    """Joint states without what is no number, and what has gone with that, in words."""
    numbers: list[_Told] = []
    unknown: Counter[str] = Counter()
    for one in told:
        is_number = _are_numbers(one.values)
        if is_number.all():
            numbers.append(one)
            continue
        unknown.update({name for name, is_known in zip(one.names, is_number, strict=True) if not is_known})
        names = tuple(name for name, is_known in zip(one.names, is_number, strict=True) if is_known)
        numbers.append(_Told(one.stamp_ns, shared.setdefault(names, names), one.values[is_number]))
    kept = {name for names in {one.names for one in numbers} for name in names}
    never = [name for name in unknown if name not in kept]
    now_and_then = [name for name in unknown if name in kept]
    notes = []
    if never:
        notes.append(f"{', '.join(never)} left out: no number of {'it' if len(never) == 1 else 'them'} was published")
    if now_and_then:
        count = sum(unknown[name] for name in now_and_then)
        words = counted(
            count,
            "value of a joint is no number, and the one before it stays",
            "values of joints are no numbers, and those before them stay",
        )
        notes.append(f"{words}: {', '.join(now_and_then)}")
    return numbers, notes


# The columns of a contact and of each one as a recovered image has them, and as messages do.
_CONTACT, _EACH = attrgetter(*CONTACT_COLUMNS), attrgetter(*CONTACTS_COLUMNS)
_CONTACT_MESSAGE = attrgetter(
    "in_contact", "centre_of_pressure.x", "centre_of_pressure.y", "force", "peak", "area", "spread"
)
_EACH_MESSAGE = attrgetter(
    "number", "position.x", "position.y", "velocity.x", "velocity.y", "force", "peak", "area", "spread"
)


def contact_found(found: FoundContact) -> Values:
    """Of a recovered image, with `CONTACT_COLUMNS`."""
    return np.array(_CONTACT(found), dtype=np.float64)


def contacts_found(blobs: Sequence[TrackedBlob]) -> Values:
    """Of a recovered image: an array [shape=(n, 9)] with `CONTACTS_COLUMNS`."""
    return np.array([_EACH(blob) for blob in blobs], dtype=np.float64).reshape(-1, len(CONTACTS_COLUMNS))


def contact_of_message(message: Contact) -> Values:
    """A recorded one, with `CONTACT_COLUMNS`."""
    return np.array(_CONTACT_MESSAGE(message), dtype=np.float64)


def _contacts_of_message(message: Contacts) -> Values:
    rows = [_EACH_MESSAGE(one) for one in message.contacts]
    return np.array(rows, dtype=np.float64).reshape(-1, len(CONTACTS_COLUMNS))


def _has_unfit(message: JointState) -> bool:
    """Whether something is said of another number of joints than are named; nothing at all may be."""
    return any(len(getattr(message, kind)) not in (0, len(message.name)) for kind in _JOINT_VALUES)


def _told(message: JointState, shared: dict[Names, Names]) -> _Told:
    """What a message says; recordings of hours have millions of them, and few names."""
    names: list[str] = []
    values: list[float] = []
    for kind in _JOINT_VALUES:
        numbers = getattr(message, kind)
        if len(numbers) == len(message.name):
            names += [f"{name}.{kind}" for name in message.name]
            values += numbers
    key = tuple(names)
    return _Told(ns_of(message.header.stamp), shared.setdefault(key, key), np.array(values, dtype=np.float64))


def _are_numbers(values: Values) -> NDArray[np.bool_]:
    """Whether each value is a number in single precision, too."""
    are_numbers: NDArray[np.bool_] = np.abs(values) <= np.finfo(np.float32).max
    return are_numbers


def _track(
    bag: Any, path: Path, topic: str, kind: type, read: Callable[[Any], Values], numbers_only: bool
) -> Track[Values]:
    track: Track[Values] = Track()
    read_messages: Iterator[Any] = messages(bag, path, topic, kind)
    for message in read_messages:
        values = read(message)
        if numbers_only and not _are_numbers(values).all():
            track.without_numbers += 1
        else:
            track.add(ns_of(message.header.stamp), values)
    return track
