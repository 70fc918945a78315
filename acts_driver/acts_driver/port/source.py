# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sources of bytes: a serial port here, a recording in `acts_driver.replay`. The reader knows only `Source`."""

from __future__ import annotations

import os
import select
import termios
import threading
import time
from typing import Protocol

import serial
from serial.tools import list_ports

from acts_core.errors import PortError
from acts_driver.port.port import open_port
from acts_driver.port.port_choice import Lister, check_port, resolve

READ_TIMEOUT_S = 0.1
"""Longest time that `Source.read` blocks, so that a reader can be stopped."""

_READ_SIZE = 65536
_WRITE_SLICE_S = 0.05


class Source(Protocol):
    """A stream of bytes that can be opened again after it was lost.

    How to write one: `open` takes hold of the stream, `read` waits for the next bytes, `close` may be called at any
    time and any number of times. These are called from one thread at a time, and so is `discard`.

    Attributes
    ----------
    silence : str
        Why no bytes come, for a person, where that is known; empty otherwise.
    """

    silence: str

    @property
    def name(self) -> str:
        """What a person calls the source, for example the path of the port."""

    def open(self) -> None:
        """Open the stream, or raise `PortError` (or what else tells why it cannot be opened)."""

    def begin(self) -> None:
        """Tell that somebody wants the frames from now on; a recording waits for that. From any thread."""

    def read(self) -> bytes:
        """Return the bytes that are there, waiting for the first one up to `READ_TIMEOUT_S`; empty where none came.

        Raises `PortError` when the stream was lost.
        """

    def waits(self) -> bool:
        """Whether bytes have arrived that were not read; on the thread that reads."""

    def write(self, data: bytes, timeout_s: float) -> None:
        """Give bytes to the board, waiting up to `timeout_s` for room. From any thread.

        Raises `PortError` when there is no board, or it does not take them in time.
        """

    def discard(self) -> None:
        """Throw away what has arrived and was not read; on the thread that reads.

        Raises `PortError` when the stream was lost.
        """

    def close(self) -> None:
        """Let go of the stream."""


class SerialSource:
    """A serial port, opened with pyserial for this process alone.

    Parameters
    ----------
    port : str
        A path, `auto` or `serial:NUMBER` (see `port_choice.resolve`); what it means is found out anew at
        every opening.
    baud : int
        Bits per second; of no effect on USB boards.
    lister : callable
        Lists the ports of this machine.

    Raises
    ------
    SettingsError
        For words that can be no port.
    """

    def __init__(self, port: str, baud: int = 115200, lister: Lister = list_ports.comports) -> None:
        check_port(port)
        self._wanted = port
        self._path = port
        self._baud = baud
        self._lister = lister
        self._port: serial.Serial | None = None
        self._poll = select.poll()
        self._fd = -1
        # Between writing, and closing and opening: the number of a closed port may belong to another file at once.
        self._lock = threading.Lock()
        self.silence = ""

    @property
    def name(self) -> str:
        """The port as it was asked for, and its path where that was another one."""
        return self._wanted if self._path == self._wanted else f"{self._wanted} ({self._path})"

    def open(self) -> None:
        """Open the port, or raise `PortError`."""
        self.close()
        self._path = self._wanted
        self._path = resolve(self._wanted, self._lister)
        port = open_port(self._path, self._baud, self._lister)
        fd = port.fileno()
        with self._lock:
            self._port, self._fd = port, fd
        self._poll = select.poll()
        self._poll.register(fd, select.POLLIN)

    def begin(self) -> None:
        """A board sends from its start on."""

    def read(self) -> bytes:
        """Return what has arrived, waiting up to `READ_TIMEOUT_S`, or raise `PortError` when the port was lost."""
        if self._port is None:
            raise PortError(f"port {self.name} is not open")
        # Not pyserial's read(n): it waits for all n bytes, and reading what is there takes it four system calls.
        try:
            if not self._poll.poll(READ_TIMEOUT_S * 1000):
                return b""
            data = os.read(self._fd, _READ_SIZE)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise PortError(f"port {self.name} was lost: {error.strerror}") from error
        if not data:
            # An unplugged port is always ready and has nothing to give.
            raise PortError(f"port {self.name} was lost: end of stream")
        return data

    def waits(self) -> bool:
        """Whether bytes have arrived that were not read."""
        return bool(self._poll.poll(0))

    def write(self, data: bytes, timeout_s: float) -> None:
        """Write all of it, or raise `PortError` when the port is not open, is lost, or stays full."""
        deadline_s = time.monotonic() + timeout_s
        while True:
            with self._lock:
                if self._port is None:
                    raise PortError(f"port {self.name} is not open")
                fd = self._fd
                try:
                    data = data[os.write(fd, data) :]
                except BlockingIOError:
                    pass
                except OSError as error:
                    raise PortError(f"port {self.name} was lost: {error.strerror}") from error
            if not data:
                return
            left_s = deadline_s - time.monotonic()
            if left_s <= 0:
                raise PortError(f"the board at port {self.name} takes no bytes; is its sketch stuck? press its button")
            # Without the lock, closing does not wait for a stuck board; in slices, since poll does not end by closing.
            poll = select.poll()
            poll.register(fd, select.POLLOUT)
            poll.poll(min(left_s, _WRITE_SLICE_S) * 1000)

    def discard(self) -> None:
        """See `Source`."""
        try:
            termios.tcflush(self._fd, termios.TCIFLUSH)
        except termios.error as error:
            raise PortError(f"port {self.name} was lost: {error.args[1]}") from error

    def close(self) -> None:
        """Close the port if it is open."""
        with self._lock:
            port, self._port = self._port, None
            if port is not None:
                port.close()
