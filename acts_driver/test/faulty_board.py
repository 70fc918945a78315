# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A virtual board that plays faults on demand, and a reader whose every published frame is checked."""

from __future__ import annotations

import json
import subprocess
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

import known_field
from ament_index_python.packages import get_package_prefix
from pty_board import wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import StreamDecoder
from acts_driver.nodes.report import DriverReport, Totals
from acts_driver.port import Reader, SerialSource
from acts_driver.stream import FrameStream

EARLY_NS = 60_000_000
"""A stamp may be early by the jump that the clock filter cannot tell from drift, and by no more."""

FRESH_NS = 10_000_000
"""A frame that was on the way for longer has waited somewhere."""


@dataclass(frozen=True)
class Event:
    """A fault began, or was over."""

    fault: str
    over: bool
    monotonic_ns: int


@dataclass(frozen=True)
class Published:
    """A frame as the driver would publish it."""

    frame: SampleFrame
    stamp_ns: int
    arrival_ns: int


class FaultyBoard:
    """The process `virtual_board` with a known field, and what it says about its faults."""

    def __init__(self, folder: Path, *options: str) -> None:
        self.link = folder / "board"
        self._control = folder / "board.control"
        program = Path(get_package_prefix("acts_firmware")) / "lib/acts_firmware/virtual_board"
        words = ["--link", self.link, "--control", self._control, "--print-status", *known_field.options(folder)]
        self.process = subprocess.Popen(
            [str(word) for word in (program, *words, *options)], stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        start = json.loads(self.process.stdout.readline())
        self.field_epoch_ns: int = start["epoch_monotonic_ns"]
        self.realtime_minus_monotonic_ns: int = start["epoch_realtime_ns"] - self.field_epoch_ns
        self.epochs_ns = [self.field_epoch_ns]
        self.events: list[Event] = []
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def _listen(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            said = json.loads(line)
            if said["epoch_monotonic_ns"] != self.epochs_ns[-1]:
                self.epochs_ns.append(said["epoch_monotonic_ns"])
            self.events.append(Event(said["fault"], said["over"], said["monotonic_ns"]))

    def inject(self, *faults: str) -> None:
        """Ask for faults now."""
        with self._control.open("w") as control:
            control.write("".join(f"{fault}\n" for fault in faults))

    def event(self, fault: str, *, over: bool) -> Event:
        """The last event of a fault, waited for."""
        found: list[Event] = []

        def look() -> bool:
            found[:] = [event for event in self.events if (event.fault, event.over) == (fault, over)]
            return bool(found)

        wait_for(look, f"the {'end' if over else 'beginning'} of {fault}")
        return found[-1]

    def to_monotonic_ns(self, realtime_ns: int) -> int:
        """A host time on the clock of the board's events."""
        return realtime_ns - self.realtime_minus_monotonic_ns

    def check(self, published: list[Published], early_ns: int | None = EARLY_NS) -> None:
        """Every frame has the right values and comes once; stamps increase and are neither early nor after the arrival.

        Where faults pile up, nobody can tell a clock that was set back from a stall: None lets stamps be early.
        """
        seen = set()
        last_stamp_ns = 0
        epochs_ns = self.epochs_ns[:]
        for one in published:
            frame = one.frame
            measured_ns = known_field.measured_at_ns(frame, self.field_epoch_ns, epochs_ns)
            assert measured_ns is not None, f"wrong samples: {frame}"
            assert measured_ns not in seen, f"published twice: {frame}"
            seen.add(measured_ns)
            # The life that the last frame was of is looked at first.
            board_us = (frame.board_us + 2**31) % 2**32 - 2**31
            epochs_ns.sort(key=lambda epoch_ns: abs(epoch_ns - (measured_ns - 1000 * board_us)))
            assert last_stamp_ns < one.stamp_ns <= one.arrival_ns
            last_stamp_ns = one.stamp_ns
            if early_ns is not None:
                is_early_ns = measured_ns + self.realtime_minus_monotonic_ns - one.stamp_ns
                assert is_early_ns < early_ns, f"stamp {is_early_ns / 1e6:.1f} ms early: {frame}"

    def __enter__(self) -> FaultyBoard:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.terminate()
        self._listener.join(20.0)
        self.process.wait(20.0)
        assert self.process.stdout is not None
        self.process.stdout.close()


class PlainDriver:
    """All of the driver but ROS: reader, decoder, stream, report."""

    def __init__(self, board: FaultyBoard, reconnect_s: float = 0.5) -> None:
        self.board = board
        self.published: list[Published] = []
        self.log: list[tuple[str, str]] = []
        self.may_take = threading.Event()
        self.may_take.set()
        self.decoder = StreamDecoder()
        self.stream = FrameStream(known_field.SIDE, known_field.SIDE)
        source = SerialSource(str(board.link))
        self.reader = Reader(
            source,
            self.decoder,
            self._take,
            reconnect_s=reconnect_s,
            log=lambda level, message: self.log.append((level, message)),
            on_reconnect=self.stream.reconnected,
        )
        self.report = DriverReport(source, self.reader, self.decoder, self.stream, (known_field.SIDE,) * 2)

    def _take(self, frames: list[SampleFrame], arrival_ns: int) -> None:
        self.may_take.wait()
        accepted = self.stream.accept(frames, arrival_ns)
        self.published += [Published(frame, stamp_ns, arrival_ns) for frame, stamp_ns in accepted]

    def totals(self) -> Totals:
        """Present counters."""
        return self.report.totals()

    def wait_for_fresh_frames(self, after_ns: int = 0, count: int = 20) -> None:
        """Until some frames were published that were measured after a time and did not wait on the way."""
        begin_ns = max(after_ns, time.monotonic_ns())

        def look() -> bool:
            fresh = [
                one
                for one in self.published[-count:]
                if self.board.to_monotonic_ns(one.stamp_ns) > begin_ns and one.arrival_ns - one.stamp_ns < FRESH_NS
            ]
            return len(fresh) == count

        wait_for(look, "frames")

    def __enter__(self) -> PlainDriver:
        self.reader.start()
        # A restart of a board that has only just been started makes no difference to its clock.
        self.wait_for_fresh_frames(after_ns=self.board.field_epoch_ns + 200_000_000)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.may_take.set()
        self.reader.stop()
