# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A robot as this process's own among the programs of this machine, whoever runs them."""

from __future__ import annotations

import errno
import socket
import struct

from acts_core.errors import RobotError
from acts_core.runtime import process_name

_CREDENTIALS = struct.Struct("3i")


class RobotTakenError(RobotError):
    """Another program of this machine controls the robot; a person has to end it."""


class RobotClaim:
    """Taken from now on, until `close` or the process's end, however it ends.

    A socket of an abstract name stands for the robot: Linux gives a name to one process of a machine (or container with
    a network of its own), tells the others who has it, and leaves nothing behind. The robot itself refuses a second
    program too, but cannot say who the first one is, and takes the second as soon as the first has gone.

    Parameters
    ----------
    address : str
        Of the robot.

    Raises
    ------
    RobotTakenError
        With the process that has it.
    """

    def __init__(self, address: str) -> None:
        name = b"\0acts/robot/" + _numeric(address).encode()
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self._socket.bind(name)
            self._socket.listen()
        except OSError as error:
            self._socket.close()
            if error.errno != errno.EADDRINUSE:
                raise RobotError(f"robot {address} cannot be claimed ({error.strerror})") from error
            raise RobotTakenError(
                f"robot {address} is controlled by {_holder(name)}; end that program, then call ~/start"
            ) from error

    def close(self) -> None:
        """Give it up. May be called again."""
        self._socket.close()


def _numeric(address: str) -> str:
    """One name for a robot, whichever of its names was given."""
    try:
        return socket.gethostbyname(address)
    except OSError:
        return address


def _holder(name: bytes) -> str:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as question:
        question.setblocking(False)
        try:
            question.connect(name)
            data = question.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
        except OSError:
            # It has just gone, or does not answer.
            return process_name(0)
        pid, _user, _group = _CREDENTIALS.unpack(data)
        return process_name(pid)
