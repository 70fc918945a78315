# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process that makes two machines and the cable between them: `python3 -m acts_tools.two_machines.cable`.

Each machine is a process that waits in a network and a mount namespace of its own, with one end of the cable, an
address, its own shared memory, and its own machine id, by which the middleware distinguishes machines. All of it ends
with the process. The first line on standard output names the two processes, or the error. Every line on standard input
is `Conditions` in JSON; the reply is the `Traffic` of both ends.

Frames pass through this process instead of netem, because some kernels lack netem, and here the seed determines which
frames are lost.
"""

from __future__ import annotations

import ctypes
import fcntl
import json
import os
import random
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import uuid
from collections import deque
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from acts_ros.processes.children import leave_with_parent
from acts_tools.two_machines.conditions import Conditions, Traffic

INTERFACE = "cable0"
ADDRESSES = ("10.77.0.1", "10.77.0.2")
"""Addresses of the near and the far machine, which exist in the namespaces only."""

_CLONE_NEWNET, _CLONE_NEWNS = 0x40000000, 0x00020000
_TUNSETIFF, _IFF_TAP, _IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
_FRAME_BYTES = 65536
_MACHINE_ID = Path("/etc/machine-id")
# Queue length of a network card; a full queue drops frames.
_QUEUE_FRAMES = 20_000


@dataclass
class _End:
    """One end of the cable, and the frames on their way from there."""

    tap: int
    rng: random.Random
    traffic: Traffic = field(default_factory=Traffic)
    under_way: deque[tuple[float, bytes]] = field(default_factory=deque)


class Cable:
    """Carries frames between two ends.

    Parameters
    ----------
    taps : sequence of int
        File descriptors of the two interfaces, not blocking.
    """

    def __init__(self, taps: Sequence[int]) -> None:
        self._ends = [_End(tap, random.Random(seed)) for seed, tap in enumerate(taps)]
        self.conditions = Conditions()

    @property
    def traffic(self) -> list[Traffic]:
        """Traffic of the near and the far end."""
        return [end.traffic for end in self._ends]

    def carry(self) -> float | None:
        """Read available frames and write those that are due; return the time to the next one [s], None without one."""
        now_s = time.monotonic()
        for end in self._ends:
            self._take_in(end, now_s)
        for end, other in zip(self._ends, reversed(self._ends), strict=True):
            while end.under_way and end.under_way[0][0] <= now_s:
                _hand_out(end, other.tap)
        due_s = [end.under_way[0][0] for end in self._ends if end.under_way]
        return max(0.0, min(due_s) - time.monotonic()) if due_s else None

    def _take_in(self, end: _End, now_s: float) -> None:
        conditions, traffic = self.conditions, end.traffic
        while True:
            try:
                frame = os.read(end.tap, _FRAME_BYTES)
            except BlockingIOError:
                return
            traffic.frames += 1
            traffic.sent_bytes += len(frame)
            if conditions.cut or end.rng.random() < conditions.loss or len(end.under_way) >= _QUEUE_FRAMES:
                traffic.dropped += 1
            else:
                end.under_way.append((now_s + conditions.delay_s, frame))


def _hand_out(end: _End, tap: int) -> None:
    _, frame = end.under_way.popleft()
    try:
        os.write(tap, frame)
    except BlockingIOError:
        end.traffic.dropped += 1


def _make_machine(address: str) -> tuple[int, int]:
    """Start a process in namespaces of its own; return its process id and its end of the cable."""
    ours, theirs = socket.socketpair()
    stay_alive_with_us = leave_with_parent(os.getpid())
    pid = os.fork()
    if pid == 0:
        stay_alive_with_us()
        try:
            tap = _settle_in(address)
            socket.send_fds(theirs, [b"tap"], [tap])
            os.close(tap)
        except (OSError, subprocess.CalledProcessError) as error:
            theirs.send(_in_words(error).encode())
            os._exit(1)
        # This process must not keep the cable's standard input and output open.
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.pause()
        os._exit(0)
    theirs.close()
    words, descriptors, _, _ = socket.recv_fds(ours, 1024, 1)
    ours.close()
    if not descriptors:
        raise OSError(words.decode())
    return pid, descriptors[0]


def _settle_in(address: str) -> int:
    """Make this process a machine; return the descriptor of its interface."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.unshare(_CLONE_NEWNET | _CLONE_NEWNS) != 0:
        raise OSError(ctypes.get_errno(), "a network namespace cannot be made")
    tap = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tap, _TUNSETIFF, struct.pack("16sH22x", INTERFACE.encode(), _IFF_TAP | _IFF_NO_PI))
    commands = [
        ["ip", "link", "set", "lo", "up"],
        ["ip", "address", "add", f"{address}/24", "dev", INTERFACE],
        ["ip", "link", "set", INTERFACE, "up"],
        # Keep changes of mounts in this namespace.
        ["mount", "--make-rprivate", "/"],
        ["mount", "-t", "tmpfs", "tmpfs", "/dev/shm"],
    ]
    for command in commands:
        subprocess.run(command, check=True, capture_output=True, text=True)
    if _MACHINE_ID.exists():
        with tempfile.NamedTemporaryFile("w", dir="/dev/shm", delete=False) as file:
            file.write(f"{uuid.uuid4().hex}\n")
        subprocess.run(["mount", "--bind", file.name, _MACHINE_ID], check=True, capture_output=True, text=True)
    return tap


def _in_words(error: OSError | subprocess.CalledProcessError) -> str:
    if isinstance(error, subprocess.CalledProcessError):
        return f"`{' '.join(map(str, error.cmd))}`: {str(error.stderr).strip()}"
    return str(error)


def main() -> int:
    """Make the cable, serve it until standard input ends, and return the exit code."""
    try:
        machines = [_make_machine(address) for address in ADDRESSES]
    except OSError as error:
        print(json.dumps({"error": _in_words(error)}), flush=True)
        return 1
    cable = Cable([tap for _, tap in machines])
    print(json.dumps({"pids": [pid for pid, _ in machines]}), flush=True)
    inputs = [sys.stdin.fileno(), *(tap for _, tap in machines)]
    wait_s: float | None = None
    while True:
        ready, _, _ = select.select(inputs, [], [], wait_s)
        if sys.stdin.fileno() in ready:
            line = sys.stdin.readline()
            if not line:
                return 0
            # Frames from before a change still get the old conditions.
            cable.carry()
            cable.conditions = Conditions(**json.loads(line))
            print(json.dumps([asdict(traffic) for traffic in cable.traffic]), flush=True)
        wait_s = cable.carry()


if __name__ == "__main__":
    sys.exit(main())
