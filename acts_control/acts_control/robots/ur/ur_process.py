# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The process that holds the connection to a UR5e: the only module that calls `ur_rtde`.

It is a process of its own for what that library does when a controller stands still or vanishes. Its constructors hold
Python's global lock, and wait without end; its calls wait for up to 300 s; and 2.5 s after the last data it connects
again by itself, ends the robot's program, starts a new one, and may crash. No option prevents that. `UrRobot` starts
this process for one connection, and kills it when that is over: whatever the library is at then ends too, and nothing
is sent any more.

Both talk over a socket, one JSON list a packet. To this process: ``watch`` (read the robot), then ``take_control``,
then any method of RTDEControlInterface with its arguments, or ``end_move``; ``end_program`` at any time. From it:
``["reading", ...]`` whenever the robot has told something new, and after every command, in their order,
``["done", result]`` or ``["failed", text]``.

When the other process vanishes, this one ends the robot's program.
"""

from __future__ import annotations

import ctypes
import json
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from typing import Any

# What is asked of the robot. With the library's own list of 58 variables its threads take several times the CPU.
_VARIABLES = ["timestamp", "actual_q", "safety_status_bits", "runtime_state", "robot_status_bits", "robot_mode"]

_PACKET_BYTES = 65536

# In parts of the time between two readings: when it is looked for the next one, and how often until it has come.
_FIRST_LOOK = 0.9
_NEXT_LOOK = 0.06

# Longest that a constructor, and the end of the robot's program, may take; the signal works in spite of the lock.
_CONNECT_S = 20
_END_S = 2

# A command waits at most this long for the thread that looks for readings [s].
_SWITCH_INTERVAL_S = 2e-4

# In parts of the time between two readings: how much later than asked the kernel may end a sleep. Each of the library's
# two receiving threads sleeps for 0.1 ms at a time, 2400 times a second; on a single core nothing costs others more.
_TIMER_SLACK = 0.25

_PR_SET_TIMERSLACK = 29  # of linux/prctl.h


class _Connection:
    """What a command does to the robot."""

    def __init__(self, link: socket.socket, host: str, rate_hz: float) -> None:
        self._link = link
        self._host = host
        self._rate_hz = rate_hz
        self._control: Any = None
        self._receive: Any = None

    def carry_out(self, name: str, *arguments: object) -> None:
        """Do what a packet says, and answer."""
        own = {"watch": self._watch, "take_control": self._take_control, "end_program": self.end_program}
        try:
            method: Any = self._end_move if name == "end_move" else own.get(name) or getattr(self._control, name)
            result = method(*arguments)
        except ImportError as error:
            self._tell("failed", f"ur_rtde cannot be imported ({error}); install it with: pip install ur-rtde")
        except ValueError as error:
            # An argument that the library does not allow.
            self._tell("failed", f"{name}: {str(error).strip()}")
        except RuntimeError as error:
            # Once there is a connection, it raises this only where that has ended.
            lost = "" if name in own else "the connection is lost: "
            self._tell("failed", f"{lost}{name}: {str(error).strip()}")
        else:
            self._tell("done", result)

    def end_program(self) -> None:
        """End the robot's program, if it is ours."""
        if self._control is not None:
            with suppress(RuntimeError):
                self._control.stopScript()

    def pass_over(self) -> None:
        """Answer a command that a newer one has replaced."""
        self._tell("done", True)

    def _watch(self) -> None:
        import rtde_receive

        signal.alarm(_CONNECT_S)
        self._receive = rtde_receive.RTDEReceiveInterface(self._host, self._rate_hz, _VARIABLES)
        signal.alarm(0)
        self._tell("reading", *self._read(), 0.0)
        threading.Thread(target=self._tell_readings, name="readings", daemon=True).start()

    def _take_control(self) -> None:
        import rtde_control

        signal.alarm(_CONNECT_S)
        self._control = rtde_control.RTDEControlInterface(self._host, self._rate_hz)
        signal.alarm(0)

    def _end_move(self, deceleration_rad_s2: float) -> None:
        """End an asynchronous move; the robot is told nothing where that has ended by itself."""
        if self._control.getAsyncOperationProgress() >= 0:
            self._control.stopJ(deceleration_rad_s2)

    def _tell_readings(self) -> None:
        seen = None
        seen_s = time.monotonic()
        while True:
            newest = self._receive.isConnected(), self._receive.getTimestamp()
            if newest == seen:
                time.sleep(_NEXT_LOOK / self._rate_hz)
                continue
            seen, before_s, seen_s = newest, seen_s, time.monotonic()
            try:
                # The library says of a controller that it tells nothing, too, that it is not connected: after 2.5 s.
                self._tell("reading", *self._read(), seen_s - before_s)
            except OSError:
                return  # the other process has gone
            time.sleep(_FIRST_LOOK / self._rate_hz)

    def _read(self) -> tuple[object, ...]:
        receive = self._receive
        # A packet may come between two of these calls: the safety bits last, so that they are not older than a program
        # that they have stopped.
        begin = receive.isConnected(), receive.getTimestamp(), receive.getActualQ()
        runtime_state, robot_mode = receive.getRuntimeState(), receive.getRobotMode()
        return (*begin, receive.getSafetyStatusBits(), runtime_state, robot_mode)

    def _tell(self, *words: object) -> None:
        self._link.send(json.dumps(words).encode())


def _packets(link: socket.socket) -> list[list[Any]]:
    """All that have come; waits for the first, and is empty when the other process has gone."""
    packets: list[list[Any]] = []
    flags = 0
    while True:
        try:
            data = link.recv(_PACKET_BYTES, flags)
        except BlockingIOError:
            return packets
        except ConnectionError:
            data = b""
        if not data:
            return []
        packets.append(json.loads(data))
        flags = socket.MSG_DONTWAIT


def main(arguments: Sequence[str]) -> None:
    """Serve the process at the other end of the socket until it is gone. Arguments: descriptor, address, rate [Hz]."""
    rate_hz = float(arguments[2])
    sys.setswitchinterval(_SWITCH_INTERVAL_S)
    # All threads that are started from here on have it. Where it is refused, things go on as without.
    ctypes.CDLL(None).prctl(_PR_SET_TIMERSLACK, ctypes.c_ulong(int(_TIMER_SLACK / rate_hz * 1e9)), 0, 0, 0)
    link = socket.socket(fileno=int(arguments[0]))
    connection = _Connection(link, arguments[1], rate_hz)
    with suppress(OSError):  # nobody is there to take an answer
        while packets := _packets(link):
            for packet, following in zip(packets, [*packets[1:], None], strict=True):
                if following is not None and packet[0] == following[0] == "servoJ":
                    # After a wait old targets are not caught up with.
                    connection.pass_over()
                else:
                    connection.carry_out(*packet)
    signal.alarm(_END_S)
    connection.end_program()
    # Not through the library's destructors, which wait for its threads.
    os._exit(0)


if __name__ == "__main__":
    main(sys.argv[1:])
