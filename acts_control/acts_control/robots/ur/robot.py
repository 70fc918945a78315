# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The UR5e as a robot that tilts a plate.

`ur_rtde` and all in which it may wait are in a process of their own (`ur_process`); here nothing but connecting waits,
and that for a stated time. That ``servoJ`` returns True says nothing about the robot: every loss is found by
`RobotWatch` from what is read.
"""

from __future__ import annotations

import json
import socket
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from math import inf, isfinite, sqrt

from acts_control.loop_rate import steady_s
from acts_control.robots.base import CommandRefusedError, RobotClaim, RobotReading, RobotStoppedError
from acts_control.robots.ur.config import UrConfig
from acts_control.robots.ur.gate import JointGate
from acts_control.robots.ur.state import UrState
from acts_control.robots.ur.ur_probe import probe
from acts_core.errors import ArrayError, RobotError
from acts_core.robots import ur5e
from acts_core.stop_signals import signal_name

# The library itself waits for up to 5 s for its program to start.
_CONNECT_TIMEOUT_S = 10.0
_PROGRAM_TIMEOUT_S = 2.0
_KILL_TIMEOUT_S = 1.0
# Longest that a program which has just been uploaded is waited for to end: a person may have asked for a stop.
_GIVE_UP_S = 0.5
_POLL_S = 0.002

_STOP_DECELERATION_RAD_S2 = 4.0

# How often the robot's watchdog is told that all is well while no other command is sent, in parts of its time.
_KICKS = 5

# A robot that has ended its program for a silence says so within this time; later it is not blamed for a stop.
_BLAMED_S = 2.0

# Added to how long the way to the level pose takes by its settings, which itself may be three times as long.
_LEVELLING_S = 5.0
_LEVELLING_FACTOR = 3.0

_PACKET_BYTES = 65536

_NOT_RUNNING = "the control script does not run"

# What is said, here and by the library, of an arm that is not ready. It would move as soon as a person makes it so.
_NOT_READY = (
    _NOT_RUNNING,
    "Failed to start control script",
    "RTDE control program is not running",
    "Please enable remote control",
)
_RUNS_ALREADY = "a program runs on the robot already"
_END_IT = "end it at the robot, or where it was started, then call start"
_MAKE_READY = "switch the arm on, release its brakes, put it into remote control, then call start"


class UrRobot:
    """A UR5e, real or simulated, through `ur_process`. The plate is tilted by wrist 1 and wrist 2."""

    def __init__(self, config: UrConfig) -> None:
        # From here on the level pose is the one that the tilt 0 commands, or the first command would be a step.
        config = replace(config, level_q_rad=_levelled(config.level_q_rad))
        self._config = config
        self._gate = JointGate(config)
        self._claim: RobotClaim | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._link: socket.socket | None = None
        self._state: UrState | None = None
        # Commands that have not been answered yet, oldest first: name, and when it was sent [s].
        self._pending: deque[tuple[str, float]] = deque()
        # When something was last sent, the longest time without of late, and when that was [s].
        self._sent_s = -inf
        self._silent_s, self._silent_at_s = 0.0, -inf
        # When the robot's watchdog is to be told next [s]; never while commands are sent anyway, or motion is ended.
        self._kick_s = inf
        # Whether the move to the level pose may not have ended yet.
        self._is_levelling = False
        # Whether an attempt to connect may have left our program running on the robot.
        self._is_left_running = False

    @property
    def longest_step_rad(self) -> float:
        """How far a tilt may be from the one before it, about each axis [rad]."""
        return self._config.longest_step_rad

    @property
    def address(self) -> str:
        """Address of the robot's controller."""
        return self._config.robot_ip

    def connect(self, is_wanted: Callable[[], bool]) -> None:
        """Connect and upload the control script.

        Raises
        ------
        RobotError
            When the controller does not answer, another program controls the robot, or it is not wanted any more.
        RobotStoppedError
            When a safety function holds it, it is off, has its brakes on or is in local control, or runs a program.
        RobotTakenError
            When another program of this machine controls it.
        """
        host = self._config.robot_ip
        if self._claim is None:
            self._claim = RobotClaim(host)
        self._await_former_end()
        probe(host)
        is_uploading = False
        try:
            self._start_process()
            self._carry_out("watch", is_wanted)
            state = self._newest()
            if not state.connected:
                raise RobotError(f"{host}: the controller accepts connections but sends no data; does it stand still?")
            if state.safety_stop:
                raise RobotStoppedError(f"{host}: {state.safety_stop}; release it at the robot, then start again")
            if state.unready:
                raise RobotStoppedError(f"{host}: the arm is not ready, {state.unready}; {_MAKE_READY}")
            if not self._is_left_running:
                # The library would end it, whatever moves by it. One of ours soon ends by the robot's watchdog.
                timeout_s = self._config.robot_watchdog_s + _PROGRAM_TIMEOUT_S
                self._await(lambda: not self._newest().is_playing, is_wanted, timeout_s, _RUNS_ALREADY)
            is_uploading = True
            self._carry_out("take_control", is_wanted)
            # The library knows that its program runs a packet or two before it can be read.
            self._await(lambda: self._newest().is_playing, is_wanted, _PROGRAM_TIMEOUT_S, _NOT_RUNNING)
            # From here on the robot stops by itself when this process, `ur_process` or the network falls silent.
            self._carry_out("setWatchdog", is_wanted, 1.0 / self._config.robot_watchdog_s)
            self._silent_s = 0.0
            self._is_left_running = False
        except RobotError as error:
            if is_uploading:
                self._end_uploaded()
            self.disconnect()
            if "already in use" in str(error):
                raise RobotError(f"{error} Is another program controlling the robot?") from error
            if _RUNS_ALREADY in str(error):
                raise RobotStoppedError(f"{error}; {_END_IT}") from error
            if any(words in str(error) for words in _NOT_READY):
                raise RobotStoppedError(f"{error}; {_MAKE_READY}") from error
            raise

    def read(self) -> RobotReading:
        """The newest state; costs microseconds."""
        # The time first: an answer that comes while this process stands still in between is not overdue.
        now_s = steady_s()
        state = self._newest()
        self._note_silence(now_s)
        if now_s >= self._kick_s:
            self._kick_s = now_s + self._config.robot_watchdog_s / _KICKS
            self._send("kickWatchdog")
        waiting_s = now_s - self._pending[0][1] if self._pending else 0.0
        reading = state.reading(self._config, waiting_s)
        allowed_s = self._config.robot_watchdog_s
        if self._silent_s > allowed_s and not state.is_playing and not state.safety_stop:
            stopped = (
                f"the robot has ended its program: this process stood still for {self._silent_s:.1f} s, "
                f"and robot_watchdog_s is {allowed_s:g}"
            )
            return reading._replace(stopped=stopped)
        return reading

    def _newest(self) -> UrState:
        self._take_in()
        if self._state is None:
            raise RobotError(f"{self._config.robot_ip}: nothing has been read yet")
        return self._state

    @property
    def is_busy(self) -> bool:
        """Whether something that was asked for has not been carried out yet. (Levelling counts once it has begun.)"""
        if self._link is not None:
            self._take_in()
        return bool(self._pending)

    def begin_levelling(self) -> float:
        """Start to move to the level pose; the longest time that this may take [s]."""
        config = self._config
        farthest = self.read().off_level
        self._gate = JointGate(config)
        # Asynchronous: a blocking moveJ would answer at its end only.
        level = _finite(config.level_q_rad)
        self._send("moveJ", level, config.homing_speed_rad_s, config.homing_acceleration_rad_s2, True)
        self._kick_s = steady_s()
        self._is_levelling = True
        return _LEVELLING_S + _LEVELLING_FACTOR * _way_s(config, farthest)

    def end_levelling(self) -> None:
        """Break that off; the arm comes to rest."""
        self._kick_s = inf
        self._is_levelling = False
        self._send("stopJ", _STOP_DECELERATION_RAD_S2)

    def tilt(self, tilt_x_rad: float, tilt_y_rad: float) -> tuple[float, ...]:
        """Aim for the wrist angles of a tilt; the six joint angles that were sent [rad]."""
        config = self._config
        q_rad = list(config.level_q_rad)
        try:
            q_rad[ur5e.WRIST_1], q_rad[ur5e.WRIST_2] = ur5e.wrist_angles_for_tilt(
                q_rad, tilt_x_rad, tilt_y_rad, config.mount_yaw_rad
            )
        except ArrayError as error:
            raise CommandRefusedError(str(error)) from error
        fault = self._gate.fault(q_rad)
        if fault:
            raise CommandRefusedError(fault)
        if self._is_levelling:
            # An arm that moves slowly, as with the speed turned down at the panel, seems to stand still before its move
            # has ended. The robot ends a program of which two threads move the arm.
            self._is_levelling = False
            self._send("end_move", _STOP_DECELERATION_RAD_S2)
        self._kick_s = inf
        # Speed and acceleration are ignored by the script.
        step_s = 1.0 / config.control_rate_hz
        self._send("servoJ", _finite(q_rad), 0.0, 0.0, step_s, config.servo_lookahead_s, config.servo_gain)
        return tuple(q_rad)

    def end_tilting(self) -> None:
        """Stop following; the arm holds its pose."""
        self._send("servoStop", _STOP_DECELERATION_RAD_S2)

    def release(self) -> None:
        """Give up control; the robot's program ends.

        Raises
        ------
        RobotError
            When that cannot be told to the robot, or an attempt to connect that was given up has not ended it.
        """
        self._kick_s = inf
        if self._link is not None:
            self._send("stopScript")
        elif self._is_left_running:
            raise RobotError(f"{self._config.robot_ip}: connecting was given up while it was uploaded")

    def disconnect(self) -> None:
        """Cut the connection; no command is sent any more."""
        # Killed first: what sees the link closed ends the robot's program, which is a command.
        if self._process is not None:
            self._process.kill()
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(_KILL_TIMEOUT_S)
        if self._link is not None:
            self._link.close()
        self._link, self._state, self._kick_s = None, None, inf
        self._pending.clear()
        if self._claim is not None and (self._process is None or self._process.poll() is not None):
            # Last: another program may take the robot from here on.
            self._claim.close()
            self._claim = None

    def _end_uploaded(self) -> None:
        """End a program that nothing watches yet, and that may still be starting. Waits for a moment only."""
        try:
            self._send("end_program")
            self._await(lambda: not self.is_busy, lambda: True, _GIVE_UP_S, "end_program: no answer")
        except RobotError:
            self._is_left_running = True

    def _await_former_end(self) -> None:
        """Two connections at once would be refused, and both might command."""
        if self._process is None:
            return
        if self._process.poll() is None:
            raise RobotError(
                f"{self._config.robot_ip}: waiting for the end of the former connection (process {self._process.pid})"
            )
        self._process = None

    def _start_process(self) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            ours.setblocking(False)
            self._link = ours
            words = [str(theirs.fileno()), self._config.robot_ip, str(self._config.control_rate_hz)]
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

    def _carry_out(self, name: str, is_wanted: Callable[[], bool], *arguments: object) -> None:
        self._send(name, *arguments)
        self._await(lambda: not self.is_busy, is_wanted, _CONNECT_TIMEOUT_S, f"{name}: no answer")

    def _await(self, condition: Callable[[], bool], is_wanted: Callable[[], bool], timeout_s: float, what: str) -> None:
        deadline = steady_s() + timeout_s
        while not condition():
            if not is_wanted():
                raise RobotError(f"{self._config.robot_ip}: connecting was given up")
            if steady_s() > deadline:
                raise RobotError(f"{self._config.robot_ip}: {what} (waited for {timeout_s:g} s)")
            time.sleep(_POLL_S)

    def _send(self, name: str, *arguments: object) -> None:
        self._take_in()
        assert self._link is not None
        try:
            self._link.send(json.dumps([name, *arguments]).encode())
        except OSError as error:
            reason = f"the connection is lost: {name} cannot be handed over ({error.strerror})"
            raise RobotError(f"{self._config.robot_ip}: {reason}") from error
        now_s = steady_s()
        self._note_silence(now_s)
        self._sent_s = now_s
        self._pending.append((name, now_s))

    def _note_silence(self, now_s: float) -> None:
        silent_s = now_s - self._sent_s
        if silent_s >= self._silent_s or now_s - self._silent_at_s > _BLAMED_S:
            self._silent_s, self._silent_at_s = silent_s, now_s

    def _take_in(self) -> None:
        """Read what the other process has told since.

        Raises
        ------
        RobotError
            When something that was asked for has failed, or the process has ended.
        """
        if self._link is None:
            raise RobotError(f"{self._config.robot_ip}: not connected")
        while True:
            try:
                packet = self._link.recv(_PACKET_BYTES)
            except BlockingIOError:
                return
            except OSError:
                packet = b""
            if not packet:
                raise RobotError(f"{self._config.robot_ip}: {self._how_it_ended()}")
            kind, *words = json.loads(packet)
            if kind == "reading":
                connected, timestamp_s, q_rad, *others = words
                self._state = UrState(connected, timestamp_s, tuple(q_rad), *others)
                continue
            name, _ = self._pending.popleft()
            if kind == "failed":
                raise RobotError(f"{self._config.robot_ip}: {words[0]}")
            if words[0] is False and name in _REFUSALS:
                raise RobotError(f"{self._config.robot_ip}: {name} refused; {_REFUSALS[name]}")

    def _how_it_ended(self) -> str:
        assert self._process is not None
        try:
            code = self._process.wait(_KILL_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            return "the connection is lost: its process does not answer any more"
        how = signal_name(-code) if code < 0 else f"exit code {code}"
        return f"the connection is lost: its process has ended ({how}); what ur_rtde said is in the log"


# What refuses to stop something has nothing to stop.
_REFUSALS = {
    "setWatchdog": "the robot's program is not running",
    "moveJ": "is the robot on and in remote control?",
    # The library does not tell the two apart.
    "servoJ": "the robot's program is not running, or the connection is lost",
}


def _way_s(config: UrConfig, farthest_rad: float) -> float:
    """How long the joint that is farthest from the level pose takes to get there [s]."""
    speed_rad_s, acceleration_rad_s2 = config.homing_speed_rad_s, config.homing_acceleration_rad_s2
    if farthest_rad * acceleration_rad_s2 < speed_rad_s**2:
        return 2.0 * sqrt(farthest_rad / acceleration_rad_s2)  # it brakes before it has come to that speed
    return farthest_rad / speed_rad_s + speed_rad_s / acceleration_rad_s2


def _levelled(q_rad: Sequence[float]) -> tuple[float, ...]:
    """A pose that is nearly level, with wrist 1 and wrist 2 turned so that it is exactly level."""
    levelled = list(q_rad)
    levelled[ur5e.WRIST_1], levelled[ur5e.WRIST_2] = ur5e.wrist_angles_for_tilt(q_rad, 0.0, 0.0)
    return tuple(levelled)


def _finite(q_rad: Sequence[float]) -> list[float]:
    # ur_rtde sends NaN and vectors of any length; the gate has looked before, this is the very last place to.
    q = [float(angle) for angle in q_rad]
    if len(q) != ur5e.JOINTS or not all(map(isfinite, q)):
        raise RobotError(f"joint angles {q} cannot be sent: six finite numbers are needed")
    return q
