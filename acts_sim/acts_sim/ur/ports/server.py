# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The sockets and the clock: one thread, one `select` loop, a cycle every 2 ms.

`select` and not `epoll`: Python rounds the timeout of the latter to whole milliseconds.
"""

from __future__ import annotations

import errno
import math
import select
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from acts_core.errors import ActsError, PacketError, RobotError, SettingsError
from acts_sim.ur import CYCLE_HZ

LONGEST_STAY_S = 4.0
"""Time that clients have at most to end their motion and disconnect, when the server is stopped after them [s]."""

MAX_CONNECTIONS = 200
"""Largest number of connections per port; `select` cannot watch descriptors from 1024 on."""

_CYCLE_NS = 1_000_000_000 // CYCLE_HZ

# After a longer pause of the process the missed cycles are skipped: the robot's time has stood still.
_MAX_CATCH_UP_CYCLES = 50

# Bytes read per cycle: 680 servo commands, far more than a client without pauses can send.
_READ_BYTES = 65536

# Bytes read at once of a client whose requests are answered at once: that must not delay the next cycle.
_REQUEST_BYTES = 512

# About a tenth of a second of data packages, so that a client that was delayed soon gets present data again.
_SEND_BUFFER_BYTES = 65536

# A client with more unsent data than this has stopped reading.
_MAX_PENDING_BYTES = 1 << 20


class Session(Protocol):
    """Interface of one client's session to the server."""

    @property
    def greeting(self) -> bytes:
        """Bytes to send at the beginning."""

    @property
    def streaming(self) -> bool:
        """Whether data of the client have an effect only from the next cycle on.

        They are then read once per cycle and do not wake the process.
        """

    def receive(self, data: bytes) -> bytes:
        """Replies to bytes from the client; raises `PacketError` when the connection is to be closed."""

    def tick(self) -> bytes:
        """Bytes to send after a cycle."""

    def close(self) -> None:
        """Handle the end of the connection."""


@dataclass(frozen=True)
class Port:
    """A port to listen on.

    Attributes
    ----------
    number : int
        TCP port.
    name : str
        Name for messages.
    session : callable
        Makes the session of a new client.
    """

    number: int
    name: str
    session: Callable[[], Session]


class _Connection:
    """A client: its socket, its session and unsent data."""

    def __init__(self, connected: socket.socket, port: Port, session: Session) -> None:
        self.socket = connected
        self.port = port
        self.session = session
        self.pending = b""

    def fileno(self) -> int:
        return self.socket.fileno()

    def send(self, data: bytes) -> bool:
        """Send data, and store what the socket does not accept; False when the connection is lost."""
        self.pending += data
        return self.flush()

    def flush(self) -> bool:
        if not self.pending:
            return True
        try:
            sent = self.socket.send(self.pending)
        except (BlockingIOError, InterruptedError):
            sent = 0
        except OSError:
            return False
        self.pending = self.pending[sent:]
        return len(self.pending) <= _MAX_PENDING_BYTES


class Server:
    """Listens on all ports of one robot.

    Parameters
    ----------
    host : str
        Address to bind to.
    ports : list of Port
        Ports to listen on.
    cycle : callable
        Called every 2 ms with the time of the cycle, CLOCK_MONOTONIC [ns].
    log : callable
        Called with a line of text for the user.

    Raises
    ------
    RobotError
        When the name of `host` is not known.
    SettingsError
        When a port is in use, or `host` is no address of this machine.
    """

    def __init__(self, host: str, ports: list[Port], cycle: Callable[[int], None], log: Callable[[str], None]) -> None:
        self._cycle = cycle
        self._log = log
        self._stops_at_s = math.inf
        self._connections: list[_Connection] = []
        self._listeners: dict[socket.socket, Port] = {}
        try:
            for port in ports:
                self._listeners[_listen(host, port)] = port
        except ActsError:
            self.close()
            raise

    def stop(self, *, after_clients: bool = False) -> None:
        """Let `run` return, from any thread.

        Parameters
        ----------
        after_clients : bool
            When no client is connected any more, at most `LONGEST_STAY_S` later; else after the present cycle.
        """
        self._stops_at_s = time.monotonic() + (LONGEST_STAY_S if after_clients else 0.0)

    def close(self) -> None:
        """Close every socket."""
        for connection in self._connections:
            connection.socket.close()
        for listener in self._listeners:
            listener.close()

    def run(self) -> None:
        """Serve until `stop` is called."""
        due_ns = time.monotonic_ns()
        while not self._is_over():
            now_ns = time.monotonic_ns()
            if now_ns >= due_ns:
                missed = (now_ns - due_ns) // _CYCLE_NS
                if missed > _MAX_CATCH_UP_CYCLES:
                    self._log(
                        f"the process was not scheduled for {missed * _CYCLE_NS / 1e9:.2f} s; the robot stood still"
                    )
                    due_ns = now_ns
                for connection in list(self._connections):
                    if connection.session.streaming:
                        self._read(connection)
                self._cycle(due_ns)
                due_ns += _CYCLE_NS
                for connection in list(self._connections):
                    self._tick(connection)
                continue
            self._wait((due_ns - now_ns) / 1e9)

    def _is_over(self) -> bool:
        if self._stops_at_s == math.inf:
            return False
        return not self._connections or time.monotonic() >= self._stops_at_s

    def _wait(self, timeout_s: float) -> None:
        """Serve the sockets until the next cycle is due or data have arrived."""
        writers = [connection for connection in self._connections if connection.pending]
        readers: list[socket.socket | _Connection] = list(self._listeners)
        # A client that has not taken its replies yet is not asked for more requests.
        readers += [one for one in self._connections if not one.session.streaming and not one.pending]
        readable, writable, _ = select.select(readers, writers, [], timeout_s)
        for connection in writable:
            if not connection.flush():
                self._drop(connection)
        for ready in readable:
            if isinstance(ready, _Connection):
                self._read(ready)
            else:
                self._accept(ready)

    def _accept(self, listener: socket.socket) -> None:
        try:
            connected, _ = listener.accept()
        except OSError:
            return  # closed before it was accepted, or no descriptor left
        port = self._listeners[listener]
        if sum(connection.port is port for connection in self._connections) >= MAX_CONNECTIONS:
            self._log(f"more than {MAX_CONNECTIONS} connections to the {port.name} port; refused one")
            connected.close()
            return
        connected.setblocking(False)
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        connected.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER_BYTES)
        connection = _Connection(connected, port, port.session())
        self._connections.append(connection)
        if not connection.send(connection.session.greeting):
            self._drop(connection)

    def _read(self, connection: _Connection) -> None:
        if connection.fileno() < 0:
            return  # dropped a moment ago
        try:
            data = connection.socket.recv(_READ_BYTES if connection.session.streaming else _REQUEST_BYTES)
        except (BlockingIOError, InterruptedError):
            return
        except OSError:
            data = b""
        if not data:
            self._drop(connection)
            return
        try:
            replies = connection.session.receive(data)
        except PacketError as error:
            self._log(f"{connection.port.name} port: {error}; closing that connection")
            self._drop(connection)
            return
        if replies and not connection.send(replies):
            self._drop(connection)

    def _tick(self, connection: _Connection) -> None:
        data = connection.session.tick()
        # For a client that does not keep up, whole packages are skipped, never parts of them.
        if data and not connection.pending and not connection.send(data):
            self._drop(connection)

    def _drop(self, connection: _Connection) -> None:
        if connection in self._connections:
            self._connections.remove(connection)
            connection.session.close()
            connection.socket.close()


def _listen(host: str, port: Port) -> socket.socket:
    listener: socket.socket | None = None
    try:
        # An address of IPv6 has colons; of a name, the address of IPv4 is taken.
        listener = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_STREAM)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind((host, port.number))
        listener.listen(MAX_CONNECTIONS)
        listener.setblocking(False)
    except (OSError, OverflowError, UnicodeError) as error:
        if listener is not None:
            listener.close()
        failure = f"cannot listen on {host} port {port.number} ({port.name}): {error}."
        if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
            raise SettingsError(
                f"{failure} Is another simulated robot running? Give a second one --host 127.0.0.2"
            ) from error
        if isinstance(error, socket.gaierror):
            # The network may not be there yet.
            raise RobotError(f"{failure} Give an address of this machine, such as --host 127.0.0.2") from error
        raise SettingsError(
            f"{failure} This robot is simulated, and nothing is controlled at {host}: for the real robot there give "
            "sim:=false, for a simulated one an address of this machine, such as 127.0.0.2"
        ) from error
    return listener
