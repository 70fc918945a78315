# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of a robot: refused where it could not be moved by them, or is none of this machine."""

import math
from dataclasses import make_dataclass

import pytest

from acts_control.ball import LoopConfig
from acts_control.robots import ROBOTS, RobotKind, with_robots
from acts_control.robots.base import RobotConfig
from acts_control.robots.ur import UrConfig
from acts_control.robots.ur.gate import JointGate
from acts_core.errors import SettingsError
from acts_core.robots import ur5e
from acts_core.settings import setting


def test_settings_of_the_robot_are_checked() -> None:
    with pytest.raises(SettingsError, match="control_rate_hz = 300: allowed is 125, 250, 500"):
        UrConfig(control_rate_hz=300)
    with pytest.raises(SettingsError, match=r"tilted by 1\.571 rad"):
        UrConfig(level_q_rad=(0.0, -1.5708, 1.5708, -1.5708, 0.0, 0.0))
    with pytest.raises(SettingsError, match="6 values"):
        UrConfig(level_q_rad=(0.0,))


def test_a_joint_step_that_the_limit_of_the_tilt_would_trip_is_refused() -> None:
    with pytest.raises(SettingsError, match=r"max_joint_step_rad = 0\.01: .* 125 .* = 1 allowed is 0\.01245 or more"):
        UrConfig(max_joint_step_rad=0.01)
    assert UrConfig(max_joint_step_rad=0.01245).max_joint_step_rad == 0.01245
    assert UrConfig(max_joint_step_rad=0.01, control_rate_hz=250).max_joint_step_rad == 0.01
    assert UrConfig(max_tilt_rate_rad_s=3.0).max_tilt_rate_rad_s == 3.0, "the default suits every rate of the tilt"


@pytest.mark.parametrize("mount_yaw_rad", [0.0, math.pi / 4, -0.3])
@pytest.mark.parametrize("max_joint_step_rad", [0.02, 0.05])
def test_the_longest_step_of_the_tilt_about_both_axes_passes_the_last_look_at_the_joints(
    mount_yaw_rad: float, max_joint_step_rad: float
) -> None:
    config = UrConfig(mount_yaw_rad=mount_yaw_rad, max_joint_step_rad=max_joint_step_rad)
    step_rad, gate = config.longest_step_rad, JointGate(config)
    for tilt_rad in ((0.0, 0.0), (step_rad, step_rad), (0.0, 0.0), (step_rad, -step_rad), (0.0, -2.0 * step_rad)):
        q_rad = list(config.level_q_rad)
        q_rad[3:5] = ur5e.wrist_angles_for_tilt(config.level_q_rad, *tilt_rad, mount_yaw_rad)
        assert gate.fault(q_rad) == ""
    # But not much shorter than it may be: a plate that is slower than its limit of the rate rolls the ball off.
    assert step_rad > 0.6 * max_joint_step_rad


@pytest.mark.parametrize("robot_ip", ["192.168.1.10", "127.evil.example.com", "localhost", '127."', ""])
def test_for_a_simulated_skin_only_a_robot_of_this_machine_is_controlled(robot_ip: str) -> None:
    for settings in (UrConfig, with_robots(LoopConfig)):
        with pytest.raises(SettingsError, match=r"nothing is controlled.*sim:=false"):
            settings(robot_ip=robot_ip, loopback_only=True)
        assert settings(robot_ip="127.0.6.5", loopback_only=True).robot_ip == "127.0.6.5"
        assert settings(robot_ip=robot_ip).robot_ip == robot_ip


@pytest.mark.parametrize("robot_ip", ["192.168..10", ".168.1.10", 70 * "a"])
def test_what_can_be_no_address_is_refused(robot_ip: str) -> None:
    with pytest.raises(SettingsError, match=r"robot_ip = .*: this can be no address.*give one such as 192\.168\.1\.10"):
        UrConfig(robot_ip=robot_ip)


def test_a_robot_with_a_parameter_that_another_has_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    own = [("level_q_rad", float, setting(0.0, "where it is level [rad]"))]
    kind = RobotKind(make_dataclass("Other", own, bases=(RobotConfig,), frozen=True), ROBOTS["ur5e"].make)
    monkeypatch.setitem(ROBOTS, "other", kind)
    with pytest.raises(SettingsError, match="'level_q_rad' is declared 2 times"):
        with_robots(LoopConfig)


def test_a_robot_whose_line_comes_first_is_not_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    other = RobotKind(make_dataclass("Other", [], bases=(RobotConfig,), frozen=True), ROBOTS["ur5e"].make)
    monkeypatch.setattr("acts_control.robots.registry.ROBOTS", {"other": other, **ROBOTS})
    settings = with_robots(LoopConfig)
    assert settings(robot="other").robot == "other"
    assert settings().robot == "ur5e"
