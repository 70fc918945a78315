# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings for tests, and a page that shows one without a graph."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from rclpy.serialization import serialize_message
from waiting import wait_for
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from acts_core.frames import SampleFrame, Scheme
from acts_core.stop_signals import StopSignals
from acts_msgs.msg import Baseline, TactileSamples
from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter
from acts_view.local.playback import Playback
from acts_view.local.show import show
from acts_view.local.sources import LocalSource

DEADLINE_S = 30.0
ROW, COL = 10, 20


def write_frames(path: Path, count: int = 4, rate_hz: float = 2.0) -> Path:
    """Full frames with a press at one taxel and its neighbours, harder in each."""
    frames = np.zeros((count, 32, 32), np.uint16)
    for number in range(count):
        frames[number, ROW - 1 : ROW + 2, COL - 1 : COL + 2] = min(300 + 100 * number, 900)
    np.savez(path, frames=frames, rate_hz=rate_hz)
    return path


class Counted:
    """A second of frames at 1 kHz whose numbers tell their time, with a gap of half a second in it."""

    length_us = 1_499_000

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        empty = np.zeros(1, np.uint16)
        for number in range(1000):
            time_us = 1000 * number + (500_000 if number >= 100 else 0)
            if time_us >= from_us:
                yield SampleFrame(number, 7_000_000 + time_us, 0, Scheme.RASTER, 32, 32, 0, empty, empty)


class Played:
    def __init__(self, recording: Counted) -> None:
        self.numbers: list[int] = []
        self.jumps: list[int] = []
        self.began_s = 0.0
        self.playback = Playback(recording, self._take, lambda: self.jumps.append(len(self.numbers)))

    def _take(self, frames: list[SampleFrame]) -> None:
        self.numbers += [one.sequence for one in frames]


def write_bag(path: Path, baselines: dict[int, list[int]], skin: str = "/plate") -> Path:
    """Frames of 4 x 4 taxels, one a second, 300 counts everywhere; and baselines of so many or less, by their time."""
    bag, definitions = BagWriter(path), Definitions()
    samples, base = (
        bag.add_topic(f"{skin}/{name}", kind, *definitions.describe(kind), [])
        for name, kind in (("samples", "acts_msgs/msg/TactileSamples"), ("baseline", "acts_msgs/msg/Baseline"))
    )
    for time_s, counts in baselines.items():
        size = len(counts)
        message = Baseline(rows=size // 4, cols=4, source=Baseline.SOURCE_TARE)
        message.baseline, message.noise, message.valid = [float(one) for one in counts], [2.0] * size, [True] * size
        message.header.stamp.sec = time_s
        bag.write(base, serialize_message(message))
    for time_s in range(10, 15):
        frame = TactileSamples(rows=4, cols=4, sequence=time_s, indices=list(range(16)), counts=[300] * 16)
        frame.header.stamp.sec = time_s
        bag.write(samples, serialize_message(frame))
    bag.close()
    return path


class Shown:
    """A local page and what it was told."""

    def __init__(self, source: LocalSource, name: str) -> None:
        self.addresses: list[str] = []
        self._signals = _Signals()
        self._thread = threading.Thread(
            target=show,
            args=(source, name),
            kwargs={"host": "127.0.0.1", "port": 0, "signals": self._signals, "on_address": self.addresses.append},
        )
        self._thread.start()
        wait_for(lambda: bool(self.addresses))

    @property
    def url(self) -> str:
        """Where the page is."""
        return self.addresses[0]

    def connect(self) -> ClientConnection:
        origin = self.addresses[0].rstrip("/")
        return connect(origin.replace("http", "ws") + "/stream", origin=Origin(origin), compression=None)

    def close(self) -> None:
        self._signals.stop()
        self._thread.join()


class _Signals(StopSignals):
    """None of a process: the test is not one."""

    def __init__(self) -> None:
        self._callbacks: list[Callable[[], None]] = []

    def on_stop(self, callback: Callable[[], None]) -> None:
        self._callbacks.append(callback)

    def stop(self) -> None:
        for callback in self._callbacks:
            callback()
