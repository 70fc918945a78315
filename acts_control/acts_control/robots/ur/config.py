# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of the UR5e: how it is reached, held and moved, and how far its joints may go."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, sqrt

from acts_control.robots.base import RobotConfig
from acts_core.errors import SettingsError
from acts_core.robots import ur5e
from acts_core.runtime import is_loopback
from acts_core.settings import rounded_up, setting

_RATES_HZ = (125, 250, 500)

# A pose further from level than this cannot be meant as the level one.
_LEVEL_TOLERANCE_RAD = 0.02

# The joints' limits are to be beyond those of the tilt by this factor, or the tilt's own limits would trip them.
_OFFSET_PER_TILT = 1.1


@dataclass(frozen=True)
class UrConfig(RobotConfig):
    """How the robot is reached and moved."""

    robot_ip: str = setting("127.0.0.1", "address of the UR5e's controller")
    servo_lookahead_s: float = setting(
        0.05, "lookahead of servoJ: shorter is quicker, longer is smoother [s]", minimum=0.03, maximum=0.2
    )
    servo_gain: float = setting(300.0, "gain of servoJ", minimum=100.0, maximum=2000.0)
    homing_speed_rad_s: float = setting(
        0.6, "joint speed on the way to the level pose [rad/s]", minimum=0.01, maximum=3.0
    )
    homing_acceleration_rad_s2: float = setting(
        1.5, "joint acceleration on the way to the level pose [rad/s^2]", minimum=0.01, maximum=10.0
    )
    robot_watchdog_s: float = setting(
        0.5,
        "when the robot hears nothing for longer, it ends its program by itself and stops, whatever it was doing [s]",
        minimum=0.1,
        maximum=5.0,
    )
    level_q_rad: tuple[float, ...] = setting(
        tuple(round(angle, 9) for angle in ur5e.LEVEL_Q_RAD),
        "joint angles with the plate level and the skin facing up, base to wrist 3 [rad]",
        minimum=-6.3,
        maximum=6.3,
        length=ur5e.JOINTS,
    )
    mount_yaw_rad: float = setting(
        0.0, "how far the skin is turned on the flange about its z axis [rad]", minimum=-6.3, maximum=6.3
    )
    max_wrist_offset_rad: float = setting(
        0.14, "farthest wrist 1 and wrist 2 may go from the level pose [rad]", minimum=0.001, maximum=0.5
    )
    max_joint_step_rad: float = setting(
        0.05, "farthest a joint may go from one command to the next [rad]", minimum=1e-4, maximum=0.5
    )

    @property
    def longest_step_rad(self) -> float:
        """How far the plate may tilt about each axis from one command to the next [rad]; both may turn at once."""
        return self.max_joint_step_rad / (_OFFSET_PER_TILT * sqrt(2.0))

    def __post_init__(self) -> None:
        RobotConfig.__post_init__(self)
        least = _OFFSET_PER_TILT * self.max_tilt_rad
        if self.max_wrist_offset_rad < least:
            raise SettingsError(
                f"max_wrist_offset_rad = {self.max_wrist_offset_rad:g}: allowed is {least:.4f} or "
                f"more, {_OFFSET_PER_TILT:g} times max_tilt_rad, or the limit of the tilt would trip it"
            )
        # Both axes may turn at once.
        least = _OFFSET_PER_TILT * sqrt(2.0) * self.max_tilt_rate_rad_s / self.control_rate_hz
        if self.max_joint_step_rad < least:
            raise SettingsError(
                f"max_joint_step_rad = {self.max_joint_step_rad:g}: with control_rate_hz = {self.control_rate_hz} and "
                f"max_tilt_rate_rad_s = {self.max_tilt_rate_rad_s:g} allowed is {rounded_up(least)} or more, or the "
                f"limit of the tilt's rate would trip it"
            )
        # What a simulated skin feels must not move a real arm.
        if self.loopback_only and not is_loopback(self.robot_ip):
            raise SettingsError(
                f"robot_ip = {self.robot_ip!r}: nothing is controlled, for the skin is simulated and this is no "
                "numeric address of this machine (127.0.0.1 to 127.255.255.254, ::1); "
                "with a real skin and robot give sim:=false"
            )
        if not _may_be_a_host(self.robot_ip):
            raise SettingsError(
                f"robot_ip = {self.robot_ip!r}: this can be no address and no name of a machine; "
                "give one such as 192.168.1.10"
            )
        if self.control_rate_hz not in _RATES_HZ:
            raise SettingsError(
                f"control_rate_hz = {self.control_rate_hz}: allowed is {', '.join(map(str, _RATES_HZ))}; "
                f"ur_rtde works in whole milliseconds"
            )
        tilt = ur5e.tilt_of(self.level_q_rad, self.mount_yaw_rad)
        if hypot(*tilt) > _LEVEL_TOLERANCE_RAD:
            raise SettingsError(
                f"level_q_rad = {self.level_q_rad}: the flange is tilted by {hypot(*tilt):.3f} rad there; "
                f"give a pose in which it faces straight up"
            )


def _may_be_a_host(name: str) -> bool:
    """Whether sockets take it, known or not. For others, such as 192.168..10, they raise what is no OSError."""
    try:
        name.encode("idna")
    except UnicodeError:
        return False
    return True
