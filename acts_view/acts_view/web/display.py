# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is to be shown: the newest state of everything, from which every client is served at its own pace. Knows no ROS.

There is no queue. A client that is slow misses states in between; it gets the newest when it can take it, with all of
the history that is new to it. So no client costs memory, or holds up another.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any

from acts_core.array import MAX_SIDE
from acts_view.skin.history import History, Place
from acts_view.skin.snapshot import Frame, Sample, SkinShape, describe_skin, encode_frame
from acts_view.web.codec import encode


class _Skin:
    def __init__(self, name: str) -> None:
        self.history = History()
        self.frame = Frame()
        self.frames = 0
        self.shape: SkinShape | None = None
        self.description = b""
        self._name = name
        self._heard_s: float | None = None
        self._made: tuple[tuple[int, Place, float | None], bytes, Place] | None = None
        self._is_told = False
        self._describe(SkinShape())

    def describe(self, shape: SkinShape, *, is_begun_anew: bool) -> None:
        """Take what the skin is like."""
        self._describe(shape, is_told=True, is_begun_anew=is_begun_anew)

    def _describe(self, shape: SkinShape, *, is_told: bool = False, is_begun_anew: bool = False) -> None:
        if is_begun_anew or (shape, is_told) != (self.shape, self._is_told):
            self.shape, self._is_told = shape, is_told
            description = encode({**describe_skin(self._name, shape), "told": is_told})
            # What is as it was need not be sent again.
            self.description = self.description if description == self.description else description

    def take(self, frame: Frame, samples: Sequence[Sample]) -> None:
        """Take the newest state, and what has come since the last one."""
        for sample in samples:
            self.history.add(*sample)
        # Else only what controls the skin has said something.
        if samples or frame.image is not self.frame.image:
            # A picture that is taken away is as if nothing had come.
            self._heard_s = time.monotonic() if samples or frame.image is not None else None
        if not self._is_told and frame.image is not None:
            # As of a bag that is played without the node that knows: of the size of its image.
            rows, cols = frame.image.shape
            if max(rows, cols) <= MAX_SIDE:
                self._describe(SkinShape(rows=rows, cols=cols))
        self.frame = frame
        self.frames += 1

    def message(self, place: Place) -> tuple[bytes, Place]:
        """The newest frame for who has read so far; clients that keep up share it."""
        silent_s = None if self._heard_s is None else round(time.monotonic() - self._heard_s, 1)
        key = self.frames, place, silent_s
        if self._made is None or self._made[0] != key:
            rows, after = self.history.since(place)
            self._made = key, encode_frame(self._name, self.frame, rows, after.life, silent_s), after
        return self._made[1:]


class Display:
    """The newest state of all skins and of the diagnostics. All of it is for one thread, that of the event loop."""

    def __init__(self) -> None:
        self._skins: dict[str, _Skin] = {}
        self._status: dict[str, Any] | None = None

    def show_frame(self, name: str, frame: Frame, samples: Sequence[Sample]) -> None:
        """Take the newest state of a skin, and what has come since the last one."""
        self._skin(name).take(frame, samples)

    def forget(self, name: str) -> None:
        """What comes of a skin does not follow on what has come."""
        self._skin(name).history.forget()

    def show_shape(self, name: str, shape: SkinShape, *, is_begun_anew: bool = False) -> None:
        """Take what a skin is like; one that is begun anew may have other files than before, of the same names."""
        self._skin(name).describe(shape, is_begun_anew=is_begun_anew)

    def show_status(self, status: dict[str, Any]) -> None:
        """Take what is said of everything together, as JSON can say it; often enough, it tells a client we live."""
        self._status = status

    def reader(self) -> Reader:
        """A place to read from, for one client."""
        return Reader(self)

    def _skin(self, name: str) -> _Skin:
        if name not in self._skins:
            self._skins[name] = _Skin(name)
        return self._skins[name]


class Reader:
    """How far one client has got."""

    def __init__(self, display: Display) -> None:
        self._display = display
        self._described: dict[str, bytes] = {}
        self._frames: dict[str, int] = {}
        self._places: dict[str, Place] = {}
        self._status: dict[str, Any] | None = None

    def news(self) -> Iterator[bytes]:
        """The messages of what is newest and was not read yet; each is made when it is asked for."""
        display = self._display
        if display._status is not None and self._status is not display._status:
            self._status = display._status
            # The clock as it is now, also of a status that is old: by it a page tells when it has asked for something.
            yield encode({"type": "status", "clock_s": time.monotonic(), **self._status})
        for name, skin in list(display._skins.items()):
            if self._described.get(name) is not skin.description:
                self._described[name] = skin.description
                yield skin.description
            if self._frames.get(name, 0) != skin.frames:
                self._frames[name] = skin.frames
                message, self._places[name] = skin.message(self._places.get(name, Place()))
                yield message
