# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of a robot: refused where it could not be moved by them, or is none of this machine."""

from dataclasses import make_dataclass

import pytest

from acts_control.ball import LoopConfig
from acts_control.robots import ROBOTS, RobotKind, with_robots
from acts_control.robots.base import RobotConfig
from acts_control.robots.ur import UrConfig
from acts_core.errors import SettingsError
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
