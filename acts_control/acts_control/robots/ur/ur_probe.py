# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Asks a UR controller whether it is there and answers, before anything is begun that would wait for it.

That its ports accept connections says little: the system does so for a controller that stands still.
"""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Callable

from acts_core.errors import RobotError

RTDE_PORT, DASHBOARD_PORT, SCRIPT_PORT = 30004, 29999, 30003

TIMEOUT_S = 2.0
"""Longest that connecting and answering may take, for each port [s]."""

# Of RTDE: size of the packet, type, and for the request the version of the protocol.
_VERSION_REQUEST = b"\x00\x05V\x00\x02"
_VERSION_ANSWER = b"\x00\x04V"
_LONGEST_ANSWER_BYTES = 4096

# The same for the version of the controller: major, minor, bugfix, build.
_CONTROLLER_REQUEST = b"\x00\x03v"
_CONTROLLER_ANSWER = struct.Struct(">3s4I")
_CONTROLLER_HEAD = b"\x00\x13v"
_POLYSCOPE_X = 10


def probe(host: str, timeout_s: float = TIMEOUT_S) -> None:
    """Return when all ports of a controller are open, and those that ought to answer have done so.

    Raises
    ------
    RobotError
        Which port did not, and how.
    """
    _ask(host, RTDE_PORT, _VERSION_REQUEST, lambda answer: answer.startswith(_VERSION_ANSWER), timeout_s)
    # The dashboard greets with a line.
    try:
        _ask(host, DASHBOARD_PORT, b"", lambda answer: b"\n" in answer, timeout_s)
    except RobotError as error:
        major, minor = _version(host, timeout_s)
        if major < _POLYSCOPE_X:
            raise
        raise RobotError(
            f"the controller at {host} runs PolyScope X ({major}.{minor}), which has no dashboard at port "
            f"{DASHBOARD_PORT}; a UR5e with PolyScope 5 is needed"
        ) from error
    # This port says nothing of its own accord.
    _ask(host, SCRIPT_PORT, b"", lambda _answer: True, timeout_s)


def _version(host: str, timeout_s: float) -> tuple[int, int]:
    """Major and minor version of a controller; 0 where it does not tell."""

    def is_answered(answer: bytes) -> bool:
        return len(answer) - answer.find(_CONTROLLER_HEAD) >= _CONTROLLER_ANSWER.size and _CONTROLLER_HEAD in answer

    try:
        answer = _ask(host, RTDE_PORT, _VERSION_REQUEST + _CONTROLLER_REQUEST, is_answered, timeout_s)
    except RobotError:
        return 0, 0
    _, major, minor, _, _ = _CONTROLLER_ANSWER.unpack_from(answer, answer.find(_CONTROLLER_HEAD))
    return major, minor


def _ask(host: str, port: int, question: bytes, is_answered: Callable[[bytes], bool], timeout_s: float) -> bytes:
    """The answer to a question; raises `RobotError` where there is none."""
    deadline = time.monotonic() + timeout_s
    try:
        connection = socket.create_connection((host, port), timeout=timeout_s)
    except OSError as error:
        raise RobotError(
            f"no UR controller at {host} port {port} ({error.strerror or error}); is it on, and robot_ip right?"
        ) from error
    answer = b""
    with connection:
        try:
            connection.sendall(question)
            while not is_answered(answer):
                connection.settimeout(max(deadline - time.monotonic(), 1e-3))
                more = connection.recv(_LONGEST_ANSWER_BYTES)
                answer += more
                if not more or len(answer) > _LONGEST_ANSWER_BYTES:
                    raise RobotError(f"what answers at {host} port {port} is no UR controller; is robot_ip right?")
            return answer
        except TimeoutError as error:
            raise RobotError(
                f"the controller at {host} accepts connections at port {port} but has not answered for "
                f"{timeout_s:g} s; does it stand still?"
            ) from error
        except OSError as error:
            raise RobotError(f"the controller at {host} closed port {port} ({error.strerror or error})") from error
