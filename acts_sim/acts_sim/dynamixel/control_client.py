"""The other end of a `ControlSocket`: whoever tells a simulation what is to happen."""

from __future__ import annotations

import json
import socket
from pathlib import Path
from typing import Any

from acts_core.errors import ActsError

_TIMEOUT_S = 10.0
_READ_BYTES = 65536


class ControlClient:
    """A connection to a control socket.

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
            raise ActsError(f"{path}: the simulation is not there ({error.strerror or error})") from error

    def __enter__(self) -> ControlClient:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def ask(self, line: str) -> str:
        """The line of answer: ``ok``, a JSON object, or ``error: ...``.

        Raises
        ------
        ActsError
            When there is none within 10 s.
        """
        answer = b""
        try:
            self._socket.sendall(line.encode() + b"\n")
            while not answer.endswith(b"\n"):
                received = self._socket.recv(_READ_BYTES)
                if not received:
                    raise ActsError(f"{self._path}: the simulation has gone")
                answer += received
        except OSError as error:
            raise ActsError(f"{self._path}: the simulation does not answer ({error})") from error
        return answer.decode().strip()

    def do(self, line: str) -> None:
        """Let something happen.

        Raises
        ------
        ActsError
            When the simulation refuses, or does not answer.
        """
        answer = self.ask(line)
        if answer != "ok":
            raise ActsError(f"{line}: {answer.removeprefix('error: ')}")

    def state(self) -> dict[str, Any]:
        """What the simulation says of itself."""
        return dict(json.loads(self.ask("state")))

    def close(self) -> None:
        """Leave."""
        self._socket.close()


def ask_once(path: Path, line: str) -> str:
    """Ask over a connection of its own; see `ControlClient.ask`."""
    with ControlClient(path) as client:
        return client.ask(line)
