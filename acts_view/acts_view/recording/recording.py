# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recording from the page: what skins measure, raw, to a bag of bounded size, one at a time."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from acts_core.errors import RecordingError, ViewRequestError
from acts_core.runtime import LogCallback
from acts_core.words import counted
from acts_ros.bags import require_rosbags

if TYPE_CHECKING:
    from acts_view.recording.bounded_bag import BoundedBag

_FREE_BYTES_MIN = 500_000_000
# The page lists so many; all stay on the disk.
_FILES_MAX = 8


class Feed(Protocol):
    """Fills a bag from its making until `close`."""

    @property
    def lost(self) -> int:
        """How many are known to be missing."""

    def step(self) -> None:
        """Look, once a second, for what else is to be recorded."""

    def close(self) -> None:
        """Bring nothing more."""


@dataclass
class _Present:
    """What is being recorded, since when by the monotonic clock [s]."""

    name: str
    bag: BoundedBag
    feed: Feed
    began_s: float


class Recording:
    """Records when a page asks for it; all calls but `file` on one thread.

    Parameters
    ----------
    folder : Path
        For the bags; made when the first one is.
    bytes_max : int
        A recording ends by itself at this size of its messages.
    skins : callable
        Gives the namespaces of what is shown.
    feed : callable
        Begins to fill a bag with what these measure.
    log : LogCallback
    """

    def __init__(
        self,
        folder: Path,
        bytes_max: int,
        skins: Callable[[], Sequence[str]],
        feed: Callable[[Sequence[str], BoundedBag], Feed],
        log: LogCallback,
    ) -> None:
        self._folder = folder
        self._bytes_max = bytes_max
        self._skins = skins
        self._feed = feed
        self._log = log
        self._present: _Present | None = None
        self._files: dict[str, Path] = {}
        self._note = ""

    def start(self) -> str:
        """Begin; what was begun, in words.

        Raises
        ------
        ViewRequestError
            Something is being recorded already, there is no skin, or the bag cannot be made.
        """
        if self._present is not None:
            raise ViewRequestError(f"{self._present.name} is being recorded already: stop that first")
        skins = self._skins()
        if not skins:
            raise ViewRequestError("there is no skin to record: does its driver run?")
        try:
            require_rosbags()
            # Imported here, because it is slow to import and few record.
            from acts_view.recording.bounded_bag import BoundedBag

            self._folder.mkdir(parents=True, exist_ok=True)
            self._require_space()
            name = self._free_name()
            bag = BoundedBag(self._folder / name, self._bytes_max)
        except (RecordingError, OSError) as error:
            raise ViewRequestError(f"nothing is recorded: {error}") from error
        self._present = _Present(name, bag, self._feed(skins, bag), time.monotonic())
        self._note = ""
        return f"recording {', '.join(name or '/' for name in skins)} to {bag.path}"

    def stop(self) -> str:
        """End; what was recorded, in words.

        Raises
        ------
        ViewRequestError
            Nothing is being recorded.
        """
        if self._present is None:
            raise ViewRequestError("nothing is being recorded")
        return self._end("")

    def step(self) -> None:
        """Look for more topics, write out what came, and end what is too large or cannot go on; once a second."""
        present = self._present
        if present is None:
            return
        try:
            present.feed.step()
            present.bag.flush()
            self._require_space()
        # OSError: somebody has removed the folder, or its disk is gone.
        except (RecordingError, OSError) as error:
            self._end(str(error))
            return
        if present.bag.problem:
            self._end(present.bag.problem)

    def close(self) -> None:
        """End what is being recorded."""
        if self._present is not None:
            self._end("the program ends")

    def file(self, name: str) -> Path | None:
        """The file of a finished recording; None where there is none of that name. From any thread."""
        return self._files.get(name)

    def state(self) -> dict[str, Any]:
        """What the page is told, as JSON can say it."""
        present = self._present
        told: dict[str, Any] = {
            "on": present is not None,
            "note": self._note,
            "files": [[name, _size(path)] for name, path in list(self._files.items())[: -_FILES_MAX - 1 : -1]],
        }
        if present is not None:
            told |= {
                "name": present.name,
                "elapsed_s": time.monotonic() - present.began_s,
                "bytes": present.bag.written_bytes,
                "messages": present.bag.messages,
                "lost": present.feed.lost,
            }
        return told

    def _end(self, reason: str) -> str:
        present = self._present
        assert present is not None
        self._present = None
        present.feed.close()
        try:
            present.bag.close()
        except RecordingError as error:
            reason = reason or str(error)
        elapsed_s = time.monotonic() - present.began_s
        messages, lost = present.bag.messages, present.feed.lost
        what = f"{counted(messages, 'message')} in {elapsed_s:.1f} s, {lost} lost, in {present.bag.path}"
        if not messages:
            what = f"nothing came in {elapsed_s:.1f} s; the bag {present.bag.path} is empty"
        self._files |= {f"{present.name}.mcap": path for path in present.bag.path.glob("*.mcap")}
        self._note = f"ended: {reason}; {what}" if reason else what
        self._log("info", f"recording {self._note}")
        return self._note

    def _free_name(self) -> str:
        """By the clock; with a number where that second has a recording already, as after the clock was set back."""
        name = f"touch_{datetime.now():%Y-%m-%d_%H-%M-%S}"
        numbered = (f"{name}_{number}" for number in count(2))
        return next(one for one in chain([name], numbered) if not (self._folder / one).exists())

    def _require_space(self) -> None:
        free_bytes = shutil.disk_usage(self._folder).free
        if free_bytes < _FREE_BYTES_MIN:
            raise RecordingError(
                f"{free_bytes / 1e6:.0f} MB are free on the disk of '{self._folder}'; "
                f"needed are {_FREE_BYTES_MIN / 1e6:.0f} MB"
            )


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        # Somebody has removed it; what asks for it is told so.
        return 0
