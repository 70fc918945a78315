# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Lines of pages that carry little at a time, or stand still for a while."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress

import pytest

SLOW_BYTES_S = 1_000_000
DEADLINE_S = 30.0


class SlowLine:
    """The socket of such a page, after its handshake.

    Parameters
    ----------
    port : int
        Of the server.
    origin : str
    path : str
    """

    def __init__(self, port: int, origin: str, path: str) -> None:
        self.own = socket.socket()
        self.own.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        self.own.settimeout(DEADLINE_S)
        self.own.connect(("127.0.0.1", port))
        lines = (
            f"GET {path} HTTP/1.1", f"Host: 127.0.0.1:{port}", f"Origin: {origin}", "Upgrade: websocket",
            "Connection: Upgrade", "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==", "Sec-WebSocket-Version: 13", "", "",
        )  # fmt: skip
        self.own.sendall("\r\n".join(lines).encode())
        answer = b""
        while not answer.endswith(b"\r\n\r\n"):
            answer += self.own.recv(1)
        assert b" 101 " in answer.partition(b"\r\n")[0]
        self.got = 0
        self.longest_s = 0.0
        """For how long nothing came, at most [s]."""
        self.begin()

    def begin(self) -> None:
        """From now on the line is as slow as it is."""
        self.began_s = self._last_s = time.monotonic()

    @property
    def passed_s(self) -> float:
        """Since it began [s]."""
        return time.monotonic() - self.began_s

    def read(self, bytes_max: int = 4096) -> bool:
        """Read a piece; False where the server has closed the line."""
        piece = b""
        with suppress(ConnectionError):
            piece = self.own.recv(bytes_max)
        now_s = time.monotonic()
        self.longest_s, self._last_s = max(self.longest_s, now_s - self._last_s), now_s
        self.got += len(piece)
        return bool(piece)

    def read_slowly(self, bytes_min: int, meanwhile: Callable[[], object] = lambda: None) -> bool:
        """Read so much, `SLOW_BYTES_S` at most, and do something after each piece; False as by `read`."""
        while self.got < bytes_min:
            # A busy machine makes up for a pause: the line is slow, it does not stand still. Nothing may come after it.
            while self.got < min(bytes_min, SLOW_BYTES_S * self.passed_s):
                if not self.read():
                    return False
                meanwhile()
            time.sleep(0.001)
        return True


def over_a_slow_line(
    make: Callable[[], SlowLine], read: Callable[[SlowLine], bool], limit_s: float, log: list[str]
) -> None:
    """Read something over a slow line that is not closed meanwhile.

    Begins anew, with an empty log, where this machine stood still: a server that does not run, or whose page does not,
    for as long as it waits for a page takes that for gone.

    Parameters
    ----------
    make : callable
    read : callable
        False where the line was closed.
    limit_s : float
        How long the server waits for a page that takes nothing [s].
    log : list of str
        What it has said.
    """
    for _ in range(10):
        line = make()
        is_read = read(line)
        line.own.close()
        if is_read:
            return
        assert line.longest_s > limit_s / 3, f"closed after {line.got} bytes: {log}"
        log.clear()
    pytest.fail("the machine stood still in each attempt")


class StillLine:
    """Passes on what pages and a server send, unless it stands still; nothing is lost."""

    def __init__(self, port: int) -> None:
        self._server_port = port
        self._moves = threading.Event()
        self._moves.set()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._ends: list[socket.socket] = []
        self.url = f"http://127.0.0.1:{self._listener.getsockname()[1]}/"
        threading.Thread(target=self._accept, daemon=True).start()

    def stand_still(self) -> None:
        """Pass on nothing."""
        self._moves.clear()

    def go_on(self) -> None:
        """Pass on all that has come meanwhile."""
        self._moves.set()

    def close(self) -> None:
        """Cut it."""
        self.go_on()
        for end in (self._listener, *self._ends):
            # What waits for it wakes up by that.
            with suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                page, _ = self._listener.accept()
                server = socket.create_connection(("127.0.0.1", self._server_port))
                self._ends += [page, server]
                for pair in ((page, server), (server, page)):
                    threading.Thread(target=self._pass_on, args=pair, daemon=True).start()

    def _pass_on(self, source: socket.socket, target: socket.socket) -> None:
        with suppress(OSError):
            while piece := source.recv(65536):
                self._moves.wait()
                target.sendall(piece)
            target.shutdown(socket.SHUT_WR)
