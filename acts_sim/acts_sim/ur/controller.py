# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated controller: joints, safety, program, registers. One `tick` is a 2 ms cycle; it reads no clock."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from acts_core.robots import ur5e
from acts_sim.ur.config import CYCLE_S, POSITION_LIMIT_RAD, UrControllerConfig
from acts_sim.ur.joints import Brake, JointState, Motion, Rest
from acts_sim.ur.pose import Rows, pose_from_rows, speed_between, transform_from_pose
from acts_sim.ur.rtde import INPUT_TYPES, OutputImage, Value

COMMAND_REGISTERS = ("input_int_register_0", "input_int_register_24")
"""Registers for the commands of a client, depending on the offset of its script."""

HISTORY = 1000
"""Number of past cycles whose joint angles are stored."""

RECORD = 5000
"""Number of orders that are stored."""


class Order(NamedTuple):
    """A request of a client to the robot.

    Attributes
    ----------
    time_s : float
        The controller's time [s].
    port : str
        Port on which it came: rtde, script or dashboard.
    words : str
        The request.
    """

    time_s: float
    port: str
    words: str


class RuntimeState(IntEnum):
    """State of the program."""

    STOPPING = 0
    STOPPED = 1
    PLAYING = 2
    PAUSING = 3
    PAUSED = 4
    RESUMING = 5


class SafetyMode(IntEnum):
    """Reason why the robot may not move."""

    NORMAL = 1
    PROTECTIVE_STOP = 3
    ROBOT_EMERGENCY_STOP = 7


class RobotMode(IntEnum):
    """State of power and brakes."""

    POWER_OFF = 3
    IDLE = 5
    RUNNING = 7


# Bits: 0 normal, 2 protective stop, 6 emergency stop at the robot, 7 any emergency stop, 10 stopped due to safety.
_SAFETY_BITS = {
    SafetyMode.NORMAL: 0x001,
    SafetyMode.PROTECTIVE_STOP: 0x404,
    SafetyMode.ROBOT_EMERGENCY_STOP: 0x4C0,
}

# Joint modes: 239 power off, 253 running, 255 idle.
_JOINT_MODES = {RobotMode.POWER_OFF: 239, RobotMode.IDLE: 255, RobotMode.RUNNING: 253}


class ProgramEnded(Exception):  # noqa: N818 - an end, not always an error
    """The program ends; the text is the reason, or empty where the client has ended it."""


class Program(Protocol):
    """A program, which the controller runs once per cycle while it plays."""

    @property
    def name(self) -> str:
        """Name of the program, for messages."""

    def cycle(self, controller: Controller) -> None:
        """Execute one cycle.

        Raises
        ------
        ProgramEnded
            When it ends.
        """

    def resume(self, controller: Controller) -> None:
        """Resume the motion after a pause."""


class Controller:
    """The simulated controller of one robot.

    Parameters
    ----------
    config : UrControllerConfig
        Settings of the robot.
    log : callable
        Called with a line of text for the user.
    """

    def __init__(self, config: UrControllerConfig, log: Callable[[str], None]) -> None:
        self.config = config
        self.log = log
        self.cycles = 0
        self.time_s = 0.0
        self.output = OutputImage()
        self.registers: dict[str, Value] = {
            name: 0.0 if kind == "DOUBLE" else (0.0,) * ur5e.JOINTS if kind == "VECTOR6D" else 0
            for name, kind in INPUT_TYPES.items()
        }
        self.joints = JointState(config.q0_rad, config.speed_limit_rad_s, config.acceleration_limit_rad_s2)
        self.motion: Motion = Rest()
        self.motion_done = True
        self.safety = SafetyMode.NORMAL
        self.robot_mode = RobotMode.RUNNING
        self.runtime = RuntimeState.STOPPED
        self.program: Program | None = None
        self.tcp_offset = np.eye(4)
        self.tcp_wanted = False
        self.orders: deque[Order] = deque(maxlen=RECORD)
        self.history: deque[tuple[float, ...]] = deque([tuple(self.joints.q)], maxlen=HISTORY)
        self._starts_at_s = math.inf
        self._stopped_at_s = 0.0
        self._command_written_s = dict.fromkeys(COMMAND_REGISTERS, -math.inf)
        self._tcp_of: tuple[float, ...] = ()
        self._tcp: Rows = np.eye(4).tolist()
        self._has_tool = False
        self._tcp_speed_known = False
        self._publish_states()
        self._publish_motion()
        self.publish_tcp()

    # --- one cycle

    def tick(self) -> None:
        """Execute one cycle."""
        self.cycles += 1
        self.time_s = self.cycles * CYCLE_S
        if self.time_s >= self._starts_at_s:
            self._starts_at_s = math.inf
            self._set_runtime(RuntimeState.PLAYING)
        if self.runtime == RuntimeState.PLAYING and self.program is not None:
            try:
                self.program.cycle(self)
            except ProgramEnded as reason:
                if str(reason):
                    self.log(f"program stopped: {reason}")
                self.stop_program()
        self.motion_done = self.motion.step(self.joints, CYCLE_S)
        for index in range(ur5e.JOINTS):
            angle, speed = self.joints.q[index], self.joints.qd[index]
            if abs(angle) > POSITION_LIMIT_RAD and angle * speed > 0.0:
                self.protective_stop(f"joint {index} is beyond its range at {math.degrees(angle):.1f} degrees")
        self.history.append(tuple(self.joints.q))
        self._publish_motion()
        if self.tcp_wanted:
            self.publish_tcp()
        else:
            self._tcp_speed_known = False

    # --- inputs

    def write_inputs(self, values: dict[str, Value]) -> None:
        """Set input variables that a client has sent."""
        self.registers.update(values)
        for name in COMMAND_REGISTERS:
            if name in values:
                self._command_written_s[name] = self.time_s
                self.note("rtde", f"command {values[name]}")

    def note(self, port: str, words: str) -> None:
        """Record a request of a client."""
        self.orders.append(Order(self.time_s, port, words))

    def since_command_s(self, register: str) -> float:
        """Time since a command register was last written [s]; infinite if it never was."""
        return self.time_s - self._command_written_s[register]

    # --- motion

    def move(self, motion: Motion) -> None:
        """Start another motion."""
        self.motion = motion
        self.motion_done = False

    def _brake(self) -> None:
        if not self.joints.at_rest:
            self.move(Brake(self.config.stop_deceleration_rad_s2))
        else:
            self.move(Rest())

    # --- program

    def load_program(self, program: Program) -> None:
        """Start an uploaded program, in place of the running one."""
        if self.safety != SafetyMode.NORMAL or self.robot_mode != RobotMode.RUNNING:
            self.log(f"program {program.name!r} not started: {self.safety.name}, {self.robot_mode.name}")
            return
        if self.runtime != RuntimeState.STOPPED:
            self.stop_program()
        self.program = program
        self._starts_at_s = self.time_s + self.config.start_delay_s

    def stop_program(self) -> None:
        """Stop the program; the arm comes to rest."""
        self.program = None
        self._starts_at_s = math.inf
        self._set_runtime(RuntimeState.STOPPED)
        self._brake()

    def pause_program(self) -> bool:
        """Pause the program and the arm; return whether a program was running."""
        if self.runtime != RuntimeState.PLAYING:
            return False
        self._set_runtime(RuntimeState.PAUSED)
        self._brake()
        return True

    def play_program(self) -> bool:
        """Resume a paused program; return whether there was one and the robot can move."""
        able = self.safety == SafetyMode.NORMAL and self.robot_mode == RobotMode.RUNNING
        if not able or self.runtime != RuntimeState.PAUSED or self.program is None:
            return False
        self._set_runtime(RuntimeState.PLAYING)
        self.program.resume(self)
        return True

    # --- safety

    @property
    def stopped_for_safety(self) -> bool:
        """Whether a protective or emergency stop is active."""
        return self.safety != SafetyMode.NORMAL

    def protective_stop(self, reason: str) -> None:
        """Stop at once and pause the program, as after a collision or an invalid target."""
        if self.safety != SafetyMode.NORMAL:
            return
        self.log(f"protective stop: {reason}")
        self.safety = SafetyMode.PROTECTIVE_STOP
        self._stopped_at_s = self.time_s
        self._starts_at_s = math.inf
        if not self.pause_program():
            self._brake()
        self._publish_states()

    def unlock_protective_stop(self) -> bool:
        """Release a protective stop; return whether none is left: too little time may have passed since it happened.

        An emergency stop is none, and stays.
        """
        if self.safety == SafetyMode.PROTECTIVE_STOP:
            if self.time_s - self._stopped_at_s < self.config.unlock_after_s:
                return False
            self.safety = SafetyMode.NORMAL
            self._publish_states()
        return True

    def emergency_stop(self) -> None:
        """Stop, end the program and switch the arm off, as by the emergency stop button."""
        if self.safety == SafetyMode.ROBOT_EMERGENCY_STOP:
            return
        self.log("emergency stop")
        self.safety = SafetyMode.ROBOT_EMERGENCY_STOP
        self.robot_mode = RobotMode.POWER_OFF
        self.stop_program()

    def clear_stops(self) -> None:
        """Release all stops and switch the arm on, as a person at the robot would; no program runs afterwards."""
        if self.safety != SafetyMode.NORMAL or self.robot_mode != RobotMode.RUNNING:
            self.stop_program()
        self.safety = SafetyMode.NORMAL
        self.set_power(RobotMode.RUNNING)

    def set_power(self, mode: RobotMode) -> bool:
        """Switch power and brakes; return whether the safety state allows it."""
        if self.safety != SafetyMode.NORMAL and mode != RobotMode.POWER_OFF:
            return False
        self.robot_mode = mode
        if mode != RobotMode.RUNNING:
            self.stop_program()
        self._publish_states()
        return True

    # --- kinematics

    def transform(self, q_rad: Sequence[float]) -> NDArray[np.float64]:
        """Transform of the flange in the base frame, shape (4, 4), for joint angles."""
        return ur5e.forward_kinematics(q_rad)

    def set_tcp(self, pose: Sequence[float]) -> None:
        """Set the pose of the tool centre point in the flange frame."""
        self.tcp_offset = transform_from_pose(pose)
        self._has_tool = any(pose)
        self._tcp_of = ()
        self._tcp_speed_known = False

    def publish_tcp(self) -> None:
        """Update pose and speed of the tool centre point in the outputs."""
        now = tuple(self.joints.q)
        speed: Sequence[float] = (0.0,) * ur5e.JOINTS
        if now != self._tcp_of:
            before = self._tcp
            flange = self.transform(now)
            self._tcp = (flange @ self.tcp_offset if self._has_tool else flange).tolist()
            pose = pose_from_rows(self._tcp)
            self.output.set("actual_TCP_pose", *pose)
            self.output.set("target_TCP_pose", *pose)
            if self._tcp_speed_known:
                speed = speed_between(before, self._tcp, CYCLE_S)
        self.output.set("actual_TCP_speed", *speed)
        self.output.set("target_TCP_speed", *speed)
        self._tcp_of = now
        self._tcp_speed_known = True

    # --- outputs

    def _publish_motion(self) -> None:
        joints, output = self.joints, self.output
        output.set("timestamp", self.time_s)
        output.set("target_q", *joints.q)
        output.set("target_qd", *joints.qd)
        output.set("target_qdd", *joints.qdd)
        output.set("actual_q", *joints.q)
        output.set("actual_qd", *joints.qd)

    def _set_runtime(self, state: RuntimeState) -> None:
        self.runtime = state
        self._publish_states()

    def _publish_states(self) -> None:
        powered = self.robot_mode != RobotMode.POWER_OFF
        running = self.runtime == RuntimeState.PLAYING
        self.output.set("runtime_state", self.runtime)
        self.output.set("robot_mode", self.robot_mode)
        self.output.set("joint_mode", *(_JOINT_MODES[self.robot_mode],) * ur5e.JOINTS)
        self.output.set("safety_mode", self.safety)
        self.output.set("safety_status", self.safety)
        self.output.set("safety_status_bits", _SAFETY_BITS[self.safety])
        self.output.set("robot_status_bits", int(powered) | int(running) << 1)
