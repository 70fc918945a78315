# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The machine of a measurement, and its load by other programs."""

from __future__ import annotations

import os
import platform
import resource
import time

import psutil


def describe() -> dict[str, object]:
    """Cores, architecture and versions of the machine."""
    return {
        "cores": os.cpu_count(),
        "architecture": platform.machine(),
        "system": platform.system(),
        "python": platform.python_version(),
        "ros": os.environ.get("ROS_DISTRO", "none"),
    }


class BusyMeter:
    """CPU time of all processes, since construction.

    Taken from the processes' own clocks, because the kernel's counters of busy cores go by ticks: they count programs
    that run a thousand times a second and shortly up to twice. Processes outside of a container are not seen in it.
    """

    def __init__(self) -> None:
        self._begin_s = time.monotonic()
        self._busy_s = self._now_s()

    def percent(self) -> float:
        """Load of the machine [% of one core]. A call takes some milliseconds."""
        return (self._now_s() - self._busy_s) / max(time.monotonic() - self._begin_s, 1e-9) * 100

    def _now_s(self) -> float:
        # A process that ends meanwhile is among its parent's children.
        processes = (process.info["cpu_times"] for process in psutil.process_iter(["cpu_times"]))
        return sum(sum(times[:4]) for times in processes if times) + getattr(psutil.cpu_times(), "steal", 0.0)


class OthersMeter(BusyMeter):
    """CPU time of all processes but this one and its children, since construction.

    Time that a hypervisor gave to other machines is included.
    """

    def percent(self) -> float:
        """Load by others [% of one core]. Children are excluded once they have ended and were waited for."""
        return max(0.0, super().percent())

    def _now_s(self) -> float:
        return super()._now_s() - _own_s()


def _own_s() -> float:
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)
