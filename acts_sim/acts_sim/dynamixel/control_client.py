# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Client of a `ControlSocket`, to control a simulation."""

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
        Path of the socket.

    Raises
    ------
    ActsError
        When no simulation serves it.
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
        """Send a line and return the reply: ``ok``, a JSON object, or ``error: ...``.

        Raises
        ------
        ActsError
            When there is no reply within 10 s, or was none to an earlier line: that one may still come.
        """
        if self._socket.fileno() < 0:
            raise ActsError(f"{self._path}: the simulation has not answered before; connect to it anew")
        answer = b""
        try:
            self._socket.sendall(line.encode() + b"\n")
            while not answer.endswith(b"\n"):
                received = self._socket.recv(_READ_BYTES)
                if not received:
                    raise ActsError(f"{self._path}: the simulation has gone")
                answer += received
        except OSError as error:
            self.close()
            raise ActsError(f"{self._path}: the simulation does not answer ({error})") from error
        return answer.decode().strip()

    def do(self, line: str) -> None:
        """Send a command and check its reply.

        Raises
        ------
        ActsError
            When the simulation refuses the command or does not reply.
        """
        answer = self.ask(line)
        if answer != "ok":
            raise ActsError(f"{line}: {answer.removeprefix('error: ')}")

    def state(self) -> dict[str, Any]:
        """The reply to ``state``."""
        return dict(json.loads(self.ask("state")))

    def close(self) -> None:
        """Leave."""
        self._socket.close()
