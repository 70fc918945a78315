"""What ends motion: old touch, a stopped robot, and the last gate before the joints."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

from acts_core.settings import Changeable, setting, validate
from acts_core.ur5e import JOINTS, WRIST_1, WRIST_2

# A stamp this far in the future belongs to another clock; its age would never grow.
_FUTURE_S = 0.05

# The four joints that do not tilt stay where they are.
_FIXED_RAD = 1e-6

# safety_status_bits of RTDE that end motion, in the order in which they are told.
_SAFETY_BITS = (
    (1 << 7 | 1 << 6 | 1 << 5, "emergency stop"),
    (1 << 2, "protective stop"),
    (1 << 4, "safeguard stop"),
    (1 << 8, "safety violation"),
    (1 << 9, "safety fault"),
    (1 << 3, "recovery mode"),
    (1 << 10, "stopped due to safety"),
)

RUNTIME_PLAYING = 2
"""runtime_state of RTDE while a program runs."""

_RUNTIME_NAMES = {0: "stopping", 1: "stopped", 2: "playing", 3: "pausing", 4: "paused", 5: "resuming"}


@dataclass(frozen=True)
class SafetyConfig:
    """Limits whose crossing ends motion."""

    touch_stale_after_s: float = setting(
        0.2, "when no contact message is younger, the plate is levelled [s]", minimum=0.005, maximum=1.0
    )
    touch_stop_after_s: float = setting(
        3.0,
        "and when that has lasted for longer, motion ends: STOPPED; where touch returns before, balancing goes on [s]",
        minimum=0.005,
        maximum=60.0,
    )
    ball_lost_after_s: float = setting(
        0.25,
        "messages but no valid estimate for longer: back to waiting for a ball, level [s]",
        minimum=0.0,
        maximum=10.0,
        changeable=Changeable.RUNNING,
    )
    robot_stale_after_s: float = setting(
        0.2,
        "the robot's clock standing still, or a command not being taken, for longer is a lost connection [s]",
        minimum=0.02,
        # After 2.5 s ur_rtde begins to connect anew by itself.
        maximum=2.0,
    )
    max_wrist_offset_rad: float = setting(
        0.14, "farthest wrist 1 and wrist 2 may go from the level pose [rad]", minimum=0.001, maximum=0.5
    )
    max_joint_step_rad: float = setting(
        0.05, "farthest a joint may go from one command to the next [rad]", minimum=1e-4, maximum=0.5
    )

    def __post_init__(self) -> None:
        validate(self)


def touch_age_s(now_ns: int, stamp_ns: int) -> float:
    """Age of a measurement [s]; infinite when its stamp lies in the future, which is a wrong clock, not fresh touch."""
    age_s = (now_ns - stamp_ns) * 1e-9
    return age_s if age_s >= -_FUTURE_S else float("inf")


class RobotReading(NamedTuple):
    """What the robot says of itself.

    Attributes
    ----------
    connected : bool
    timestamp_s : float
        The controller's clock [s].
    q_rad : tuple of float
        Joint angles, base to wrist 3 [rad].
    safety_bits, runtime_state : int
        As in RTDE: safety_status_bits and runtime_state.
    waiting_s : float
        How long the oldest command that has not been taken yet has been waiting [s].
    """

    connected: bool
    timestamp_s: float
    q_rad: tuple[float, ...]
    safety_bits: int
    runtime_state: int
    waiting_s: float = 0.0


def safety_stop(reading: RobotReading) -> str:
    """Which safety function holds the robot, in words; empty when none does."""
    for mask, words in _SAFETY_BITS:
        if reading.safety_bits & mask:
            return words
    return ""


class RobotWatch:
    """Finds out that the robot has stopped or is gone. (That servoJ returns True says nothing about it.)"""

    def __init__(self, config: SafetyConfig) -> None:
        self._config = config
        self._timestamp_s = float("nan")
        self._still_s = 0.0

    def step(self, reading: RobotReading, dt: float) -> str:
        """Why no command may follow, in words; empty when all is well.

        Parameters
        ----------
        reading : RobotReading
        dt : float
            Time since the last step [s].
        """
        loss = self.loss(reading, dt)
        if loss:
            return loss
        if reading.waiting_s > self._config.robot_stale_after_s:
            return f"the robot has not taken a command for {reading.waiting_s:.2f} s"
        stop = safety_stop(reading)
        if stop:
            return f"robot: {stop}"
        if reading.runtime_state != RUNTIME_PLAYING:
            state = _RUNTIME_NAMES.get(reading.runtime_state, str(reading.runtime_state))
            return f"the robot's program is not running ({state})"
        if len(reading.q_rad) != JOINTS or not all(map(isfinite, reading.q_rad)):
            return f"the robot reports joint angles {reading.q_rad}"
        return ""

    def loss(self, reading: RobotReading, dt: float) -> str:
        """That the robot is gone or stands still, in words; empty when it is there. To be called instead of `step`."""
        if not reading.connected:
            return "connection to the robot lost"
        self._still_s = self._still_s + dt if reading.timestamp_s == self._timestamp_s else 0.0
        self._timestamp_s = reading.timestamp_s
        if self._still_s > self._config.robot_stale_after_s:
            return f"no data from the robot for {self._still_s:.2f} s"
        return ""


class CommandGate:
    """The last look at joint angles before they are sent.

    Parameters
    ----------
    config : SafetyConfig
    level_q_rad : sequence [shape=(6,)]
        The level pose [rad].
    """

    def __init__(self, config: SafetyConfig, level_q_rad: Sequence[float]) -> None:
        self._config = config
        self._level = tuple(level_q_rad)
        self._last = self._level

    def fault(self, q_rad: Sequence[float]) -> str:
        """Why a command must not be sent, in words; empty when it may, and it then counts as sent."""
        if len(q_rad) != JOINTS:
            return f"command of {len(q_rad)} joints"
        for joint, (angle, level, last) in enumerate(zip(q_rad, self._level, self._last, strict=True)):
            if not isfinite(angle):
                return f"command for joint {joint} is {angle}"
            allowed = self._config.max_wrist_offset_rad if joint in (WRIST_1, WRIST_2) else _FIXED_RAD
            if abs(angle - level) > allowed:
                return (
                    f"command for joint {joint} is {angle - level:+.4f} rad off the level pose, allowed is {allowed:g}"
                )
            if abs(angle - last) > self._config.max_joint_step_rad:
                return (
                    f"command for joint {joint} jumps by {angle - last:+.4f} rad, "
                    f"allowed is {self._config.max_joint_step_rad:g}"
                )
        self._last = tuple(q_rad)
        return ""
