# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A bus behind a pseudo-terminal, as behind a USB adapter, with the delays of a real wire."""

from __future__ import annotations

import math
import os
import select
import time
import tty
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from acts_core.errors import RobotError
from acts_sim.dynamixel.bus import BITS_PER_BYTE, Bus
from acts_sim.dynamixel.control import ControlSocket
from acts_sim.dynamixel.packets import PacketReader

# Timeout of an incomplete packet; at 1 Mb/s the longest packet takes 10 ms.
_PACKET_TIMEOUT_S = 0.05

# A client that has sent nothing for so long has let go of the motors [s].
_QUIET_S = 0.3

# It has at most so long for that [s].
_LONGEST_STAY_S = 4.0

# After a longer pause of the process the missed steps are skipped: the motors' time has stood still.
_MAX_CATCH_UP_NS = 100_000_000


class BusPort:
    """Serves a `Bus` on a pseudo-terminal of its own.

    Parameters
    ----------
    bus : Bus
    step : callable
        Advances motors and mechanics by a time step [s].
    step_s : float
        Length of a step [s].
    link : Path or None
        Symbolic link to the port; one to another pseudo-terminal is replaced.
    baud : int
        Baud rate of the simulated wire [bit/s]; with 0 packets take no time.

    Raises
    ------
    RobotError
        When the link cannot be made.
    """

    def __init__(self, bus: Bus, step: Callable[[float], None], step_s: float, link: Path | None, baud: int) -> None:
        self._bus = bus
        self._step = step
        self._step_s = step_s
        self._link = link
        self._s_per_byte = BITS_PER_BYTE / baud if baud else 0.0
        self._reader = PacketReader()
        self._heard_s = 0.0
        # Replies on the wire with their times of arrival, oldest first.
        self._answers: deque[tuple[float, bytes]] = deque()
        self._stopped_s = math.inf
        self._stay_s = 0.0
        self._master = self._slave = -1
        self.path = ""
        self.plug_in()

    @property
    def connected(self) -> bool:
        """Whether the adapter is plugged in."""
        return self._master >= 0

    def plug_in(self) -> None:
        """Connect the adapter: a new pseudo-terminal under the same link.

        Raises
        ------
        RobotError
            The link cannot be made.
        """
        if self._master >= 0:
            return
        self._master, self._slave = os.openpty()
        # Our own descriptor of the slave stays open: reads of the master fail while no process has the slave open.
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self._reader.forget()
        self._answers.clear()
        self.path = os.ttyname(self._slave)
        if self._link is not None:
            try:
                self._link.parent.mkdir(parents=True, exist_ok=True)
                # That of a bus that was killed leads to a pseudo-terminal; any other is somebody's.
                if self._link.is_symlink() and str(self._link.readlink()).startswith("/dev/pts/"):
                    self._link.unlink()
                self._link.symlink_to(self.path)
            except OSError as error:
                self.close()
                raise RobotError(f"{self._link}: the link to the port cannot be made ({error.strerror})") from error

    def unplug(self) -> None:
        """Unplug the adapter: programs that have the port open get errors, and the link is removed."""
        for descriptor in (self._master, self._slave):
            if descriptor >= 0:
                os.close(descriptor)
        self._master = self._slave = -1
        self._answers.clear()
        # A link that cannot be looked at was not made here.
        with suppress(OSError):
            if self._link is not None and self._link.is_symlink() and str(self._link.readlink()) == self.path:
                self._link.unlink()

    def close(self) -> None:
        """Close the port and remove the link."""
        self.unplug()

    def stop(self, *, after_client: bool = False) -> None:
        """Let `run` return, from any thread or signal handler.

        Parameters
        ----------
        after_client : bool
            When nothing has come from a client for 0.3 s, at most 4 s later; else after the present step.
        """
        self._stay_s = _LONGEST_STAY_S if after_client else 0.0
        self._stopped_s = time.monotonic()

    def run(self, control: ControlSocket | None = None) -> None:
        """Serve the port, and the control socket if there is one, until `stop` is called."""
        # Whole nanoseconds: after months of a machine's time, each sum of seconds would be rounded the same way.
        step_ns = round(self._step_s * 1e9)
        due_ns = time.monotonic_ns()
        while not self._is_over():
            now_ns = time.monotonic_ns()
            if now_ns >= due_ns:
                if now_ns - due_ns > _MAX_CATCH_UP_NS:
                    due_ns = now_ns
                self._step(self._step_s)
                due_ns += step_ns
            self._send_due()
            next_s = min(due_ns / 1e9, self._answers[0][0]) if self._answers else due_ns / 1e9
            # Checked after every step, so that a reply need not wait until missed steps are made up.
            waiting: list[int] = []
            if control is not None:
                control.send_rest()
                waiting = control.descriptors()
            if self._master >= 0:
                waiting.append(self._master)
            readable, _, _ = select.select(waiting, [], [], max(0.0, next_s - time.monotonic()))
            for descriptor in readable:
                if descriptor == self._master:
                    self._receive()
                elif control is not None:
                    control.serve(descriptor)

    def _is_over(self) -> bool:
        if self._stopped_s == math.inf:
            return False
        now_s = time.monotonic()
        is_quiet = now_s - max(self._heard_s, self._stopped_s) >= _QUIET_S
        return is_quiet or now_s - self._stopped_s >= self._stay_s

    def _receive(self) -> None:
        arrival_s = time.monotonic()
        try:
            data = os.read(self._master, 4096)
        except BlockingIOError:
            return
        if arrival_s - self._heard_s > _PACKET_TIMEOUT_S:
            self._reader.forget()
        self._heard_s = arrival_s
        for packet in self._reader.feed(data):
            answer = self._bus.handle(packet)
            if not answer.data:
                continue
            wire_s = (len(data) + len(answer.data)) * self._s_per_byte
            self._answers.append((arrival_s + wire_s + (answer.delay_s if self._s_per_byte else 0.0), answer.data))

    def _send_due(self) -> None:
        while self._answers and self._answers[0][0] <= time.monotonic():
            _, data = self._answers.popleft()
            # Bytes that do not fit into the terminal's buffer are lost, as on a serial port that is not read.
            with suppress(BlockingIOError):
                os.write(self._master, data)
