# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The highest frame rate without loss, M = 55, of the driver, and for comparison of readers without ROS.

The board measures much faster than real hardware, so that it is not the limit. The readers take turns, one rate at a
time, so that other load on the machine affects all of them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from acts_tools.bench.references.plain_reader import reader_trial
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.rigs.driver_trial import driver_trial
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.rigs.trial import Trial
from acts_tools.bench.search import Search
from acts_tools.bench.workbench import Workbench

START_HZ = 1000.0
MINIMUM_HZ = 125.0
MAXIMUM_HZ = 64_000.0
_RESOLUTION = 0.1
_TRIES = 3
_SAMPLE_US = "0.2"


@dataclass
class _Contender:
    """One of the compared readers, and its search."""

    key: str
    label: str
    attempt: Callable[[float], Trial]
    search: Search = field(
        default_factory=lambda: Search(START_HZ, MINIMUM_HZ, MAXIMUM_HZ, resolution=_RESOLUTION, tries=_TRIES)
    )
    failed: list[Trial] = field(default_factory=list)

    def step(self) -> None:
        """Try one rate."""
        trial = self.attempt(self.search.value)
        if not trial.holds:
            self.failed.append(trial)
        self.search.answer(trial.holds)

    @property
    def end(self) -> str:
        """Bottleneck at the lowest rate that failed."""
        reasons = [trial.bottleneck for trial in self.failed if trial.asked_hz == self.search.bad]
        return reasons[-1] if reasons else "nothing"


def measure(workbench: Workbench) -> Result:
    """Search for the driver and the other readers; each rate is tried for the measurement's time."""
    options = (*pressed(workbench.folder), "--sample-us", _SAMPLE_US)
    seconds = workbench.seconds

    def reader(decoder: str) -> Callable[[float], Trial]:
        return lambda rate_hz: reader_trial(workbench, decoder, rate_hz, seconds, options)

    driver = _Contender(
        "driver",
        "driver, decoding and publishing",
        lambda rate_hz: driver_trial(workbench, rate_hz, seconds, options),
    )
    plain = _Contender("plain", "reader without ROS", reader("stream"))
    naive = _Contender("naive", "reader without ROS, plain Python decoder", reader("naive"))
    contenders = (driver, plain, naive)
    while not all(contender.search.done for contender in contenders):
        for contender in contenders:
            if not contender.search.done:
                contender.step()
    figures = []
    for contender in contenders:
        figures.append(Figure(f"{contender.key}_hz", contender.label, contender.search.good, "frames/s"))
        figures.append(Figure(f"{contender.key}_end", "    what gave out above", contender.end))
    ratio = _ratio(driver.search.good, plain.search.good)
    return Result([*figures, Figure("ratio", "driver to reader without ROS", ratio, "times", is_ratio=True)])


def _ratio(one: float | None, other: float | None) -> float | None:
    return one / other if one and other else None
