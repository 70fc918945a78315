# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Checks of shared memory, of files that dead processes left in it, and of swap."""

from __future__ import annotations

from acts_core.array import MAX_SIDE
from acts_core.words import counted
from acts_tools.doctor.finding import Finding, Level, unknown
from acts_tools.doctor.machine import Machine

_MIB = 1 << 20
# The pressure on a simulated skin is in a ring of 256 frames of doubles: 8 MiB of the largest array. While it is
# started again there are two. Nodes do not need it: they talk by UDP (`acts_ros.middleware`).
_NEEDED_BYTES = 2 * 256 * 8 * MAX_SIDE**2 + _MIB
_SHM = "dev/shm"


def shared_memory(machine: Machine) -> Finding:
    """Check whether there is shared memory for simulated processes."""
    name = "shared memory"
    folder = machine.root / _SHM
    if not folder.is_dir() or not machine.may_use(folder):
        what = "is not there" if not folder.is_dir() else "may not be written"
        mend = "sudo mount -t tmpfs -o mode=1777,size=1G tmpfs /dev/shm"
        return Finding(
            name, Level.LACKS, f"/dev/shm {what}: nothing can be simulated without a run_dir elsewhere", mend
        )
    space = machine.space(folder)
    text = f"{space.free_bytes // _MIB} of {space.total_bytes // _MIB} MiB are free in /dev/shm"
    if space.free_bytes >= _NEEDED_BYTES:
        return Finding(name, Level.OK, text)
    mend = "sudo mount -o remount,size=1G /dev/shm     # of a container: docker run --shm-size=1g"
    return Finding(name, Level.LACKS, f"{text}; a simulated skin needs up to {_NEEDED_BYTES // _MIB}", mend)


def abandoned(machine: Machine) -> Finding:
    """Check for segments of Fast DDS whose process died without removing them."""
    name = "left-over files"
    locks = machine.text("proc/locks")
    if locks is None:
        return unknown(name, "/proc/locks")
    # MAJOR:MINOR:INODE is the sixth word, or the seventh in the line of a process that waits for a lock.
    locked = {word.rsplit(":", 1)[1] for line in locks.splitlines() for word in line.split() if word.count(":") == 2}
    dead = []
    for path in machine.found(f"{_SHM}/fastdds_*_el"):
        if path.name.startswith("fastdds_port"):
            continue  # shared by several processes, and reused by the next one
        try:
            if str(path.stat().st_ino) not in locked:
                dead.append(path.name)
        except OSError:
            continue  # removed meanwhile
    if not dead:
        return Finding(name, Level.OK, "none of Fast DDS in /dev/shm")
    return Finding(
        name,
        Level.NOTE,
        f"{counted(len(dead), 'segment')} of Fast DDS in /dev/shm, of processes that are gone or in another container",
        "rm -f /dev/shm/fastdds_* /dev/shm/sem.fastdds_*     # while no ROS process runs",
    )


def swap(machine: Machine) -> Finding:
    """Check whether memory may be swapped out."""
    name = "swap"
    swaps = machine.text("proc/swaps")
    if swaps is None:
        return unknown(name, "/proc/swaps")
    if len(swaps.splitlines()) < 2:
        return Finding(name, Level.OK, "off")
    swappiness = machine.number("proc/sys/vm/swappiness")
    if swappiness is not None and swappiness <= 10:
        return Finding(name, Level.OK, f"on, used only in need (vm.swappiness {swappiness})")
    return Finding(
        name,
        Level.NOTE,
        "on: an idle process may be late by many milliseconds when its first frame arrives",
        "sudo sysctl -w vm.swappiness=10",
    )
