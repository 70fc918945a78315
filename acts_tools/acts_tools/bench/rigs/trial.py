"""One run of a reader on the virtual board: what it read, what it lost, what CPU it took."""

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
    """What a reader says of itself, again and again.

    Attributes
    ----------
    time_s : float
        When, on the reader's clock [s].
    frames, lost, overruns : int
        As in ``docs/driver.md``, since it began.
    """

    time_s: float
    frames: int
    lost: int
    overruns: int


@dataclass(frozen=True)
class Trial:
    """Outcome of a run; counts are those of the time that was measured.

    Attributes
    ----------
    asked_hz : float
        Frame rate of the board.
    rate_hz : float
        Frames read per second.
    frames, lost, overruns : int
        Frames read; numbers missing between them; frames the board dropped because they were not read, or skipped
        because it was late itself.
    cpu_percent : dict of str to float
        Load of every process [% of one core].
    machine_percent : float
        Load of the whole machine, others included [% of one core].
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
        """Whether nothing was lost and the reader kept up with the board, and the board with its clock."""
        return self.lost == 0 and self.overruns == 0 and self.rate_hz >= _RATE_SHARE * self.asked_hz

    @property
    def bottleneck(self) -> str:
        """What gave out when it did not hold: a process that fills a core, all cores together, or neither of them."""
        busiest, percent = max(self.cpu_percent.items(), key=lambda item: item[1], default=("", 0.0))
        if percent >= _SATURATED_PERCENT:
            return f"{busiest} fills a core"
        if self.machine_percent >= _SATURATED_PERCENT * (os.cpu_count() or 1):
            others_percent = max(0.0, self.machine_percent - sum(self.cpu_percent.values()))
            return f"all cores are busy, others take {others_percent:.0f} % of one"
        return f"stalls ({busiest} at {percent:.0f} % of a core)"


def observe(statuses: Iterator[Status], asked_hz: float, seconds: float) -> Trial:
    """Follow a reader, from about a second after its first frames on: until then losses of its start are reported.

    Parameters
    ----------
    statuses : iterator of Status
        Waits for the next one. Never ends.
    asked_hz : float
        Frame rate of the board.
    seconds : float
        How long to measure; the first loss ends it early [s].
    """
    begin = next(status for status in statuses if status.frames > 0)
    first = next(status for status in statuses if status.time_s >= begin.time_s + _SETTLE_S)
    meter = LoadMeter(os.getpid(), "bench")
    meter.start()
    machine = BusyMeter()
    for status in statuses:
        elapsed_s = status.time_s - first.time_s
        trial = Trial(
            asked_hz,
            (status.frames - first.frames) / max(elapsed_s, 1e-9),
            status.frames - first.frames,
            status.lost - first.lost,
            status.overruns - first.overruns,
            meter.percent(),
            machine.percent(),
        )
        # A report that came a little early does not cost another one.
        if elapsed_s >= _EARLY_SHARE * seconds or trial.lost or trial.overruns:
            return trial
    raise AssertionError("a reader's reports do not end")
