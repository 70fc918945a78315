# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Settings of a hand's nodes that do not go together, and names of reflexes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from acts_control.hand.control import HandLoopConfig, HandSupervisor, SupervisorConfig
from acts_control.hand.description import LEAP_RIGHT, HandKinematics
from acts_control.hand.nodes.cmd_leap import CmdLeapBus
from acts_control.hand.nodes.hand_node import HandSettings
from acts_control.hand.nodes.reflexes_node import HandReflexesSettings
from acts_control.hand.reflexes import REFLEXES, HandToHandConfig, make_reflexes
from acts_core.errors import SettingsError

BOTH_NODES = pytest.mark.parametrize("settings", [HandSettings, HandReflexesSettings])


@BOTH_NODES
@pytest.mark.parametrize(
    ("rate_hz", "motor_watchdog_s", "answer_timeout_ms", "least_s", "otherwise"),
    [
        (10.0, 0.1, 16.0, "0.2", " or raise rate_hz"),
        (10.0, 0.133, 4.0, "0.2", " or raise rate_hz"),
        (60.0, 0.03, 4.0, "0.03334", " or raise rate_hz"),  # 1/60 s twice, rounded up
        (100.0, 0.043, 16.0, "0.04401", " or raise rate_hz or lower answer_timeout_ms"),
        # Another rate does not help where the wait alone is too long.
        (250.0, 0.2, 150.0, "0.306", " or lower answer_timeout_ms"),
    ],
)
def test_a_watchdog_that_one_lost_reply_sets_off_is_refused(
    settings: type, rate_hz: float, motor_watchdog_s: float, answer_timeout_ms: float, least_s: str, otherwise: str
) -> None:
    given = {"rate_hz": rate_hz, "answer_timeout_ms": answer_timeout_ms}
    told = rf"motor_watchdog_s = {motor_watchdog_s:g}: .* raise motor_watchdog_s to {least_s}{otherwise}$"
    with pytest.raises(SettingsError, match=told):
        settings(**given, motor_watchdog_s=motor_watchdog_s)
    assert settings(**given, motor_watchdog_s=float(least_s)).rate_hz == rate_hz, "the advice can be followed"


@BOTH_NODES
@pytest.mark.parametrize(
    "values",
    [
        {"rate_hz": 10.0},
        {"rate_hz": 10.0, "motor_watchdog_s": 0.0},
        # It has no motors of its own.
        {"rate_hz": 10.0, "motor_watchdog_s": 0.02, "interface": "cmd_leap"},
    ],
)
def test_a_rate_at_which_the_motors_hear_often_enough_is_taken(settings: type, values: dict[str, Any]) -> None:
    assert settings(**values).rate_hz == values["rate_hz"]


@pytest.mark.parametrize("settings", [HandSettings, HandReflexesSettings, HandLoopConfig])
def test_silence_that_begins_with_a_single_lost_answer_is_refused(settings: type) -> None:
    with pytest.raises(
        SettingsError, match=r"silence_s = 0\.15: .* rate_hz = 10.*: raise silence_s to 0\.2, or rate_hz to 13\.34"
    ):
        settings(rate_hz=10.0, silence_s=0.15)
    assert settings(rate_hz=13.34, silence_s=0.15).silence_s == 0.15


@pytest.mark.parametrize("settings", [HandSettings, HandReflexesSettings, HandLoopConfig])
def test_a_command_that_would_be_old_before_it_is_followed_is_refused(settings: type) -> None:
    told = r"command_stale_after_s = 0\.1: .* rate_hz = 10 .*: raise command_stale_after_s to 0\.2, or rate_hz to 20$"
    with pytest.raises(SettingsError, match=told):
        settings(rate_hz=10.0, command_stale_after_s=0.1)
    assert settings(rate_hz=20.0, command_stale_after_s=0.1).rate_hz == 20.0


@pytest.mark.parametrize("settings", [SupervisorConfig, HandReflexesSettings])
def test_a_grip_at_which_fingers_give_way_is_refused(settings: type) -> None:
    with pytest.raises(SettingsError, match=r"grip_force_n = 5: allowed is less than max_force_n = 5"):
        settings(grip_force_n=5.0, max_force_n=5.0)
    assert settings(grip_force_n=4.9, max_force_n=5.0).grip_force_n == 4.9


def test_a_grip_current_that_no_motor_is_given_is_refused() -> None:
    told = r"max_grip_current_ma = 340: .* max_current_ma = 340.*: lower max_grip_current_ma or raise max_current_ma$"
    with pytest.raises(SettingsError, match=told):
        HandReflexesSettings(max_current_ma=340)
    with pytest.raises(SettingsError, match=r"max_grip_current_ma = 900: "):
        HandReflexesSettings(max_grip_current_ma=900.0)
    assert HandReflexesSettings(max_current_ma=341).max_current_ma == 341
    # There it has no effect anyway: the LEAP team's node limits the current.
    assert HandReflexesSettings(max_current_ma=100, interface="cmd_leap").max_current_ma == 100
    # The plain hand has no grip.
    assert HandSettings(max_current_ma=100).max_current_ma == 100


@BOTH_NODES
def test_motors_at_no_port_are_refused(settings: type) -> None:
    for port in ("", " "):
        with pytest.raises(SettingsError, match="port is empty: needed is the serial port"):
            settings(port=port)
    assert settings(port="", interface="cmd_leap").port == "", "it has no port"


def test_the_leap_teams_node_takes_no_hand_of_another_number_of_joints() -> None:
    fewer = replace(LEAP_RIGHT, joints=LEAP_RIGHT.joints[:15])
    with pytest.raises(SettingsError, match=r"interface = cmd_leap: .* 16 joints; leap_right has 15.*interface:=dynam"):
        CmdLeapBus(fewer, lambda angles_rad: None)


def test_another_hand_is_not_held_with_a_force_at_which_fingers_give_way() -> None:
    with pytest.raises(SettingsError, match=r"hand_to_hand_force_n = 5: .* less than 5\.1"):
        HandToHandConfig(hand_to_hand_force_n=5.0, hand_to_hand_max_force_n=8.5)
    with pytest.raises(SettingsError, match=r"hand_to_hand_deadband_n = 0\.5 it has to be less than 5\.4"):
        HandToHandConfig(hand_to_hand_force_n=5.0, hand_to_hand_max_force_n=9.0, hand_to_hand_deadband_n=0.5)
    assert HandToHandConfig(hand_to_hand_force_n=5.0, hand_to_hand_max_force_n=9.0).hand_to_hand_force_n == 5.0


@pytest.mark.parametrize(
    ("names", "given", "told"),
    [
        (
            "sharp slip sphere",
            {"max_force_n": 1.5},
            r"sphere_roll_force_n = 1\.5: allowed is less than max_force_n = 1\.5",
        ),
        (
            "sphere",
            {"sphere_force_n": 3.0, "max_force_n": 2.0},
            r"sphere_force_n = 3: allowed is less than max_force_n = 2",
        ),
        ("trap", {"max_force_n": 2.0}, r"trap_force_n = 2: allowed is less than max_force_n = 2"),
        ("hand_to_hand", {"max_force_n": 0.7}, r"hand_to_hand_force_n = 0\.8: allowed is less than max_force_n = 0\.7"),
        (
            "hand_to_hand",
            {"grip_force_n": 6.0},
            r"grip_force_n = 6: with the reflex hand_to_hand allowed is less than 6, ",
        ),
    ],
)
def test_a_force_at_which_fingers_give_way_is_refused_of_reflexes_that_act(
    names: str, given: dict[str, float], told: str
) -> None:
    settings: Any = HandReflexesSettings(**given)
    with pytest.raises(SettingsError, match=told):
        HandSupervisor(HandKinematics(LEAP_RIGHT), make_reflexes(names, settings), settings)
    HandSupervisor(HandKinematics(LEAP_RIGHT), make_reflexes("sharp slip", settings), settings)


def test_a_reflex_that_does_not_exist_is_refused_with_the_nearest_name() -> None:
    with pytest.raises(SettingsError, match="did you mean 'sphere'"):
        make_reflexes("slip sphre", None)


@pytest.mark.parametrize("names", ["none", " none ", ""])
def test_none_is_no_reflex(names: str) -> None:
    assert make_reflexes(names, None) == {}
    with pytest.raises(SettingsError, match=f"unknown key 'none'; known are {', '.join(REFLEXES)}$"):
        make_reflexes("slip none", None)
