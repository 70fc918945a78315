# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The virtual board as the tests start, read and stop it."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import termios
import time
import tty
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

from core_library import installed
from waiting import text_of

from acts_core.frames import SampleFrame
from acts_core.wire import DelimitedDecoder, StreamDecoder

DEADLINE_S = 30.0
_PIECE_S = 0.5


class BoardProcess:
    """A virtual board with a link in `folder`, ended at the end of the block whatever happens.

    `preload` is a library that replaces functions of the system's.
    """

    def __init__(self, folder: Path, *options: str | float | Path, preload: Path | None = None) -> None:
        folder.mkdir(exist_ok=True)
        self.link = folder / "run/board"
        self.errors = folder / "errors.txt"
        command = [installed("virtual_board"), "--link", self.link, "--print-status", *options]
        with self.errors.open("wb") as errors:
            self.process = subprocess.Popen(
                [str(word) for word in command],
                stdout=subprocess.PIPE,
                stderr=errors,
                env={**os.environ, **({"LD_PRELOAD": str(preload)} if preload else {})},
            )
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        assert line, self.errors.read_text()
        self.start: dict[str, Any] = json.loads(line)
        self._port: int | None = None
        self.decoder: DelimitedDecoder = StreamDecoder()

    def __enter__(self) -> BoardProcess:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close_port()
        self.process.kill()
        self.process.wait(DEADLINE_S)
        assert self.process.stdout is not None
        self.process.stdout.close()

    def status(self) -> dict[str, Any]:
        """The next line of --status-period-s."""
        assert self.process.stdout is not None
        return json.loads(self.process.stdout.readline())

    def leave(self, last: SampleFrame) -> None:
        """Close the port and wait until the board has noticed; `last` came through it."""
        self.close_port()
        status = self.status()
        # A line may have waited since before the port was opened.
        while status["connected"] or status["frames"] <= last.sequence:
            status = self.status()

    def open_port(self) -> int:
        self.close_port()
        self._port = os.open(self.link, os.O_RDWR | os.O_NOCTTY)
        # At once: by default it throws away what the board has sent since the port was opened.
        tty.setraw(self._port, termios.TCSANOW)
        self.decoder.reset()
        return self._port

    def close_port(self) -> None:
        if self._port is not None:
            os.close(self._port)
            self._port = None

    def read_bytes(self, *, may_end: bool = False) -> bytes:
        """Some bytes; fails where none come, and at the end of the stream unless that `may_end`."""
        assert self._port is not None
        # In pieces: where the whole machine stood still, the clock has gone on before the board can.
        for _ in range(round(DEADLINE_S / _PIECE_S)):
            ready, _, _ = select.select([self._port], [], [], _PIECE_S)
            if ready:
                break
        assert ready, f"the board is silent, its exit code {self.process.poll()}; {self.errors.read_text()}"
        read = os.read(self._port, 65536)
        assert read or may_end, f"the port is closed, the board's exit code {self.process.poll()}"
        return read

    def read_frames(self, count: int) -> list[SampleFrame]:
        """The next `count` frames or a few more."""
        frames: list[SampleFrame] = []
        while len(frames) < count:
            frames += self.decoder.feed(self.read_bytes())
        return frames

    def read_until(self, wanted: Callable[[SampleFrame], bool]) -> SampleFrame:
        """The first frame from now on that is `wanted`."""
        deadline = time.monotonic() + DEADLINE_S
        while time.monotonic() < deadline:
            for frame in self.decoder.feed(self.read_bytes()):
                if wanted(frame):
                    return frame
        raise AssertionError(f"no such frame within {DEADLINE_S} s: {text_of(wanted)}")

    def stand_still(self, for_s: float) -> tuple[int, float]:
        """Stop the process and let it go on; returns when that was, CLOCK_MONOTONIC [ns], and how long it took [s].

        Where the machine holds up this process, it takes longer than asked for.
        """
        began_ns = time.monotonic_ns()
        self.process.send_signal(signal.SIGSTOP)
        due_ns = began_ns + int(for_s * 1e9)
        while time.monotonic_ns() < due_ns:
            time.sleep(0.01)
        self.process.send_signal(signal.SIGCONT)
        ended_ns = time.monotonic_ns()
        return ended_ns, (ended_ns - began_ns) * 1e-9

    def terminate(self, number: signal.Signals = signal.SIGTERM) -> int:
        self.process.send_signal(number)
        return self.process.wait(DEADLINE_S)
