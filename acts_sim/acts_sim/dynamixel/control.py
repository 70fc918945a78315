# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A socket for text commands while the simulation runs: one line in, one line of reply."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from acts_core.errors import RobotError
from acts_sim.shared import LineSession

# At once, of a burst of lines: the simulation stands still while they are answered, a fifth of a millisecond each.
_READ_BYTES = 64
_MAX_CLIENTS = 16


class _Client:
    """A client: its socket, its session, and what it has not taken of its replies yet."""

    def __init__(self, connected: socket.socket, session: LineSession) -> None:
        self.socket = connected
        self.session = session
        self.pending = b""


class ControlSocket:
    """Listens on a Unix socket; never blocks.

    Parameters
    ----------
    path : Path
        Path of the socket; a stale one is replaced.
    answer : callable
        Function from a line without its end to the line of reply.

    Raises
    ------
    RobotError
        When the socket cannot be made, or another program listens there.
    """

    def __init__(self, path: Path, answer: Callable[[str], str]) -> None:
        self._path = path
        self._answer = answer
        self._clients: dict[int, _Client] = {}
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.is_socket():
                _require_stale(path)
                path.unlink()
            self._listener.bind(str(path))
            path.chmod(0o600)
            self._made = path.lstat()
        except OSError as error:
            self._listener.close()
            raise RobotError(f"{path}: the control socket cannot be made ({error}); give another path") from error
        except RobotError:
            self._listener.close()
            raise
        self._listener.listen()
        self._listener.setblocking(False)

    def descriptors(self) -> list[int]:
        """File descriptors to wait for; a client that has not taken all of its replies is not asked for more lines."""
        return [self._listener.fileno(), *(number for number, client in self._clients.items() if not client.pending)]

    def serve(self, descriptor: int) -> None:
        """Read from a descriptor that has input."""
        if descriptor == self._listener.fileno():
            self._accept()
        elif descriptor in self._clients:
            self._read(descriptor)

    def send_rest(self) -> None:
        """Send on what clients have not taken of their replies; to be called again and again."""
        for descriptor in [number for number, client in self._clients.items() if client.pending]:
            self._send(descriptor)

    def close(self) -> None:
        """Close all descriptors and remove the socket's file, unless another program has replaced it."""
        for client in self._clients.values():
            client.socket.close()
        self._clients.clear()
        self._listener.close()
        with suppress(FileNotFoundError):
            if os.path.samestat(self._path.lstat(), self._made):
                self._path.unlink()

    def _accept(self) -> None:
        with suppress(BlockingIOError):
            connected, _ = self._listener.accept()
            if len(self._clients) >= _MAX_CLIENTS:
                connected.close()
                return
            connected.setblocking(False)
            self._clients[connected.fileno()] = _Client(connected, LineSession(self._answer))

    def _read(self, descriptor: int) -> None:
        client = self._clients[descriptor]
        try:
            data = client.socket.recv(_READ_BYTES)
        except OSError:
            data = b""
        if not data:
            self._drop(descriptor)
            return
        client.pending = client.session.receive(data)
        self._send(descriptor)

    def _send(self, descriptor: int) -> None:
        client = self._clients[descriptor]
        try:
            sent = client.socket.send(client.pending)
        except BlockingIOError:
            return
        except OSError:
            self._drop(descriptor)
            return
        client.pending = client.pending[sent:]

    def _drop(self, descriptor: int) -> None:
        self._clients.pop(descriptor).socket.close()


def _require_stale(path: Path) -> None:
    """Refuse a socket on which a program listens: it would hear nothing any more."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as question:
        question.setblocking(False)
        try:
            question.connect(str(path))
        except ConnectionRefusedError:
            return
        except BlockingIOError:
            pass  # it listens, and has much to do
    raise RobotError(f"{path}: another program listens there; end it, or give another path")
