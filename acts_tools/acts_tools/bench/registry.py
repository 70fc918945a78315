# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The measurements by name.

To add one, write a module with ``measure(workbench: Workbench) -> Result`` (see `acts_tools.bench.result`), and add a
line here. It may start processes if all of them have ended when it returns.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Protocol, cast

from acts_tools.bench.result import Result
from acts_tools.bench.workbench import Workbench


class Measurement(Protocol):
    """Interface of a measurement's module."""

    def measure(self, workbench: Workbench) -> Result:
        """Measure for about ``workbench.seconds`` and return the figures."""


@dataclass(frozen=True)
class Entry:
    """One available measurement.

    Attributes
    ----------
    module : str
        Module with ``measure``.
    summary : str
        Title of its figures.
    seconds : float
        Default duration, without starting and stopping [s].
    only_by_name : bool
        Whether `acts bench` without names skips it, because it takes long.
    """

    module: str
    summary: str
    seconds: float
    only_by_name: bool = False

    def load(self) -> Measurement:
        """Import the module."""
        return cast(Measurement, importlib.import_module(self.module))


MEASUREMENTS = {
    "decode": Entry("acts_tools.bench.cases.decode", "decoding a recorded stream, M = 55", 5.0),
    "driver_cpu": Entry("acts_tools.bench.cases.driver_cpu", "CPU at 1 kHz, M = 55", 15.0),
    "latency": Entry("acts_tools.bench.cases.latency", "latency and stamps at 1 kHz, M = 55", 45.0),
    "frame_parts": Entry(
        "acts_tools.bench.cases.frame_parts", "where the time of a frame goes, M = 55, at 1 kHz", 10.0
    ),
    "frame_rate": Entry("acts_tools.bench.cases.frame_rate", "highest frame rate without loss, M = 55", 3.0),
    "recovery": Entry("acts_tools.bench.cases.recovery", "FastOMP, one frame, M = 55, 1000 atoms", 10.0),
    "train": Entry(
        "acts_tools.bench.cases.train", "learning a dictionary from 15,000 patches", 60.0, only_by_name=True
    ),
    "link": Entry("acts_tools.bench.cases.link", "a skin across a cable between two machines", 3.0, only_by_name=True),
    "view": Entry("acts_tools.bench.cases.view", "the page with four clients", 40.0, only_by_name=True),
    "view_realtime": Entry(
        "acts_tools.bench.cases.view_realtime", "the same, the skin under SCHED_FIFO", 40.0, only_by_name=True
    ),
    "soak": Entry("acts_tools.bench.cases.soak", "a long run at 1 kHz, M = 55", 600.0, only_by_name=True),
}
