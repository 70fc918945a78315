# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the controller says of itself, in the numbers of RTDE, and the same in words."""

from __future__ import annotations

from math import isfinite
from typing import NamedTuple

from acts_control.robots.base import RobotReading
from acts_control.robots.ur.config import UrConfig
from acts_core.robots import ur5e

# safety_status_bits that end motion, in the order in which they are told.
_SAFETY_BITS = (
    (1 << 7 | 1 << 6 | 1 << 5, "emergency stop"),
    (1 << 2, "protective stop"),
    (1 << 4, "safeguard stop"),
    (1 << 8, "safety violation"),
    (1 << 9, "safety fault"),
    (1 << 3, "recovery mode"),
    (1 << 10, "stopped due to safety"),
)

_PLAYING = 2
_RUNTIME_NAMES = {0: "stopping", 1: "stopped", _PLAYING: "playing", 3: "pausing", 4: "paused", 5: "resuming"}

_RUNNING = 7
_MODE_NAMES = {
    -1: "there is no controller",
    0: "it is not connected to its controller",
    1: "its safety settings wait to be confirmed",
    2: "it is booting",
    3: "it is off",
    4: "it is on, but not ready",
    5: "its brakes are on",
    6: "it is guided by hand",
    8: "its firmware is being updated",
}

_UNKNOWN = float("nan")


class UrState(NamedTuple):
    """What the controller last told.

    Attributes
    ----------
    connected : bool
    timestamp_s : float
        The controller's clock [s].
    q_rad : tuple of float
        Joint angles, base to wrist 3 [rad].
    safety_bits, runtime_state, robot_mode : int
        safety_status_bits, runtime_state and robot_mode.
    silent_s : float
        How long it had told nothing before that [s].
    """

    connected: bool
    timestamp_s: float
    q_rad: tuple[float, ...]
    safety_bits: int
    runtime_state: int
    robot_mode: int = _RUNNING
    silent_s: float = 0.0

    @property
    def safety_stop(self) -> str:
        """Which safety function holds the robot, in words; empty when none does."""
        return next((words for mask, words in _SAFETY_BITS if self.safety_bits & mask), "")

    @property
    def unready(self) -> str:
        """Why the arm cannot run a program, in words; empty when it is on and its brakes are released."""
        if self.robot_mode == _RUNNING:
            return ""
        return _MODE_NAMES.get(self.robot_mode, f"its mode is {self.robot_mode}, needed is {_RUNNING}")

    @property
    def is_playing(self) -> bool:
        """Whether the robot's program runs."""
        return self.runtime_state == _PLAYING

    def reading(self, config: UrConfig, waiting_s: float = 0.0) -> RobotReading:
        """The same in the words of every robot.

        Parameters
        ----------
        config : UrConfig
            With the level pose and how the skin is mounted.
        waiting_s : float
            How long the oldest command has been waiting [s].
        """
        stopped = self._stopped()
        if len(self.q_rad) != ur5e.JOINTS or not all(map(isfinite, self.q_rad)):
            stopped = stopped or f"the robot reports joint angles {self.q_rad}"
            off_level, tilt = _UNKNOWN, (_UNKNOWN, _UNKNOWN)
        else:
            off_level = max(abs(angle - level) for angle, level in zip(self.q_rad, config.level_q_rad, strict=True))
            tilt = ur5e.tilt_of(self.q_rad, config.mount_yaw_rad)
        return RobotReading(
            self.connected, self.timestamp_s, self.q_rad, off_level, tilt, stopped, waiting_s, self.silent_s
        )

    def _stopped(self) -> str:
        if self.safety_stop:
            return f"robot: {self.safety_stop}"
        if not self.is_playing:
            state = _RUNTIME_NAMES.get(self.runtime_state, str(self.runtime_state))
            return f"the robot's program is not running ({state})"
        return ""
