# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The UR5e as a robot that tilts a plate.

`ur_rtde` and all in which it may wait are in a process of their own (`ur_process`); here nothing but connecting waits,
and that for a stated time. That ``servoJ`` returns True says nothing about the robot: every loss is found by
`RobotWatch` from what is read.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf, isfinite, sqrt

from acts_control.loop_rate import steady_s
from acts_control.robots.base import CommandRefusedError, RobotClaim, RobotReading, RobotStoppedError
from acts_control.robots.ur.config import UrConfig
from acts_control.robots.ur.gate import JointGate
from acts_control.robots.ur.process_link import ProcessLink
from acts_control.robots.ur.ur_probe import probe
from acts_core.errors import ArrayError, RobotError
from acts_core.robots import ur5e

_PROGRAM_TIMEOUT_S = 2.0
# Longest that a program which has just been uploaded is waited for to end: a person may have asked for a stop.
_GIVE_UP_S = 0.5

_STOP_DECELERATION_RAD_S2 = 4.0

# How often the robot's watchdog is told that all is well while no other command is sent, in parts of its time.
_KICKS = 5

# Added to how long the way to the level pose takes by its settings, which itself may be three times as long.
_LEVELLING_S = 5.0
_LEVELLING_FACTOR = 3.0

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
        self._link = ProcessLink(config.robot_ip, config.control_rate_hz)
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
        self._link.require_former_end()
        probe(host)
        is_uploading = False
        try:
            self._link.start()
            self._link.carry_out("watch", is_wanted)
            state = self._link.newest()
            if not state.connected:
                raise RobotError(f"{host}: the controller accepts connections but sends no data; does it stand still?")
            if state.safety_stop:
                raise RobotStoppedError(f"{host}: {state.safety_stop}; release it at the robot, then start again")
            if state.unready:
                raise RobotStoppedError(f"{host}: the arm is not ready, {state.unready}; {_MAKE_READY}")
            if not self._is_left_running:
                # The library would end it, whatever moves by it. One of ours soon ends by the robot's watchdog.
                timeout_s = self._config.robot_watchdog_s + _PROGRAM_TIMEOUT_S
                self._link.wait_until(lambda: not self._link.newest().is_playing, is_wanted, timeout_s, _RUNS_ALREADY)
            is_uploading = True
            self._link.carry_out("take_control", is_wanted)
            # The library knows that its program runs a packet or two before it can be read.
            self._link.wait_until(lambda: self._link.newest().is_playing, is_wanted, _PROGRAM_TIMEOUT_S, _NOT_RUNNING)
            # From here on the robot stops by itself when this process, `ur_process` or the network falls silent.
            self._link.carry_out("setWatchdog", is_wanted, 1.0 / self._config.robot_watchdog_s)
            self._link.silent_s = 0.0
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
        state = self._link.newest()
        self._link.note_silence(now_s)
        if now_s >= self._kick_s:
            self._kick_s = now_s + self._config.robot_watchdog_s / _KICKS
            self._link.send("kickWatchdog")
        reading = state.reading(self._config, self._link.waiting_s(now_s))
        allowed_s = self._config.robot_watchdog_s
        if self._link.silent_s > allowed_s and not state.is_playing and not state.safety_stop:
            stopped = (
                f"the robot has ended its program: this process stood still for {self._link.silent_s:.1f} s, "
                f"and robot_watchdog_s is {allowed_s:g}"
            )
            return reading._replace(stopped=stopped)
        return reading

    @property
    def is_busy(self) -> bool:
        """Whether something that was asked for has not been carried out yet. (Levelling counts once it has begun.)"""
        return self._link.is_busy

    def begin_levelling(self) -> float:
        """Start to move to the level pose; the longest time that this may take [s]."""
        config = self._config
        farthest = self.read().off_level
        self._gate = JointGate(config)
        # Asynchronous: a blocking moveJ would answer at its end only.
        level = _finite(config.level_q_rad)
        self._link.send("moveJ", level, config.homing_speed_rad_s, config.homing_acceleration_rad_s2, True)
        self._kick_s = steady_s()
        self._is_levelling = True
        return _LEVELLING_S + _LEVELLING_FACTOR * _way_s(config, farthest)

    def end_levelling(self) -> None:
        """Break that off; the arm comes to rest."""
        self._kick_s = inf
        self._is_levelling = False
        self._link.send("stopJ", _STOP_DECELERATION_RAD_S2)

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
            self._link.send("end_move", _STOP_DECELERATION_RAD_S2)
        self._kick_s = inf
        # Speed and acceleration are ignored by the script.
        step_s = 1.0 / config.control_rate_hz
        self._link.send("servoJ", _finite(q_rad), 0.0, 0.0, step_s, config.servo_lookahead_s, config.servo_gain)
        return tuple(q_rad)

    def end_tilting(self) -> None:
        """Stop following; the arm holds its pose."""
        self._link.send("servoStop", _STOP_DECELERATION_RAD_S2)

    def release(self) -> None:
        """Give up control; the robot's program ends.

        Raises
        ------
        RobotError
            When that cannot be told to the robot, or an attempt to connect that was given up has not ended it.
        """
        self._kick_s = inf
        if self._link.is_open:
            self._link.send("stopScript")
        elif self._is_left_running:
            raise RobotError(f"{self._config.robot_ip}: connecting was given up while it was uploaded")

    def disconnect(self) -> None:
        """Cut the connection; no command is sent any more."""
        self._kick_s = inf
        self._link.close()
        if self._claim is not None and self._link.is_process_gone:
            # Last: another program may take the robot from here on.
            self._claim.close()
            self._claim = None

    def _end_uploaded(self) -> None:
        """End a program that nothing watches yet, and that may still be starting. Waits for a moment only."""
        try:
            self._link.send("end_program")
            self._link.wait_until(lambda: not self.is_busy, lambda: True, _GIVE_UP_S, "end_program: no answer")
        except RobotError:
            self._is_left_running = True


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
