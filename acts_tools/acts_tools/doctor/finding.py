"""What a check says: how bad, in one sentence, and the command that mends it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum


class Level(IntEnum):
    """How much a finding matters; the larger the worse."""

    OK = 0
    UNKNOWN = 1
    """It cannot be told here, as in a container that hides it."""
    NOTE = 2
    """1 kHz works without it; single frames come late, or something beside 1 kHz is worse."""
    LACKS = 3
    """It keeps 1 kHz, or what was asked for, from working."""


@dataclass(frozen=True)
class Finding:
    """The outcome of one check.

    Attributes
    ----------
    name : str
        What was looked at.
    level : Level
        See there.
    text : str
        What was found, for a person.
    mend : str
        Command, or commands line by line; empty where there is nothing to mend.
    for_realtime : bool
        Whether real-time scheduling depends on it: a note then counts as lacking where real time is asked for.
    """

    name: str
    level: Level
    text: str
    mend: str = ""
    for_realtime: bool = False


def unknown(name: str, what: str, *, for_realtime: bool = False) -> Finding:
    """A finding for what the machine does not show.

    Parameters
    ----------
    name : str
        As of the check.
    what : str
        What is missing, such as a file.
    for_realtime : bool
        As of `Finding`.
    """
    return Finding(name, Level.UNKNOWN, f"cannot be told here: there is no {what}", for_realtime=for_realtime)
