# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which topics of a bag are exported."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_core.names import full_name
from acts_ros.bags.skin_topics import IMAGE, SAMPLES, baseline_topic
from acts_tools.bags.messages import is_in_counts

_JOINTS = "sensor_msgs/msg/JointState"
NO_JOINTS = "none"
"""In place of a topic of joint states: none is exported."""


@dataclass(frozen=True)
class Choice:
    """What to export.

    Attributes
    ----------
    skin : str
        Its namespace; empty for the only one in the bag.
    joints : str
        Topic of joint states; empty for the only one in the bag, if there is one, `NO_JOINTS` for none.
    layout : str
        Layout of the skin, for recovery from samples.
    dead_taxels : str
        Its broken taxels, as the parameter of the reconstruction; likewise.
    rate_hz : float
        Rows per second; 0: one row per frame.
    numbers_only : bool
        Whether values of joints that are no numbers are left out; see `joint_track`.
    """

    skin: str = ""
    joints: str = ""
    layout: str = "square"
    dead_taxels: str = ""
    rate_hz: float = 0.0
    numbers_only: bool = False


@dataclass(frozen=True)
class ChosenTopics:
    """What a bag has of one skin, and of the joints: full names; empty or None where it has no such topic."""

    skin: str
    images: str
    samples: str
    baseline: str | None
    contact: str
    contacts: str
    joints: str


def chosen_topics(bag: Any, path: Path, choice: Choice) -> ChosenTopics:
    """What a bag has of what is chosen.

    Parameters
    ----------
    bag : acts_ros.bags.reading.Bag
        Open.
    path : Path
        Path of the bag, for errors.
    choice : Choice

    Raises
    ------
    RecordingError
        The bag does not contain what `choice` selects, or contains several and `choice` selects none.
    """
    types = bag.topics()
    skin = _skin(bag, path, types, choice.skin)
    images, samples, contact, contacts = (f"{skin}/{name}" for name in ("image_raw", "samples", "contact", "contacts"))
    baseline = baseline_topic(types, samples)
    joints = _joint_topic(path, types, choice.joints)
    for topic in (images, samples, baseline or "", contact, contacts, joints):
        bag.check_definition(topic)
    if types.get(images) != IMAGE or not is_in_counts(bag, path, images):
        images = ""
    if types.get(samples) != SAMPLES:
        samples = ""
    return ChosenTopics(skin, images, samples, baseline, contact, contacts, joints)


def _skin(bag: Any, path: Path, types: dict[str, str], wanted: str) -> str:
    found = sorted(
        {
            topic.rsplit("/", 1)[0]
            for topic, kind in types.items()
            if (kind == SAMPLES and topic.endswith("/samples"))
            or (kind == IMAGE and topic.endswith("/image_raw") and is_in_counts(bag, path, topic))
        }
    )
    found = [name for name in found if not (name.endswith("/view") and name.removesuffix("/view") in found)]
    # Of a skin in the root namespace it is empty, before the slash of its topics.
    listed = ", ".join(name or "/" for name in found)
    if wanted:
        name = f"/{wanted.strip('/')}".removesuffix("/")
        if name not in found:
            raise RecordingError(f"'{path}' has no skin {name or '/'}; it has {listed or 'none'}")
        return name
    if len(found) != 1:
        raise RecordingError(
            f"'{path}' has the skins {listed}: choose one with --skin"
            if found
            else f"'{path}' has no skin: needed is a topic image_raw (sensor_msgs/msg/Image, mono16) or samples "
            f"({SAMPLES}); it has {', '.join(sorted(types)) or 'none'}{f'; {bag.note}' if bag.note else ''}"
        )
    return found[0]


def _joint_topic(path: Path, types: dict[str, str], wanted: str) -> str:
    found = sorted(topic for topic, kind in types.items() if kind == _JOINTS)
    if wanted == NO_JOINTS:
        return ""
    if wanted:
        topic = full_name(wanted)
        if topic not in found:
            raise RecordingError(f"'{path}' has no joint states on {topic}; it has {', '.join(found) or 'none'}")
        return topic
    if len(found) > 1:
        raise RecordingError(f"'{path}' has joint states on {', '.join(found)}: choose one with --joints, or none")
    return found[0] if found else ""
