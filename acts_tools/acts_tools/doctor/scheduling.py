# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Checks of real-time scheduling: whether it is allowed, and how well it works."""

from __future__ import annotations

import os
import re
import resource

from acts_tools.doctor.finding import Finding, Level, unknown
from acts_tools.doctor.machine import Machine

_CAP_SYS_NICE = 23
_CAP_IPC_LOCK = 14
_LIMITS_FILE = "/etc/security/limits.d/99-realtime.conf"
_JOIN = "sudo groupadd --force realtime && sudo usermod -a -G realtime $USER"
_FIRST_WITH_SLICES = (6, 12)
_DEFAULT_SHARE_US = 950_000
_REALTIME_POLICIES = (str(os.SCHED_FIFO), str(os.SCHED_RR))


def rtprio_limit(machine: Machine) -> Finding:
    """Check the highest real-time priority of an ordinary user."""
    name = "rtprio limit"
    if machine.has_capability(_CAP_SYS_NICE):
        return Finding(name, Level.OK, "any priority: this process has the right CAP_SYS_NICE", for_realtime=True)
    soft, hard = machine.limit(resource.RLIMIT_RTPRIO)
    if soft in (resource.RLIM_INFINITY, 99):
        return Finding(name, Level.OK, "any priority", for_realtime=True)
    if hard == resource.RLIM_INFINITY or hard > soft:
        allowed = "any" if hard == resource.RLIM_INFINITY else hard
        text = f"priorities up to {soft} are allowed in this shell, up to {allowed} may be"
        return Finding(name, Level.NOTE, text, f"ulimit -r {99 if allowed == 'any' else hard}", for_realtime=True)
    if soft > 0:
        return Finding(name, Level.OK, f"priorities up to {soft}; a higher realtime_priority is refused")
    return Finding(
        name,
        Level.NOTE,
        "real-time scheduling is not allowed: realtime_priority has no effect",
        _limits("rtprio 99"),
        for_realtime=True,
    )


def locked_memory(machine: Machine) -> Finding:
    """Check whether memory can be locked."""
    name = "locked memory"
    if machine.has_capability(_CAP_IPC_LOCK):
        return Finding(name, Level.OK, "no limit: this process has the right CAP_IPC_LOCK", for_realtime=True)
    soft, _ = machine.limit(resource.RLIMIT_MEMLOCK)
    if soft == resource.RLIM_INFINITY:
        return Finding(name, Level.OK, "no limit", for_realtime=True)
    return Finding(
        name,
        Level.NOTE,
        f"at most {soft // 1024} KiB: real-time processes do without, and may be swapped out",
        _limits("memlock unlimited"),
        for_realtime=True,
    )


def kernel(machine: Machine) -> Finding:
    """Check whether the kernel is fully preemptible."""
    name = "kernel"
    version = machine.text("proc/version")
    if machine.text("sys/kernel/realtime") == "1" or "PREEMPT_RT" in (version or ""):
        return Finding(name, Level.OK, "PREEMPT_RT")
    if version is None:
        return unknown(name, "/proc/version")
    # Real-time scheduling works with any kernel, so this is never lacking.
    return Finding(
        name,
        Level.NOTE,
        "not PREEMPT_RT: sometimes a frame is late by a millisecond or more, whatever its priority",
        "sudo pro enable realtime-kernel          # Ubuntu\nsudo apt install linux-image-rt-amd64     # Debian",
    )


def time_slices(machine: Machine) -> Finding:
    """Check whether a thread without a priority can ask the kernel to run soon."""
    name = "time slices"
    version = re.match(r"Linux version (\d+)\.(\d+)", machine.text("proc/version") or "")
    if version is None:
        return unknown(name, "/proc/version")
    if tuple(map(int, version.groups())) >= _FIRST_WITH_SLICES:
        return Finding(
            name, Level.OK, "ACTS has short ones, so that it runs soon beside busy programs, even without a priority"
        )
    wanted = ".".join(map(str, _FIRST_WITH_SLICES))
    return Finding(
        name,
        Level.NOTE,
        f"kernels before {wanted} have none to choose: ACTS waits longer for busy programs, unless it has a priority",
        "sudo apt install linux-generic-hwe-$(lsb_release -rs)     # Ubuntu 24.04, or later",
    )


def realtime_share(machine: Machine) -> Finding:
    """Check the share of a core that real-time threads may use."""
    name = "real-time share"
    folder = machine.control_group("cpu")
    if folder is not None and machine.number(f"{folder}/cpu.rt_runtime_us") == 0:
        return Finding(
            name,
            Level.NOTE,
            "the control group of this process has no real-time share: SCHED_FIFO is refused",
            f"echo {_DEFAULT_SHARE_US} | sudo tee /{folder}/cpu.rt_runtime_us",
            for_realtime=True,
        )
    share_us = machine.number("proc/sys/kernel/sched_rt_runtime_us")
    period_us = machine.number("proc/sys/kernel/sched_rt_period_us") or 1_000_000
    mend = f"sudo sysctl -w kernel.sched_rt_runtime_us={_DEFAULT_SHARE_US}"
    if share_us is None:
        return unknown(name, "/proc/sys/kernel/sched_rt_runtime_us", for_realtime=True)
    if share_us < 0:
        return Finding(name, Level.NOTE, "the kernel's guard is off: real-time threads may take whole cores", mend)
    if share_us < period_us // 2:
        text = f"real-time threads are held after {100 * share_us / period_us:.0f} % of a core"
        return Finding(name, Level.NOTE, text, mend, for_realtime=True)
    text = f"{100 * share_us / period_us:.0f} % of a core, the rest is left to others"
    return Finding(name, Level.OK, text, for_realtime=True)


def kernel_workers(machine: Machine) -> Finding:
    """Check whether the kernel's threads that hand on what a serial port received run before ordinary programs."""
    name = "kernel workers"
    stats = [machine.text(str(path.relative_to(machine.root))) or "" for path in machine.found("proc/[0-9]*/stat")]
    # The second field is the name in brackets, the 41st the scheduling policy (proc_pid_stat(5)).
    policies = [stat.rpartition(")")[2].split()[38] for stat in stats if "(kworker/u" in stat]
    if not policies:
        return unknown(name, "the threads kworker/u* in /proc")
    if all(policy in _REALTIME_POLICIES for policy in policies):
        return Finding(name, Level.OK, "in real time: what a serial port received is handed on at once")
    return Finding(
        name,
        Level.NOTE,
        "ordinary threads hand on what a serial port received: on a busy machine late by some ms, whatever "
        "realtime_priority is",
        "for id in $(pgrep kworker/u); do sudo chrt -f -p 1 $id; done     # again now and then: others come",
    )


def _limits(item: str) -> str:
    lines = "".join(f"@realtime {kind} {item}\\n" for kind in ("soft", "hard"))
    return f"{_JOIN}\nprintf '{lines}' | sudo tee -a {_LIMITS_FILE}     # then log out and in again"
