# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""CPU load of the driver at 1 kHz and M = 55, and of the virtual board that feeds it."""

from __future__ import annotations

from acts_tools.bench.result import Figure, Result
from acts_tools.bench.rigs.driver_trial import driver_trial
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.workbench import Workbench

_RATE_HZ = 1000.0


def measure(workbench: Workbench) -> Result:
    """Run both processes and read their CPU time from the kernel."""
    trial = driver_trial(workbench, _RATE_HZ, workbench.seconds, pressed(workbench.folder))
    cpu = trial.cpu_percent
    percent = cpu.get("driver")
    return Result(
        [
            Figure("driver_percent", "driver", percent, "% of one core"),
            Figure("board_percent", "virtual board", cpu.get("virtual_board"), "% of one core"),
            Figure("driver_us", "driver, per frame", percent and percent * 1e4 / _RATE_HZ, "us"),
            Figure("rate_hz", "frames published", trial.rate_hz, "frames/s"),
            Figure("frames", "frames", trial.frames),
            Figure("lost", "frames lost", trial.lost),
            Figure("overruns", "    of them dropped or skipped by the board, as it says", trial.overruns),
        ]
    )
