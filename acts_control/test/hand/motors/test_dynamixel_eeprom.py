# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What another program has left in the motors, through the real `dynamixel_sdk`, on the simulated bus."""

from __future__ import annotations

import pytest
from dynamixel_bus import TIMEOUT_MS, Bus, torques

from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.motors import DynamixelConfig, HandError
from acts_control.hand.motors.dynamixel_port import DynamixelPort
from acts_control.hand.motors.dynamixel_table import Register

pytestmark = pytest.mark.slow

DRIVE_MODE, SECONDARY_ID, HOMING_OFFSET = Register(10, 1), Register(12, 1), Register(20, 4)
PWM_LIMIT, CURRENT_LIMIT, GOAL_PWM = Register(36, 2), Register(38, 2), Register(100, 2)
MAX_POSITION, STARTUP, SHUTDOWN = Register(48, 4), Register(60, 1), Register(63, 1)
PROFILE_ACCELERATION, PROFILE_VELOCITY = Register(108, 4), Register(112, 4)


def leave(bus: Bus, register: Register, values: dict[int, int]) -> None:
    """Another program writes a register of motors, by their numbers, and ends."""
    port = DynamixelPort(DynamixelConfig(port=str(bus.link), answer_timeout_ms=TIMEOUT_MS))
    port.open()
    for motor_id, value in values.items():
        port.write(LEAP_RIGHT.joints[motor_id], register, value % (1 << 8 * register.size))
    port.close()


def left(bus: Bus, register: Register) -> set[int]:
    """What all motors have in a register."""
    port = DynamixelPort(DynamixelConfig(port=str(bus.link), answer_timeout_ms=TIMEOUT_MS))
    port.open()
    values = {port.read(joint, register) for joint in LEAP_RIGHT.joints}
    port.close()
    return values


@pytest.mark.parametrize(
    ("register", "values", "told"),
    [
        (
            DRIVE_MODE,
            {3: 1, 12: 5},
            r"they turn the other way \(drive mode, .*10, bit 0\): 3 \(index_dip\), 12 \(thumb_cmc\)\. ",
        ),
        (DRIVE_MODE, {0: 8}, r"a goal switches their torque on \(drive mode, .*10, bit 3\): 0 \(index_mcp_side\)\. "),
        (HOMING_OFFSET, {5: -100}, r"their zero is elsewhere \(homing offset, .*20\): 5 \(middle_mcp_forward\)\. "),
        (
            STARTUP,
            {9: 1},
            r"power switches their torque on \(startup configuration, .*60, bit 0\): 9 \(ring_mcp_forward\)\. ",
        ),
    ],
)
def test_motors_that_would_move_otherwise_than_they_are_told_are_refused(
    bus: Bus, register: Register, values: dict[int, int], told: str
) -> None:
    leave(bus, register, values)
    hand = bus.hand()
    with pytest.raises(HandError, match=rf"{told}.*DYNAMIXEL Wizard.*zero_rad and direction") as refused:
        hand.connect()
    named = [joint.name for joint in LEAP_RIGHT.joints if f"({joint.name})" in str(refused.value)]
    assert named == [LEAP_RIGHT.joints[motor_id].name for motor_id in values]
    assert torques(bus) == {0}
    # As the message says: it is mended, and the hand connects.
    hand.close()
    leave(bus, register, dict.fromkeys(values, 0))
    assert bus.hand().connect() == []


def test_a_motor_that_does_what_another_is_told_is_refused_with_both_names(bus: Bus) -> None:
    # Its own number, one that no motor has, and those from 253 on lead nowhere.
    leave(bus, SECONDARY_ID, {3: 5, 6: 6, 8: 200, 9: 253, 12: 0})
    hand = bus.hand()
    told = (
        r"do what another motor is told, too \(secondary ID, register 12\): 3 \(index_dip\) follows 5 "
        r"\(middle_mcp_forward\), 12 \(thumb_cmc\) follows 0 \(index_mcp_side\)\. .*a secondary ID to 255"
    )
    with pytest.raises(HandError, match=told):
        hand.connect()
    assert torques(bus) == {0}
    hand.close()
    leave(bus, SECONDARY_ID, {3: 255, 12: 255})
    assert bus.hand().connect() == []


def test_all_that_is_wrong_is_told_at_once(bus: Bus) -> None:
    leave(bus, DRIVE_MODE, {3: 1})
    leave(bus, HOMING_OFFSET, {5: 100})
    with pytest.raises(HandError, match=r"bit 0\): 3 \(index_dip\); .*20\): 5 \(middle_mcp_forward\)\. "):
        bus.hand().connect()


def test_motors_that_allow_less_current_are_refused_by_name(bus: Bus) -> None:
    leave(bus, CURRENT_LIMIT, {3: 340, 12: 300})
    told = r"max_current_ma = 350: .*register 38.* 300 mA: 3 \(index_dip\), 12 \(thumb_cmc\); lower max_current_ma"
    hand = bus.hand()
    with pytest.raises(HandError, match=told):
        hand.connect()
    hand.close()
    assert bus.hand(max_current_ma=300).connect() == []


def test_motors_whose_pwm_is_limited_are_told_by_name(bus: Bus) -> None:
    leave(bus, PWM_LIMIT, {3: 600, 12: 443})
    (told,) = bus.hand().connect()
    assert "weaker and slower" in told
    assert "the most to 50 %: 3 (index_dip), 12 (thumb_cmc): set it to 885" in told


def test_a_goal_pwm_that_another_program_has_left_weakens_nothing(bus: Bus) -> None:
    hand = bus.hand()
    assert hand.connect() == []  # from another mode, which would bring it back
    hand.close()
    leave(bus, GOAL_PWM, {3: 100})
    hand = bus.hand()
    assert hand.connect() == []
    hand.close()
    assert left(bus, GOAL_PWM) == {885}


def test_a_motor_that_would_not_protect_itself_is_told(bus: Bus) -> None:
    leave(bus, SHUTDOWN, {6: 52 - 32, 7: 0, 8: 53})
    (told,) = bus.hand().connect()
    assert "overheating, electrical shock or overload" in told
    assert "6 (middle_pip), 7 (middle_dip): " in told
    assert "(ring" not in told
    assert "52" in told


def test_limits_of_the_position_do_not_bind_current_based_position(bus: Bus) -> None:
    leave(bus, MAX_POSITION, {3: 2100})
    hand = bus.hand()
    assert hand.connect() == []
    hand.enable()
    hand.command([0.3] * 16)
    hand.read()  # behind the command on the bus
    assert bus.motors()[3]["goal_position"] > 2100


def test_a_profile_that_another_program_has_left_slows_nothing(bus: Bus) -> None:
    leave(bus, DRIVE_MODE, {3: 4})  # a profile by time: with none there is nothing of it
    leave(bus, PROFILE_ACCELERATION, {3: 1})
    leave(bus, PROFILE_VELOCITY, {3: 1})
    hand = bus.hand()
    assert hand.connect() == []
    hand.close()
    assert [left(bus, one) for one in (PROFILE_ACCELERATION, PROFILE_VELOCITY)] == [{0}, {0}]
