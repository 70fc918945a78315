"""Tells the simulated hand's world what is to happen."""

from __future__ import annotations

import json
import socket
from pathlib import Path
from typing import Any

from acts_core.errors import ActsError

_TIMEOUT_S = 5.0
_READ_BYTES = 65536


class WorldControl:
    """The control socket of `hand_world`.

    Parameters
    ----------
    path : Path
        Of the socket.

    Raises
    ------
    ActsError
        When nobody serves it.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.settimeout(_TIMEOUT_S)
        try:
            self._socket.connect(str(path))
        except OSError as error:
            self._socket.close()
            raise ActsError(f"{path}: the simulated hand is not there ({error.strerror or error})") from error

    def do(self, line: str) -> None:
        """Let something happen, see docs/simulated_hand.md.

        Raises
        ------
        ActsError
            When the world refuses, or does not answer.
        """
        answer = self._ask(line)
        if answer != "ok":
            raise ActsError(f"{line}: {answer.removeprefix('error: ')}")

    def state(self) -> dict[str, Any]:
        """What `hand_world` says of its loop, its motors and what is true."""
        return dict(json.loads(self._ask("state")))

    def close(self) -> None:
        """Leave."""
        self._socket.close()

    def _ask(self, line: str) -> str:
        answer = b""
        try:
            self._socket.sendall(line.encode() + b"\n")
            while not answer.endswith(b"\n"):
                received = self._socket.recv(_READ_BYTES)
                if not received:
                    raise ActsError(f"{self._path}: the simulated hand has gone")
                answer += received
        except OSError as error:
            raise ActsError(f"{self._path}: the simulated hand does not answer ({error})") from error
        return answer.decode().strip()
