# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Statuses received on the diagnostics topics, as a table, as JSON, and as an exit code. Does not depend on ROS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

from acts_skins.overview.aggregate import Status

WORDS = ("OK", "WARN", "ERROR", "STALE")
"""Names of the levels, by their number; the exit code of a level is its number."""

SILENT_AFTER_S = 3.0
"""Nodes report once a second: one whose last report is older than this has fallen silent [s]."""


class Statuses:
    """The newest status of every name, for each topic.

    Parameters
    ----------
    topics : sequence of str
        Topics in the order of the output.
    """

    def __init__(self, topics: Sequence[str]) -> None:
        self._heard: dict[str, dict[str, Status]] = {topic: {} for topic in topics}
        self._heard_s: dict[tuple[str, str], float] = {}

    def take(self, topic: str, status: Status, now_s: float = 0.0) -> None:
        """Store a status that was received on a topic, and when [s]."""
        self._heard[topic][status.name] = status
        self._heard_s[topic, status.name] = now_s

    def tell_silent(self, now_s: float) -> None:
        """Take a status for stale that came more than `SILENT_AFTER_S` before now, and say so in its message."""
        for topic, heard in self._heard.items():
            for name, status in heard.items():
                age_s = now_s - self._heard_s[topic, name]
                if age_s > SILENT_AFTER_S:
                    message = f"silent for {age_s:.1f} s; before: {WORDS[_level(status)]}, {status.message}"
                    heard[name] = replace(status, level=WORDS.index("STALE"), message=message)

    @property
    def is_empty(self) -> bool:
        """Whether no status was received."""
        return not any(self._heard.values())

    @property
    def worst(self) -> int:
        """The worst level, 0 to 3; 0 without any status."""
        return max((_level(status) for heard in self._heard.values() for status in heard.values()), default=0)

    def lines(self, *, with_values: bool) -> Iterator[str]:
        """A table for a person: level, name and message, followed by the named values."""
        for topic, heard in self._heard.items():
            if not heard:
                continue
            yield topic
            width = max(map(len, heard))
            for name in sorted(heard):
                status = heard[name]
                about = f" [{status.hardware_id}]" if status.hardware_id else ""
                yield f"  {WORDS[_level(status)]:5}  {name:{width}}  {status.message}{about}".rstrip()
                key_width = max(map(len, status.values), default=0)
                if with_values:
                    yield from (
                        f"           {key:{key_width}}  {value}".rstrip() for key, value in status.values.items()
                    )

    def as_json(self) -> dict[str, Any]:
        """The same for programs: a list of statuses for each topic with any."""
        return {
            topic: [
                {
                    "name": name,
                    "level": WORDS[_level(status)],
                    "message": status.message,
                    "hardware_id": status.hardware_id,
                    "values": dict(status.values),
                }
                for name, status in sorted(heard.items())
            ]
            for topic, heard in self._heard.items()
            if heard
        }


def _level(status: Status) -> int:
    """The level; an invalid one counts as an error."""
    return status.level if 0 <= status.level < len(WORDS) else WORDS.index("ERROR")
