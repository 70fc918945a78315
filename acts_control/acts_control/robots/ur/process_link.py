# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""This side's end of `ur_process`: starts and ends it, hands it commands, takes in what it tells.

Nothing here waits but `carry_out`, `wait_until` and `close`, each for a stated time.
"""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from math import inf

from acts_control.loop_rate import steady_s
from acts_control.robots.ur.state import UrState
from acts_core.errors import RobotError
from acts_core.stop_signals import signal_name

# The library itself waits for up to 5 s for its program to start.
_CONNECT_TIMEOUT_S = 10.0
_KILL_TIMEOUT_S = 1.0
_POLL_S = 0.002

# A robot that has ended its program for a silence says so within this time; later it is not blamed for a stop.
_BLAMED_S = 2.0

_PACKET_BYTES = 65536

# What refuses to stop something has nothing to stop.
_REFUSALS = {
    "setWatchdog": "the robot's program is not running",
    "moveJ": "is the robot on and in remote control?",
    # The library does not tell the two apart.
    "servoJ": "the robot's program is not running, or the connection is lost",
}


class ProcessLink:
    """One connection to a robot at a time, each by a process of its own.

    Parameters
    ----------
    host : str
        Address of the robot's controller; errors begin with it.
    rate_hz : float
        Of commands [Hz].

    Attributes
    ----------
    silent_s : float
        The longest time of late in which nothing was sent [s].
    """

    def __init__(self, host: str, rate_hz: float) -> None:
        self._host = host
        self._rate_hz = rate_hz
        self._process: subprocess.Popen[bytes] | None = None
        self._link: socket.socket | None = None
        self._state: UrState | None = None
        # Commands that have not been answered yet, oldest first: name, and when it was sent [s].
        self._pending: deque[tuple[str, float]] = deque()
        # When something was last sent, and when that was the longest time without [s].
        self._sent_s = -inf
        self.silent_s, self._silent_at_s = 0.0, -inf

    @property
    def is_open(self) -> bool:
        """Whether it is between `start` and `close`."""
        return self._link is not None

    @property
    def is_busy(self) -> bool:
        """Whether a command has not been answered yet."""
        if self.is_open:
            self._take_in()
        return bool(self._pending)

    @property
    def is_process_gone(self) -> bool:
        """Whether the process has ended, or was never started."""
        return self._process is None or self._process.poll() is not None

    def require_former_end(self) -> None:
        """Refuse a second connection: the robot would, or both might command.

        Raises
        ------
        RobotError
            When the process of the former one still runs.
        """
        if self._process is not None and not self.is_process_gone:
            raise RobotError(
                f"{self._host}: waiting for the end of the former connection (process {self._process.pid})"
            )
        self._process = None

    def start(self) -> None:
        """Start a process.

        Raises
        ------
        RobotError
            When that fails.
        """
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            ours.setblocking(False)
            self._link = ours
            words = [str(theirs.fileno()), self._host, str(self._rate_hz)]
            try:
                self._process = subprocess.Popen(
                    [sys.executable, "-m", "acts_control.robots.ur.ur_process", *words],
                    stdin=subprocess.DEVNULL,
                    pass_fds=[theirs.fileno()],
                    # A Ctrl-C in the terminal is for this process, which ends motion in order.
                    start_new_session=True,
                )
            except OSError as error:
                raise RobotError(f"the process for the robot cannot be started: {error}") from error

    def send(self, name: str, *arguments: object) -> None:
        """Hand over a command; its answer is taken in later.

        Raises
        ------
        RobotError
            As `newest` does.
        """
        self._take_in()
        assert self._link is not None
        try:
            self._link.send(json.dumps([name, *arguments]).encode())
        except OSError as error:
            reason = f"the connection is lost: {name} cannot be handed over ({error.strerror})"
            raise RobotError(f"{self._host}: {reason}") from error
        now_s = steady_s()
        self.note_silence(now_s)
        self._sent_s = now_s
        self._pending.append((name, now_s))

    def carry_out(self, name: str, is_wanted: Callable[[], bool], *arguments: object) -> None:
        """Hand over a command and wait for its answer; see `wait_until`."""
        self.send(name, *arguments)
        self.wait_until(lambda: not self.is_busy, is_wanted, _CONNECT_TIMEOUT_S, f"{name}: no answer")

    def wait_until(
        self, condition: Callable[[], bool], is_wanted: Callable[[], bool], timeout_s: float, what: str
    ) -> None:
        """Wait for a condition.

        Raises
        ------
        RobotError
            With `what`, where it does not come about in time, and where it is not wanted any more.
        """
        deadline = steady_s() + timeout_s
        while not condition():
            if not is_wanted():
                raise RobotError(f"{self._host}: connecting was given up")
            if steady_s() > deadline:
                raise RobotError(f"{self._host}: {what} (waited for {timeout_s:g} s)")
            time.sleep(_POLL_S)

    def newest(self) -> UrState:
        """What the robot told last.

        Raises
        ------
        RobotError
            When it has told nothing yet, something that was asked for has failed, or the process has ended.
        """
        self._take_in()
        if self._state is None:
            raise RobotError(f"{self._host}: nothing has been read yet")
        return self._state

    def waiting_s(self, now_s: float) -> float:
        """How long the oldest command that is not answered has been waiting [s]."""
        return now_s - self._pending[0][1] if self._pending else 0.0

    def note_silence(self, now_s: float) -> None:
        """Keep `silent_s` up to date, by the time now [s]."""
        silent_s = now_s - self._sent_s
        if silent_s >= self.silent_s or now_s - self._silent_at_s > _BLAMED_S:
            self.silent_s, self._silent_at_s = silent_s, now_s

    def close(self) -> None:
        """Cut the connection; no command is sent any more."""
        # Killed first: what sees the link closed ends the robot's program, which is a command.
        if self._process is not None:
            self._process.kill()
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(_KILL_TIMEOUT_S)
        if self._link is not None:
            self._link.close()
        self._link, self._state = None, None
        self._pending.clear()

    def _take_in(self) -> None:
        """Read what the other process has told since."""
        if self._link is None:
            raise RobotError(f"{self._host}: not connected")
        while True:
            try:
                packet = self._link.recv(_PACKET_BYTES)
            except BlockingIOError:
                return
            except OSError:
                packet = b""
            if not packet:
                raise RobotError(f"{self._host}: {self._how_it_ended()}")
            kind, *words = json.loads(packet)
            if kind == "reading":
                connected, timestamp_s, q_rad, *others = words
                self._state = UrState(connected, timestamp_s, tuple(q_rad), *others)
                continue
            name, _ = self._pending.popleft()
            if kind == "failed":
                raise RobotError(f"{self._host}: {words[0]}")
            if words[0] is False and name in _REFUSALS:
                raise RobotError(f"{self._host}: {name} refused; {_REFUSALS[name]}")

    def _how_it_ended(self) -> str:
        assert self._process is not None
        try:
            code = self._process.wait(_KILL_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            return "the connection is lost: its process does not answer any more"
        how = signal_name(-code) if code < 0 else f"exit code {code}"
        return f"the connection is lost: its process has ended ({how}); what ur_rtde said is in the log"
