# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Number of usable cores, and their clock when a frame arrives."""

from __future__ import annotations

from collections import Counter

from acts_tools.doctor.finding import Finding, Level, unknown
from acts_tools.doctor.machine import Machine


def cores(machine: Machine) -> Finding:
    """Check the cores that this process may use, and the quota of its control group."""
    name = "cores"
    allowed = machine.cores()
    if allowed is None:
        return unknown(name, "Cpus_allowed_list in /proc/self/status")
    quota = _quota_cores(machine)
    if quota is not None and quota < len(allowed):
        text = f"{len(allowed)}, of which the control group allows {quota:.2g} cores' worth of time"
        mend = "docker run --cpus=2 ...     # or no --cpus at all; of a service: CPUQuota=200%"
        # When the quota is used up, all processes stop until the next tenth of a second, even real-time ones.
        return Finding(name, Level.LACKS if quota < 1 else Level.NOTE, text, mend if quota < 2 else "")
    if len(allowed) == 1:
        return Finding(name, Level.NOTE, "one: enough for one skin, if nothing else runs")
    return Finding(name, Level.OK, str(len(allowed)))


def _quota_cores(machine: Machine) -> float | None:
    """Quota of the control group, in cores; None where there is no limit."""
    folder = machine.control_group("")
    words = (machine.text(f"{folder}/cpu.max") or "").split() if folder is not None else []
    if len(words) == 2 and all(word.isdecimal() for word in words):
        return int(words[0]) / int(words[1])
    folder = machine.control_group("cpu")
    if folder is None:
        return None
    quota_us, period_us = (machine.number(f"{folder}/cpu.cfs_{what}_us") for what in ("quota", "period"))
    return quota_us / period_us if quota_us is not None and quota_us > 0 and period_us else None


def core_clock(machine: Machine) -> Finding:
    """Check whether the cores keep their clock rate between frames."""
    name = "core clock"
    governors: Counter[str] = Counter()
    for path in machine.found("sys/devices/system/cpu/cpu[0-9]*/cpufreq/scaling_governor"):
        governors[machine.text(str(path.relative_to(machine.root))) or "unknown"] += 1
    if not governors:
        return unknown(name, "cpufreq in /sys/devices/system/cpu, as in most virtual machines", for_realtime=True)
    if set(governors) == {"performance"}:
        return Finding(name, Level.OK, "governor performance on all cores", for_realtime=True)
    words = ", ".join(f"{governor} on {count}" for governor, count in sorted(governors.items()))
    return Finding(
        name,
        Level.NOTE,
        f"governor {words}: cores slow down between frames",
        "sudo cpupower frequency-set -g performance     # until the next start",
        for_realtime=True,
    )
