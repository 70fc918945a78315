# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the frames of a skin that is shown without a graph come from: a recording, or a board at its port."""

from __future__ import annotations

import threading
import time
from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from acts_core.errors import ActsError, SettingsError, ViewRequestError
from acts_core.frames import SampleFrame
from acts_core.runtime import NS_PER_S, Pace
from acts_core.sampling import SamplingConfig
from acts_core.skin import layout as layout_of
from acts_core.words import counted
from acts_driver.baseline import Baseline, BaselineTracker
from acts_driver.board import BoardParameters
from acts_driver.nodes.intake import Intake
from acts_driver.replay import ReplayOptions, SeekableRecording, open_recording
from acts_driver.settings import DriverSettings
from acts_recon.settings import ReconstructionSettings
from acts_ros.diagnostics import ERROR, OK, WARN
from acts_view.local.local_skin import LocalSkin
from acts_view.local.playback import Playback
from acts_view.recording.recording import Feed, Recording
from acts_view.settings import ViewSettings
from acts_view.web.requests import Request
from acts_view.web.server import READ_ONLY

if TYPE_CHECKING:
    from acts_view.local.board_feed import BoardFeed
    from acts_view.recording.bounded_bag import BoundedBag

_DIAGNOSTICS_PERIOD_S = 1.0
_NS_PER_US = 1000
# Full frames are sampled as by a board that tracks what is pressed, but seldomer, and more at a time: that costs less.
_FULL_HZ = 200.0
_FULL_M = 220
_TRACKED_COUNTS = 30
# Older frames do not show the present skin [s]; as of the driver.
_FRESH_S = 0.5
# How often the baseline is looked at, and from which change on it is subtracted anew; as of the driver.
_DRIFT_PERIOD_NS = NS_PER_S
_MOVED_COUNTS = 0.5
_RECORD_BYTES_MAX = int(1e6 * ViewSettings.record_max_mb)


class LocalSource(Protocol):
    """Where the frames of a local skin come from."""

    skin: LocalSkin

    def start(self, on_jump: Callable[[], None]) -> None:
        """Begin; `on_jump` is called where frames do not follow on those before."""

    def stop(self) -> None:
        """End for good."""

    def status(self) -> dict[str, Any]:
        """What the page is told besides the skin; to be called several times a second, on the thread of `do`."""

    def do(self, request: Request) -> str:
        """Act on what a page asks for; what came of it, in words.

        Raises
        ------
        ViewRequestError
            It cannot be done.
        """

    def find_file(self, name: str) -> Path | None:
        """The file of a finished recording; None where there is none of that name. From any thread."""


class RecordedSource:
    """A recording, with pause and seek.

    Parameters
    ----------
    name : str
        For a person.
    recording : SeekableRecording
    layout : str
        As `acts_core.skin.layouts.layout` takes it.
    dead_taxels : str
        As the parameter of the reconstruction.
    with_outlines : bool
        See `LocalSkin`.
    read_baselines : callable, optional
        Gives, for rows and columns, the recorded baselines by their time, and why there are no more of them.

    Raises
    ------
    RecordingError
        It cannot be read.
    ArrayError, SettingsError
        The layout does not fit, or `dead_taxels` names no taxels.
    """

    def __init__(
        self,
        name: str,
        recording: SeekableRecording,
        layout: str = "square",
        *,
        dead_taxels: str = "",
        with_outlines: bool = False,
        read_baselines: Callable[[int, int], tuple[Sequence[Baseline], str]] = lambda _rows, _cols: ((), ""),
    ) -> None:
        first = next(recording.frames())
        settings = ReconstructionSettings(rows=first.rows, cols=first.cols, layout=layout, dead_taxels=dead_taxels)
        self.skin = LocalSkin(settings, with_outlines=with_outlines)
        self._name = name
        self._zero_us = first.board_us
        # Full frames have no time of their own, and a recording that is simulated need not.
        first_ns = getattr(recording, "first_ns", None)
        self._begin_ns = time.time_ns() if first_ns is None else first_ns
        self.recording = recording
        self._baselines, self._baseline_problem = read_baselines(first.rows, first.cols)
        self._baseline_times_us = [one.time_ns // _NS_PER_US for one in self._baselines]
        self._subtracted = -1
        self._playback: Playback | None = None

    def start(self, on_jump: Callable[[], None]) -> None:
        """See `LocalSource.start`."""

        def jump() -> None:
            self.skin.reset()
            on_jump()

        self._playback = Playback(self.recording, self._take, jump)
        self._playback.start()

    def stop(self) -> None:
        """See `LocalSource.stop`."""
        if self._playback is not None:
            self._playback.stop()

    def status(self) -> dict[str, Any]:
        """See `LocalSource.status`."""
        assert self._playback is not None
        state = self._playback.state
        level, message = (ERROR, state.problem) if state.problem else (OK, "playing" if state.is_playing else "held")
        # Of a bag whose recorder was killed.
        note = getattr(self.recording, "note", None)
        for words in (note, self._baseline_problem):
            if words and level < ERROR:
                level, message = WARN, f"{message}; {words}"
        if self.skin.rejected:
            left_out = f"{counted(self.skin.rejected, 'frame')} left out: {self.skin.problem}"
            level, message = max(level, WARN), f"{message}; {left_out}"
        return {
            "note": "A recording is shown: there is nothing to record, and no node to ask.",
            "replay": {
                "name": self._name,
                "position_s": state.position_s,
                "length_s": state.length_s,
                "playing": state.is_playing,
            },
            "diagnostics": [_diagnosis(f"recording {self._name}", level, message, {})],
        }

    def do(self, request: Request) -> str:
        """See `LocalSource.do`."""
        assert self._playback is not None
        if request.do == "play":
            self._playback.play()
        elif request.do == "pause":
            self._playback.pause()
        elif request.do == "seek" and isinstance(request.value, int | float):
            self._playback.seek(request.value)
        else:
            raise ViewRequestError("a recording can be told play, pause, and seek with a time in seconds")
        return ""

    def find_file(self, name: str) -> Path | None:
        """See `LocalSource.find_file`."""
        return None

    def _take(self, frames: list[SampleFrame]) -> None:
        for number, group in groupby(frames, self._baseline_of):
            if number != self._subtracted:
                self._subtracted = number
                self.skin.set_baseline(self._baselines[number])
            self.skin.take([(one, self._begin_ns + _NS_PER_US * (one.board_us - self._zero_us)) for one in group], None)

    def _baseline_of(self, frame: SampleFrame) -> int:
        """Number of the newest baseline at a frame's time, before the first one that; -1 without any."""
        newest = bisect_right(self._baseline_times_us, frame.board_us) - 1
        return max(newest, 0) if self._baselines else -1


class BoardSource:
    """A board at its port, read as the driver reads it.

    Parameters
    ----------
    name : str
        Of the skin, with a slash before.
    driver : DriverSettings
    layout : str
        As `acts_core.skin.layouts.layout` takes it.
    dead_taxels : str
        As the parameter of driver and reconstruction.
    log : callable
        Takes a level and a sentence.
    with_outlines : bool
        See `LocalSkin`.
    record_dir : Path or None
        Where pages may record to; None: they may not.

    Raises
    ------
    PortError
        There is no such port.
    ArrayError, SettingsError
        The layout does not fit, or `dead_taxels` names no taxels.
    """

    def __init__(
        self,
        name: str,
        driver: DriverSettings,
        layout: str,
        log: Callable[[str, str], None],
        *,
        dead_taxels: str = "",
        with_outlines: bool = False,
        record_dir: Path | None = None,
    ) -> None:
        self._name = name
        self._source = driver.make_source()
        self._source.open()
        # Now, since frames come as soon as the port is read.
        settings = ReconstructionSettings(rows=driver.rows, cols=driver.cols, layout=layout, dead_taxels=dead_taxels)
        self.skin = LocalSkin(settings, with_outlines=with_outlines)
        baseline = replace(driver.baseline_config(), dead_taxels=dead_taxels)
        self._tracker = BaselineTracker(driver.rows, driver.cols, baseline)
        self._tracker.arrange(layout_of(layout, driver.rows, driver.cols))
        self._intake = Intake(driver, self._source, self._take, log=log, on_board=lambda _: None)
        self._told: dict[str, Any] = {}
        self._told_s = -_DIAGNOSTICS_PERIOD_S
        self._pace = Pace()
        self._feed: BoardFeed | None = None
        # A tare comes on another thread than frames.
        self._subtracting = threading.Lock()
        self._subtracted: Baseline | None = None
        self._followed_ns = 0
        self._recording = (
            None if record_dir is None else Recording(record_dir, _RECORD_BYTES_MAX, lambda: [name], self._begin, log)
        )

    def start(self, on_jump: Callable[[], None]) -> None:
        """See `LocalSource.start`."""
        self._intake.start()

    def stop(self) -> None:
        """See `LocalSource.stop`."""
        self._intake.stop()
        if self._recording is not None:
            self._recording.close()

    def status(self) -> dict[str, Any]:
        """See `LocalSource.status`."""
        now_s = time.monotonic()
        if now_s - self._told_s >= _DIAGNOSTICS_PERIOD_S:
            self._told_s = now_s
            level, message, values = self._intake.report("active", time.time_ns())
            self._told = _diagnosis("driver", level, message, values)
            if self._recording is not None:
                self._recording.step()
        told = {"offers": [["tare", self._name]], "diagnostics": [self._told]}
        if self._recording is None:
            return {**told, "note": "With acts view --control this page can record, too."}
        return {**told, "recording": self._recording.state()}

    def do(self, request: Request) -> str:
        """See `LocalSource.do`."""
        if request.do == "tare":
            return self._tare()
        if request.do in ("record", "stop_recording"):
            if self._recording is None:
                raise ViewRequestError(READ_ONLY)
            return self._recording.start() if request.do == "record" else self._recording.stop()
        raise ViewRequestError(
            "a board that is shown without a graph can be told tare, record and stop_recording; all else the driver can"
        )

    def find_file(self, name: str) -> Path | None:
        """See `LocalSource.find_file`."""
        return None if self._recording is None else self._recording.file(name)

    def _tare(self) -> str:
        heard_s, now_s = self._pace.last_s, time.monotonic()
        if self._pace.is_silent(now_s, _FRESH_S):
            since = "yet" if heard_s is None else f"for {now_s - heard_s:.1f} s"
            raise ViewRequestError(f"no frames {since}: the line of the driver tells why; tare when they are back")
        try:
            with self._subtracting:
                tare = self._tracker.tare()
                self._subtract(tare.baseline)
        except ActsError as error:
            raise ViewRequestError(str(error)) from error
        return str(tare)

    def _follow_drift(self) -> None:
        with self._subtracting:
            present, before = self._tracker.present(), self._subtracted
            if present is None or before is None or np.abs(present.counts - before.counts).max() < _MOVED_COUNTS:
                return
            self._subtract(present)

    def _subtract(self, baseline: Baseline) -> None:
        self._subtracted = baseline
        self.skin.set_baseline(baseline)
        if self._feed is not None:
            self._feed.set_baseline(baseline)

    def _begin(self, _skins: Sequence[str], bag: BoundedBag) -> Feed:
        # Imported here, because it is slow to import and few record.
        from acts_view.local.board_feed import BoardFeed

        statistics = self._intake.stream.statistics
        self._feed = BoardFeed(self._name, self._tracker.present(), lambda: statistics.lost, bag)
        return self._feed

    def _take(self, frames: Sequence[tuple[SampleFrame, int]], _results: object) -> None:
        if frames:
            self._pace.step(time.monotonic(), len(frames))
        self._tracker.observe(frames)
        if frames and abs(frames[-1][1] - self._followed_ns) >= _DRIFT_PERIOD_NS:
            self._followed_ns = frames[-1][1]
            self._follow_drift()
        self.skin.take(frames, time.time_ns())
        feed = self._feed
        if feed is not None:
            feed.take(frames)


def open_recorded(
    path: Path, namespaces: Sequence[str], layout: str, *, dead_taxels: str = "", with_outlines: bool = False
) -> tuple[RecordedSource, str]:
    """A recording to show, and the name of its skin.

    Raises
    ------
    SettingsError
        Several namespaces are given.
    RecordingError, ArrayError
        It cannot be shown.
    """
    if len(namespaces) > 1:
        raise SettingsError(f"a recording is shown one skin at a time; {', '.join(namespaces)} are {len(namespaces)}")
    # Of the root namespace nothing is before the topic's slash.
    topic = f"/{namespaces[0].strip('/')}/samples".replace("//", "/") if namespaces else ""

    def sampling(rows: int, cols: int) -> SamplingConfig:
        return SamplingConfig("tracking", rows, cols, min(_FULL_M, rows * cols), threshold_counts=_TRACKED_COUNTS)

    skin_map = BoardParameters(layout=layout, dead_taxels=dead_taxels).skin_map
    options = ReplayOptions(path, topic, sampling=sampling, rate_cap_hz=_FULL_HZ, skin_map=skin_map)
    recording = open_recording(options)
    found_topic = str(getattr(recording, "topic", ""))
    found = found_topic.removesuffix("/samples")

    def read(rows: int, cols: int) -> tuple[Sequence[Baseline], str]:
        if not found_topic:
            return (), ""
        # Late: an npz file needs nothing of ROS.
        from acts_view.local.bag_baselines import read_baselines

        return read_baselines(path, found_topic, rows, cols)

    source = RecordedSource(
        path.name, recording, layout, dead_taxels=dead_taxels, with_outlines=with_outlines, read_baselines=read
    )
    return source, found or f"/{path.stem}"


def _diagnosis(name: str, level: int, message: str, values: Mapping[str, object]) -> dict[str, Any]:
    pairs = [[key, f"{value:.6g}" if isinstance(value, float) else str(value)] for key, value in values.items()]
    return {"name": name, "level": level, "message": message, "age_s": 0.0, "values": pairs}
