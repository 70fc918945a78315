# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Result of a check: its level, a sentence, and a command that corrects it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum


class Level(IntEnum):
    """Severity of a finding; larger is worse."""

    OK = 0
    UNKNOWN = 1
    """The state is unknown, for example hidden by a container."""
    NOTE = 2
    """1 kHz works, but single frames are late, or something else is worse."""
    LACKS = 3
    """1 kHz, or what was requested, does not work."""


@dataclass(frozen=True)
class Finding:
    """The result of one check.

    Attributes
    ----------
    name : str
        Name of the check.
    level : Level
        Severity.
    text : str
        The finding, for a person.
    mend : str
        Commands that correct it, one per line; empty where there is nothing to correct.
    for_realtime : bool
        Whether real-time scheduling depends on it; with ``--realtime`` a note then counts as lacking.
    """

    name: str
    level: Level
    text: str
    mend: str = ""
    for_realtime: bool = False


def unknown(name: str, what: str, *, for_realtime: bool = False) -> Finding:
    """A finding about something that the machine does not show.

    Parameters
    ----------
    name : str
        Name of the check.
    what : str
        What is missing, such as a file.
    for_realtime : bool
        As in `Finding`.
    """
    return Finding(name, Level.UNKNOWN, f"unknown: there is no {what}", for_realtime=for_realtime)
