# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the frames of a skin that is shown without a graph come from: a recording, or a board at its port."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from acts_core.errors import ActsError, SettingsError, ViewRequestError
from acts_core.frames import SampleFrame
from acts_core.sampling import SamplingConfig
from acts_driver.baseline import BaselineTracker
from acts_driver.nodes.intake import Intake
from acts_driver.replay import ReplayOptions, SeekableRecording, open_recording
from acts_driver.settings import DriverSettings
from acts_recon.settings import ReconstructionSettings
from acts_view.local.local_skin import LocalSkin
from acts_view.local.playback import Playback
from acts_view.web.requests import Request

_DIAGNOSTICS_PERIOD_S = 1.0
_NS_PER_US = 1000
# Full frames are sampled as by a board that tracks what is pressed, but seldomer, and more at a time: that costs less.
_FULL_HZ = 200.0
_FULL_M = 220
_TRACKED_COUNTS = 30


class LocalSource(Protocol):
    """Where the frames of a local skin come from."""

    skin: LocalSkin

    def start(self, on_jump: Callable[[], None]) -> None:
        """Begin; `on_jump` is called where frames do not follow on those before."""

    def stop(self) -> None:
        """End for good."""

    def status(self) -> dict[str, Any]:
        """What the page is told besides the skin, several times a second."""

    def do(self, request: Request) -> str:
        """Act on what a page asks for; what came of it, in words.

        Raises
        ------
        ViewRequestError
            It cannot be done.
        """


class RecordedSource:
    """A recording, with pause and seek.

    Parameters
    ----------
    name : str
        For a person.
    recording : SeekableRecording
    layout : str
        As `acts_core.skin.layouts.layout` takes it.

    Raises
    ------
    RecordingError
        It cannot be read.
    ArrayError, SettingsError
        The layout does not fit.
    """

    def __init__(self, name: str, recording: SeekableRecording, layout: str = "square") -> None:
        first = next(recording.frames())
        self.skin = LocalSkin(ReconstructionSettings(rows=first.rows, cols=first.cols, layout=layout))
        self._name = name
        self._zero_us = first.board_us
        self._begin_ns = time.time_ns()
        self.recording = recording
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
        level, message = (2, state.problem) if state.problem else (0, "playing" if state.is_playing else "held")
        if self.skin.rejected:
            level, message = 1, f"{message}; {self.skin.rejected} frames do not fit: {self.skin.problem}"
        return {
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

    def _take(self, frames: list[SampleFrame]) -> None:
        stamped = [(one, self._begin_ns + _NS_PER_US * (one.board_us - self._zero_us)) for one in frames]
        self.skin.take(stamped, None)


class BoardSource:
    """A board at its port, read as the driver reads it.

    Parameters
    ----------
    name : str
        Of the skin, with a slash before.
    driver : DriverSettings
    layout : str
        As `acts_core.skin.layouts.layout` takes it.
    log : callable
        Takes a level and a sentence.

    Raises
    ------
    PortError
        There is no such port.
    ArrayError, SettingsError
        The layout does not fit.
    """

    def __init__(self, name: str, driver: DriverSettings, layout: str, log: Callable[[str, str], None]) -> None:
        self._name = name
        self._source = driver.make_source()
        self._source.open()
        # Now, since frames come as soon as the port is read.
        self.skin = LocalSkin(ReconstructionSettings(rows=driver.rows, cols=driver.cols, layout=layout))
        self._tracker = BaselineTracker(driver.rows, driver.cols, driver.baseline_config())
        self._intake = Intake(driver, self._source, self._take, log=log, on_board=lambda _: None)
        self._told: dict[str, Any] = {}
        self._told_s = -_DIAGNOSTICS_PERIOD_S

    def start(self, on_jump: Callable[[], None]) -> None:
        """See `LocalSource.start`."""
        self._intake.start()

    def stop(self) -> None:
        """See `LocalSource.stop`."""
        self._intake.stop()

    def status(self) -> dict[str, Any]:
        """See `LocalSource.status`."""
        now_s = time.monotonic()
        if now_s - self._told_s >= _DIAGNOSTICS_PERIOD_S:
            self._told_s = now_s
            level, message, values = self._intake.report("active", time.time_ns())
            self._told = _diagnosis("driver", level, message, values)
        return {"offers": [["tare", self._name]], "diagnostics": [self._told]}

    def do(self, request: Request) -> str:
        """See `LocalSource.do`."""
        if request.do != "tare":
            raise ViewRequestError("a board that is shown without a graph can be told tare; all else the driver can")
        try:
            baseline = self._tracker.tare()
        except ActsError as error:
            raise ViewRequestError(str(error)) from error
        self.skin.set_baseline(baseline)
        return f"tared {int(baseline.valid.sum())} of {baseline.valid.size} taxels"

    def _take(self, frames: Sequence[tuple[SampleFrame, int]], _results: object) -> None:
        self._tracker.observe(frames)
        self.skin.take(frames, time.time_ns())


def open_recorded(path: Path, namespaces: Sequence[str], layout: str) -> tuple[RecordedSource, str]:
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
    topic = f"/{namespaces[0].strip('/')}/samples" if namespaces else ""

    def sampling(rows: int, cols: int) -> SamplingConfig:
        return SamplingConfig("tracking", rows, cols, min(_FULL_M, rows * cols), threshold_counts=_TRACKED_COUNTS)

    options = ReplayOptions(
        path, topic, sampling=sampling, rate_cap_hz=_FULL_HZ, skin_map=DriverSettings(layout=layout).skin_map
    )
    recording = open_recording(options)
    found = str(getattr(recording, "topic", "")).removesuffix("/samples")
    return RecordedSource(path.name, recording, layout), found or f"/{path.stem}"


def _diagnosis(name: str, level: int, message: str, values: Mapping[str, object]) -> dict[str, Any]:
    pairs = [[key, f"{value:.6g}" if isinstance(value, float) else str(value)] for key, value in values.items()]
    return {"name": name, "level": level, "message": message, "age_s": 0.0, "values": pairs}
