# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A recording shown without a graph: what the page is told of it is true of the picture that it has."""

from __future__ import annotations

import errno
import os
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from view_messages import decode
from view_recorded import DEADLINE_S, Counted, Shown, write_bag
from waiting import wait_for

from acts_core.errors import RecordingError
from acts_core.frames import SampleFrame, Scheme
from acts_driver.replay import ReplayOptions, open_recording
from acts_view.local import show as show_module
from acts_view.local.playback import Playback
from acts_view.local.sources import LocalSource
from acts_view.skin.snapshot import Frame, Sample, SkinShape


class SlowToFind(Counted):
    """Of times beyond its beginning nothing can be read until that is allowed."""

    def __init__(self) -> None:
        self.is_searched, self.is_allowed = threading.Event(), threading.Event()

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        if from_us:
            self.is_searched.set()
            assert self.is_allowed.wait(DEADLINE_S)
        yield from super().frames(from_us)


def test_where_one_has_gone_is_told_while_what_is_there_is_still_read() -> None:
    recording = SlowToFind()
    numbers: list[int] = []
    playback = Playback(recording, lambda frames: numbers.extend(one.sequence for one in frames), lambda: None)
    playback.start()
    try:
        playback.pause()
        playback.seek(1.2)
        assert recording.is_searched.wait(DEADLINE_S)
        assert playback.state.position_s == pytest.approx(1.2)
        recording.is_allowed.set()
        wait_for(lambda: 700 in numbers)
        assert playback.state.position_s == pytest.approx(1.2)
    finally:
        recording.is_allowed.set()
        playback.stop()


def test_a_bag_that_cannot_be_read_any_more_is_told_until_it_can(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_bag(tmp_path / "bag", {})
    recording = open_recording(ReplayOptions(path))
    numbers: list[int] = []
    playback = Playback(recording, lambda frames: numbers.extend(one.sequence for one in frames), lambda: None)

    def fail(_: Path) -> Iterator[Path]:
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    playback.pause()
    playback.start()
    try:
        wait_for(lambda: numbers)
        with monkeypatch.context() as disk:
            disk.setattr(Path, "iterdir", fail)
            playback.seek(0.004)
            wait_for(lambda: "cannot be read: Input/output error" in playback.state.problem)
        shutil.rmtree(path)
        write_bag(path, {}, skin="/palm")
        playback.seek(0.0)
        wait_for(lambda: "has no topic /plate/samples any more" in playback.state.problem)
        shutil.rmtree(path)
        write_bag(path, {})
        numbers.clear()
        playback.seek(0.0)
        wait_for(lambda: numbers)
        assert not playback.state.problem
    finally:
        playback.stop()


class Ending:
    """Its last frame comes, and it ends, just after it was asked for what is newest."""

    def __init__(self) -> None:
        self.may_end = threading.Event()
        self._last: list[tuple[Frame, list[Sample]]] = []
        self._is_over = False
        self.skin = SimpleNamespace(shape=SkinShape(rows=2, cols=2), newest=self._newest)

    def _newest(self) -> tuple[Frame, list[Sample]] | None:
        found = self._last.pop() if self._last else None
        if self.may_end.is_set() and not self._is_over:
            self._is_over = True
            self._last.append((Frame(stamp_s=1.0, image=np.zeros((2, 2), np.uint16)), []))
        return found

    def status(self) -> dict[str, Any]:
        return {"is_over": self._is_over}

    def start(self, _on_jump: object) -> None:
        """See `LocalSource`."""

    def stop(self) -> None:
        """See `LocalSource`."""

    def find_file(self, _name: str) -> None:
        """See `LocalSource`."""


def test_the_end_of_a_recording_is_told_after_its_last_frame(monkeypatch: pytest.MonkeyPatch) -> None:
    # With each picture.
    monkeypatch.setattr(show_module, "_STATUS_PERIOD_S", 0.0)
    source = Ending()
    shown = Shown(cast(LocalSource, source), "/press")
    seen: list[dict[str, Any]] = []
    try:
        with shown.connect() as client:

            def read() -> None:
                header, _ = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
                seen.append(header)

            wait_for(lambda: bool(seen), meanwhile=read)
            source.may_end.set()
            wait_for(lambda: bool(seen[-1].get("is_over")), meanwhile=read, state=lambda: seen[-3:])
    finally:
        shown.close()
    assert "frame" in [one["type"] for one in seen]


class Paused(Counted):
    """Ten frames, and another one a minute later."""

    length_us = 60_000_000

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        empty = np.zeros(1, np.uint16)
        for number, time_us in enumerate((*range(0, 10_000, 1000), self.length_us)):
            if time_us >= from_us:
                yield SampleFrame(number, time_us, 0, Scheme.RASTER, 32, 32, 0, empty, empty)


def test_time_passes_in_a_gap_of_a_recording_and_goes_on_from_there_after_a_hold() -> None:
    numbers: list[int] = []
    playback = Playback(Paused(), lambda frames: numbers.extend(one.sequence for one in frames), lambda: None)
    playback.start()
    try:
        wait_for(lambda: playback.state.position_s > 0.3, "time in the gap", state=lambda: playback.state)
        assert numbers == list(range(10))
        playback.pause()
        held_s = playback.state.position_s
        playback.play()
        wait_for(lambda: playback.state.position_s > held_s + 0.1, "time after the hold", state=lambda: playback.state)
        playback.seek(59.8)
        wait_for(lambda: not playback.state.is_playing)
        assert playback.state.position_s == pytest.approx(60.0)
    finally:
        playback.stop()


class Damaged(Counted):
    """What is behind half of it cannot be read."""

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        for one in super().frames(from_us):
            if one.sequence >= 500:
                raise RecordingError("message 500 is damaged")
            yield one


def test_what_is_before_the_damage_of_a_recording_is_shown_without_an_error() -> None:
    """The error stayed for good, also while the recording was played again."""
    numbers: list[int] = []
    playback = Playback(Damaged(), lambda frames: numbers.extend(one.sequence for one in frames), lambda: None)
    playback.start()
    try:
        wait_for(lambda: not playback.state.is_playing)
        assert playback.state.problem == "message 500 is damaged"
        playback.seek(0.05)
        wait_for(lambda: numbers[-1] == 50)
        assert playback.state.problem == ""
        playback.seek(1.2)
        wait_for(lambda: bool(playback.state.problem))
        playback.play()
        wait_for(lambda: not playback.state.is_playing)
        assert playback.state.problem == "message 500 is damaged"
    finally:
        playback.stop()
