# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A simulated motor's control table and its rules, without a wire."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_sim.dynamixel import RAD_PER_TICK, Bus, Motor, OverloadLaw
from acts_sim.dynamixel.control_table import SIZE, XC330, XL330, Model
from acts_sim.dynamixel.drive import RAD_S_PER_VELOCITY_UNIT
from acts_sim.dynamixel.joints import FreeJoints
from acts_sim.dynamixel.motor import HardwareError, OperatingMode, StatusError
from acts_sim.dynamixel.packets import Instruction, Packet

MODE, TORQUE, ERROR, WATCHDOG, CURRENT, GOAL, PRESENT_CURRENT, POSITION = 11, 64, 70, 98, 102, 116, 126, 132


def write(motor: Motor, address: int, value: int, size: int = 1) -> int:
    return motor.write(address, value.to_bytes(size, "little", signed=value < 0))


def value(motor: Motor, address: int, size: int) -> int:
    return int.from_bytes(motor.read(address, size)[1], "little", signed=True)


def holding(goal_ticks: int = 2048, cap_ma: int = 350) -> tuple[Motor, FreeJoints]:
    """A motor as the LEAP hand sets it up, on a free joint."""
    motor = Motor(XC330, 0)
    joints = FreeJoints([motor], [(0.0, math.tau)])
    assert write(motor, MODE, OperatingMode.CURRENT_BASED_POSITION) == 0
    for address, gain in ((84, 600), (82, 0), (80, 200)):
        assert write(motor, address, gain, 2) == 0
    assert write(motor, CURRENT, cap_ma, 2) == 0
    assert write(motor, TORQUE, 1) == 0
    assert write(motor, GOAL, goal_ticks, 4) == 0
    return motor, joints


def steps(joints: FreeJoints, seconds: float) -> None:
    for _ in range(round(seconds / 0.002)):
        joints.step(0.002)


def test_the_eeprom_is_locked_while_the_torque_is_on() -> None:
    motor, _ = holding()
    assert write(motor, MODE, OperatingMode.POSITION) == StatusError.ACCESS
    assert motor["operating_mode"] == OperatingMode.CURRENT_BASED_POSITION


def test_another_mode_brings_back_the_gains_and_the_goal_current_of_the_start() -> None:
    motor, _ = holding()
    write(motor, TORQUE, 0)
    assert write(motor, MODE, OperatingMode.EXTENDED_POSITION) == 0
    assert (motor["position_p_gain"], motor["position_d_gain"], motor["goal_current"]) == (1100, 500, 2352)


def test_another_mode_ends_the_profile_and_keeps_goals_within_the_limits() -> None:
    motor, _ = holding()
    write(motor, TORQUE, 0)
    for address, number, size in ((36, 500, 2), (38, 800, 2), (108, 7, 4), (112, 50, 4), (78, 9, 2), (88, 8, 2)):
        assert write(motor, address, number, size) == 0
    assert write(motor, MODE, OperatingMode.EXTENDED_POSITION) == 0
    assert (motor["profile_acceleration"], motor["profile_velocity"], motor["feedforward_2nd_gain"]) == (0, 0, 0)
    assert motor["velocity_p_gain"] == XC330.registers["velocity_p_gain"].initial
    assert (motor["goal_pwm"], motor["goal_current"]) == (500, 800)
    motor.reboot()
    assert (motor["goal_pwm"], motor["goal_current"]) == (500, 800)


def test_a_motor_moves_by_its_own_threshold_and_as_long_as_its_profile_lasts() -> None:
    motor, joints = holding()
    motor.shaft.velocity_rad_s = 20 * RAD_S_PER_VELOCITY_UNIT
    assert motor["moving"] == 1
    write(motor, TORQUE, 0)
    assert write(motor, 24, 30, 4) == 0
    assert motor["moving"] == 0
    motor.shaft.velocity_rad_s = 0.0
    joints.blocked.add(0)
    write(motor, TORQUE, 1)
    write(motor, 112, 50, 4)  # 800 pulses/s
    write(motor, GOAL, 2448, 4)
    steps(joints, 0.45)
    assert motor["moving"] == 1
    steps(joints, 0.1)
    assert motor["moving"] == 0


def test_an_action_without_a_write_that_waits_for_it_is_an_error() -> None:
    motor = Motor(XC330, 3)
    assert motor.action() == StatusError.INSTRUCTION
    assert motor.register_write(bytes([65, 0, 1])) == 0
    assert (motor.action(), motor["led"]) == (0, 1)
    assert motor.action() == StatusError.INSTRUCTION


def test_a_goal_is_reached_and_kept() -> None:
    motor, joints = holding(goal_ticks=2400)
    steps(joints, 1.5)
    assert abs(motor["present_position"] - 2400) <= 10
    assert not motor["moving"]


def test_the_current_is_capped_and_its_sign_is_that_of_the_torque() -> None:
    motor, joints = holding(goal_ticks=1000, cap_ma=300)
    joints.blocked.add(0)
    steps(joints, 0.1)
    assert value(motor, PRESENT_CURRENT, 2) == -300
    assert motor.torque_nm == pytest.approx(-300 * 0.93 / 1800)


def test_the_torque_fades_with_speed() -> None:
    motor, joints = holding(goal_ticks=4000, cap_ma=2352)
    motor.shaft.velocity_rad_s = XC330.no_load_speed_rad_s
    motor.step(0.002)
    assert motor.torque_nm == 0.0
    steps(joints, 2.0)
    assert abs(motor["present_position"] - 4000) <= 10


def test_a_profile_limits_the_speed() -> None:
    motor, joints = holding()
    write(motor, GOAL, 2048, 4)
    write(motor, 112, 50, 4)  # 50 x 0.229 rpm, 1.2 rad/s
    write(motor, GOAL, 3000, 4)
    fastest = 0.0
    for _ in range(1000):
        joints.step(0.002)
        fastest = max(fastest, motor.shaft.velocity_rad_s)
    assert fastest == pytest.approx(50 * 0.023981, rel=0.25)
    assert abs(motor["present_position"] - 3000) <= 10


def test_the_bus_watchdog_stops_the_motor_and_locks_its_goals() -> None:
    motor, joints = holding(goal_ticks=4000)
    assert write(motor, WATCHDOG, 5) == 0  # 100 ms
    steps(joints, 0.3)
    assert motor["bus_watchdog"] == 255
    stopped_at = motor["present_position"]
    assert stopped_at < 3900
    assert write(motor, GOAL, 2048, 4) == StatusError.DATA_RANGE
    steps(joints, 0.5)
    assert abs(motor["present_position"] - stopped_at) < 120  # it brakes, and holds
    assert write(motor, WATCHDOG, 0) == 0
    assert write(motor, GOAL, 2048, 4) == 0


def in_current_mode(goal_ma: int) -> tuple[Motor, FreeJoints]:
    """A motor that pushes with a current, on a free joint; 0: with that of the start."""
    motor = Motor(XC330, 0)
    joints = FreeJoints([motor], [(0.0, math.tau)])
    assert write(motor, MODE, OperatingMode.CURRENT) == 0
    if goal_ma:
        assert write(motor, CURRENT, goal_ma, 2) == 0
    assert write(motor, TORQUE, 1) == 0
    return motor, joints


def test_the_bus_watchdog_ends_the_current_and_only_0_clears_it() -> None:
    motor, joints = in_current_mode(100)
    assert write(motor, WATCHDOG, 5) == 0  # 100 ms
    steps(joints, 0.05)
    assert motor["present_current"] == 100
    steps(joints, 0.1)
    assert motor["bus_watchdog"] == 255
    assert motor["present_current"] == 0
    assert motor.torque_nm == 0.0
    assert write(motor, CURRENT, 100, 2) == StatusError.DATA_RANGE
    assert write(motor, WATCHDOG, 5) == StatusError.DATA_RANGE
    assert motor["bus_watchdog"] == 255
    assert write(motor, WATCHDOG, 0) == 0
    steps(joints, 0.1)
    assert motor["present_current"] == 0
    assert write(motor, WATCHDOG, 5) == 0
    assert write(motor, CURRENT, 100, 2) == 0


def test_in_current_mode_no_current_flows_before_there_is_a_goal() -> None:
    motor, joints = in_current_mode(0)
    steps(joints, 0.1)
    assert (motor["goal_current"], motor["present_current"]) == (0, 0)
    assert write(motor, CURRENT, 100, 2) == 0
    motor.reboot()
    assert motor["goal_current"] == 0
    assert Motor(XC330, 0, operating_mode=OperatingMode.CURRENT)["goal_current"] == 0
    assert write(motor, MODE, OperatingMode.POSITION) == 0
    assert motor["goal_current"] == 2352


def test_a_current_limit_that_is_lowered_later_limits_the_goal_in_current_mode() -> None:
    motor, joints = in_current_mode(-300)
    assert write(motor, TORQUE, 0) == 0
    assert write(motor, 38, 200, 2) == 0
    assert write(motor, TORQUE, 1) == 0
    steps(joints, 0.002)
    assert motor["present_current"] == -200


def test_an_overload_switches_off_until_a_reboot() -> None:
    motor, _ = holding()
    motor.fail(HardwareError.OVERLOAD)
    assert motor["torque_enable"] == 0
    assert motor.alert == StatusError.ALERT
    assert write(motor, TORQUE, 1) == StatusError.RESULT_FAIL
    motor.reboot()
    assert motor["hardware_error_status"] == 0
    assert motor["operating_mode"] == OperatingMode.CURRENT_BASED_POSITION  # EEPROM is kept
    assert write(motor, TORQUE, 1) == 0


def test_heat_beyond_the_limit_is_an_error() -> None:
    motor, _ = holding()
    write(motor, TORQUE, 0)
    assert write(motor, 31, 30) == 0
    motor.step(0.002)
    assert motor["hardware_error_status"] == HardwareError.OVERHEATING


def test_scattered_registers_are_read_together_through_the_indirect_addresses() -> None:
    motor, joints = holding(goal_ticks=2300)
    wanted = [*range(126, 136), 70, 146]
    for k, address in enumerate(wanted):
        assert write(motor, 168 + 2 * k, address, 2) == 0
    steps(joints, 0.2)
    motor.fail(HardwareError.INPUT_VOLTAGE)
    error, data = motor.read(208, len(wanted))
    assert error == 0
    assert data[:10] == motor.read(126, 10)[1]
    assert data[10] == HardwareError.INPUT_VOLTAGE
    assert data[11] == motor["present_temperature"]


@pytest.mark.parametrize(
    ("address", "data", "error"),
    [
        (0, b"\x01\x02", StatusError.ACCESS),  # read only
        (14, b"\x01", StatusError.ACCESS),  # nothing there
        (116, b"\x00\x01", StatusError.DATA_LENGTH),  # half a register
        (84, (20000).to_bytes(2, "little"), StatusError.DATA_RANGE),
        (11, b"\x01", StatusError.DATA_RANGE),  # a mode that is not simulated
        (116, (5000).to_bytes(4, "little"), StatusError.DATA_LIMIT),  # beyond the range of position control
        (104, (-351).to_bytes(4, "little", signed=True), StatusError.DATA_LIMIT),  # beyond the velocity limit
        (255, b"\x00\x00", StatusError.DATA_RANGE),
    ],
)
def test_what_may_not_be_written_is_refused_by_number(address: int, data: bytes, error: int) -> None:
    assert Motor(XC330, 3).write(address, data) == error


def test_the_small_motor_is_another_model() -> None:
    motor = Motor(XL330, 3)
    assert (motor["model_number"], motor["goal_current"], motor["position_p_gain"]) == (1200, 1750, 400)
    assert write(motor, CURRENT, 1751, 2) == StatusError.DATA_RANGE


@pytest.mark.parametrize(
    ("model", "limit", "gain"),
    [(XC330, 350, 50), (XL330, 445, 180)],
)
def test_velocities_are_limited_as_the_manual_of_the_model_says(model: Model, limit: int, gain: int) -> None:
    motor = Motor(model, 3)
    assert (motor["velocity_limit"], motor["velocity_p_gain"]) == (limit, gain)
    assert write(motor, 104, limit, 4) == 0
    assert write(motor, 104, limit + 1, 4) == StatusError.DATA_LIMIT


@given(st.integers(0, SIZE), st.binary(max_size=30), st.integers(0, SIZE), st.integers(0, SIZE))
def test_no_write_or_read_breaks_a_motor(address: int, data: bytes, start: int, size: int) -> None:
    motor, joints = holding()
    motor.write(address, data)
    joints.step(0.002)
    error, read = motor.read(start, size)
    assert len(read) == (0 if error else size)
    assert math.isfinite(motor.shaft.position_rad)
    assert abs(motor.torque_nm) <= XC330.stall_torque_nm


@given(st.integers(0, 255), st.sampled_from(list(Instruction)), st.binary(max_size=40))
def test_no_instruction_breaks_the_bus(motor_id: int, instruction: Instruction, parameters: bytes) -> None:
    bus = Bus(Motor(XC330, number) for number in range(4))
    answer = bus.handle(Packet(motor_id, instruction, parameters))
    assert answer.delay_s >= 0.0


def test_behind_a_silent_motor_nobody_answers_a_sync_read() -> None:
    bus = Bus(Motor(XC330, number, return_delay_time=0) for number in range(4))
    ask = Packet(0xFE, Instruction.SYNC_READ, bytes([132, 0, 4, 0, 0, 1, 2, 3]))
    whole = bus.handle(ask).data
    bus.lost.add(2)
    assert bus.handle(ask).data == whole[: len(whole) // 2]


@pytest.mark.parametrize(
    ("instruction", "parameters"),
    [
        (Instruction.SYNC_READ, bytes([132, 0, 4, 0, 0, 1, 2])),
        (Instruction.BULK_READ, bytes([0, 132, 0, 4, 0, 1, 132, 0, 4, 0, 2, 132, 0, 4, 0])),
    ],
)
def test_a_motor_that_answers_pings_only_is_silent_in_reads_of_several(
    instruction: Instruction, parameters: bytes
) -> None:
    bus = Bus(Motor(XC330, number, return_delay_time=0) for number in range(3))
    ask = Packet(0xFE, instruction, parameters)
    whole = bus.handle(ask).data
    assert write(bus.motors[1], 68, 0) == 0
    assert bus.handle(ask).data == whole[: len(whole) // 3]
    assert write(bus.motors[1], 68, 1) == 0
    assert bus.handle(ask).data == whole


def test_a_position_in_pulses_is_that_of_the_shaft() -> None:
    motor = Motor(XC330, 0)
    motor.shaft.position_rad = -0.5
    motor.step(0.002)
    assert value(motor, POSITION, 4) == math.floor(-0.5 / RAD_PER_TICK)


def test_a_motor_that_stalls_for_long_switches_itself_off_where_that_is_wanted() -> None:
    for overload, expected in ((OverloadLaw(), 0), (OverloadLaw(0.5, 300.0), HardwareError.OVERLOAD)):
        motor = Motor(XC330, 0, overload=overload)
        write(motor, MODE, OperatingMode.CURRENT_BASED_POSITION)
        write(motor, CURRENT, 350, 2)
        write(motor, TORQUE, 1)
        write(motor, GOAL, 3000, 4)
        for _ in range(240):
            motor.step(0.002)  # nothing turns the shaft
        assert motor["hardware_error_status"] == 0
        for _ in range(20):
            motor.step(0.002)
        assert motor["hardware_error_status"] == expected
        assert motor["torque_enable"] == (0 if expected else 1)
        motor.reboot()
        assert motor["hardware_error_status"] == 0


def test_a_motor_does_what_its_secondary_id_is_told_and_does_not_answer() -> None:
    motors = [Motor(XC330, motor_id) for motor_id in range(3)]
    bus = Bus(motors)
    alone = bus.handle(Packet(0, Instruction.WRITE, bytes([65, 0, 0]))).data
    assert write(motors[2], 12, 0) == 0
    assert bus.handle(Packet(0, Instruction.WRITE, bytes([65, 0, 1]))).data == alone
    assert [motor["led"] for motor in motors] == [1, 0, 1]
    bus.handle(Packet(254, Instruction.SYNC_WRITE, bytes([65, 0, 1, 0, 0, 0])))
    assert [motor["led"] for motor in motors] == [0, 0, 0]
    bus.handle(Packet(254, Instruction.BULK_WRITE, bytes([0, 65, 0, 1, 0, 1])))
    assert [motor["led"] for motor in motors] == [1, 0, 1]
    # The EEPROM is written by the own ID alone; and none is one.
    bus.handle(Packet(0, Instruction.WRITE, bytes([9, 0, 7])))
    assert [motor["return_delay_time"] for motor in motors] == [7, 250, 250]
    assert write(motors[2], 12, 255) == 0
    bus.handle(Packet(0, Instruction.WRITE, bytes([65, 0, 0])))
    assert [motor["led"] for motor in motors] == [0, 0, 1]


@pytest.mark.parametrize(("address", "name"), [(36, "pwm_limit"), (100, "goal_pwm")])
def test_less_pwm_weakens_a_motor(address: int, name: str) -> None:
    motor, joints = holding(cap_ma=2352)
    write(motor, TORQUE, 0)
    assert write(motor, address, 177, 2) == 0
    assert motor[name] == 177
    write(motor, TORQUE, 1)
    assert write(motor, GOAL, 4000, 4) == 0
    joints.step(0.002)
    # A fifth of the voltage, and of the current at a stall.
    assert value(motor, PRESENT_CURRENT, 2) == 360
