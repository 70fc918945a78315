# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One run of a reader on the virtual board: frames read and lost, and CPU load."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field

from acts_tools.bench.machine import BusyMeter
from acts_tools.process_load import LoadMeter

_RATE_SHARE = 0.98
_EARLY_SHARE = 0.9
_SETTLE_S = 0.9
_SATURATED_PERCENT = 90.0


@dataclass(frozen=True)
class Status:
    """A status that a reader reports regularly.

    Attributes
    ----------
    time_s : float
        Time of the report, on the reader's clock [s].
    frames, lost, overruns : int
        Counts since its start, as in ``docs/driver.md``.
    """

    time_s: float
    frames: int
    lost: int
    overruns: int


@dataclass(frozen=True)
class Trial:
    """Result of a run; counts are those of the measured time.

    Attributes
    ----------
    asked_hz : float
        Frame rate of the board.
    rate_hz : float
        Frames read per second.
    frames, lost, overruns : int
        Frames read; frame numbers missing between them; frames that the board dropped because they were not read, or
        skipped because it was late.
    cpu_percent : dict of str to float
        Load of every process [% of one core].
    machine_percent : float
        Load of the whole machine, including other programs [% of one core].
    """

    asked_hz: float
    rate_hz: float
    frames: int
    lost: int
    overruns: int
    cpu_percent: dict[str, float] = field(default_factory=dict)
    machine_percent: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether no frame was lost, the reader kept up with the board, and the board with its clock."""
        return self.lost == 0 and self.overruns == 0 and self.rate_hz >= _RATE_SHARE * self.asked_hz

    @property
    def bottleneck(self) -> str:
        """Cause of a failure: a process that fills a core, all cores together, or neither."""
        busiest, percent = max(self.cpu_percent.items(), key=lambda item: item[1], default=("", 0.0))
        if percent >= _SATURATED_PERCENT:
            return f"{busiest} fills a core"
        if self.machine_percent >= _SATURATED_PERCENT * (os.cpu_count() or 1):
            others_percent = max(0.0, self.machine_percent - sum(self.cpu_percent.values()))
            return f"all cores are busy, others take {others_percent:.0f} % of one"
        return f"stalls ({busiest} at {percent:.0f} % of a core)"


def observe(statuses: Iterator[Status], asked_hz: float, seconds: float) -> Trial:
    """Observe a reader, starting a second after its first frames, because losses at its start are reported until then.

    Parameters
    ----------
    statuses : iterator of Status
        Blocks until the next status; never ends.
    asked_hz : float
        Frame rate of the board.
    seconds : float
        Duration of the measurement; the first loss ends it early [s].
    """
    begin = next(status for status in statuses if status.frames > 0)
    first = next(status for status in statuses if status.time_s >= begin.time_s + _SETTLE_S)
    meter = LoadMeter(os.getpid(), "bench")
    meter.start()
    machine = BusyMeter()
    for status in statuses:
        elapsed_s = status.time_s - first.time_s
        lost, overruns = status.lost - first.lost, status.overruns - first.overruns
        # Tolerance for a report that came slightly early.
        if elapsed_s >= _EARLY_SHARE * seconds or lost or overruns:
            frames = status.frames - first.frames
            rate_hz = frames / max(elapsed_s, 1e-9)
            return Trial(asked_hz, rate_hz, frames, lost, overruns, meter.percent(), machine.percent())
    raise AssertionError("a reader's reports do not end")
