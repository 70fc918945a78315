# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Exclusive use of a folder and a robot's address: a second demonstration fails instead of disturbing the first.

Both end with the process, however it ends, and leave no files.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from acts_control.claims import ClaimedError, MachineClaim
from acts_core.errors import LaunchError


@contextmanager
def claimed_folder(out: Path) -> Iterator[None]:
    """Exclusive use of the folder for results.

    Raises
    ------
    LaunchError
        Another demonstration uses it.
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
    """Exclusive use of the address of a simulated robot, from before its start.

    Raises
    ------
    LaunchError
        Another demonstration uses it, which the message names, or it cannot be claimed.
    """
    try:
        # Not the controller's own claim of a robot: that one it takes itself, later.
        claim = MachineClaim("demo_robot", robot_ip)
    except ClaimedError as error:
        raise LaunchError(
            f"another demonstration is running with its robot at {robot_ip}: {error}; wait for it, or choose another "
            "address: --robot-ip 127.0.0.2"
        ) from None
    except OSError as error:
        raise LaunchError(f"the robot's address {robot_ip} cannot be claimed ({error.strerror})") from error
    with closing(claim):
        yield
