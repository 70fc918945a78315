"""What a demonstration has for itself alone while it runs, so that a second one is told instead of spoiling the first.

Both claims end with the process, however it ends, and leave nothing behind.
"""

from __future__ import annotations

import fcntl
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from acts_core.errors import LaunchError


@contextmanager
def claimed_folder(out: Path) -> Iterator[None]:
    """The folder that results are written to.

    Raises
    ------
    LaunchError
        Another demonstration has it.
    """
    descriptor = os.open(out, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise LaunchError(
                f"another demonstration is running and writes to the folder {out}; wait for it, or choose another "
                "folder and another robot: --out out/second --robot-ip 127.0.0.2"
            ) from None
        yield
    finally:
        os.close(descriptor)


@contextmanager
def claimed_robot(robot_ip: str) -> Iterator[None]:
    """The address of a simulated robot, from before it is there.

    Raises
    ------
    LaunchError
        Another demonstration has it.
    """
    # A name that exists in the system's memory only, and in this network only.
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as name:
        try:
            name.bind(f"\0acts_demo_robot_{robot_ip}")
        except OSError:
            raise LaunchError(
                f"another demonstration is running with its robot at {robot_ip}; wait for it, or choose another "
                "address: --robot-ip 127.0.0.2"
            ) from None
        yield
