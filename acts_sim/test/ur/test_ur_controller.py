# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The control script and the safety states of the simulated controller, cycle by cycle, without sockets."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.robots import ur5e
from acts_sim.ur import COMMANDS, Controller, ControlProgram, RobotMode, RuntimeState, SafetyMode, UrControllerConfig
from acts_sim.ur.ports import ScriptSession, dashboard, hooks
from acts_sim.ur.pose import transform_from_pose

READY, DONE = 1, 2


class Robot:
    """A controller with a program that runs, and the client's side of the registers."""

    def __init__(self, offset: int = 0) -> None:
        self.log: list[str] = []
        self.offset = offset
        self.controller = Controller(UrControllerConfig(start_delay_s=0.01, unlock_after_s=1.0), self.log.append)
        self.start()

    def start(self) -> None:
        self.write(0)
        self.controller.load_program(ControlProgram(COMMANDS, "rtde_control", self.offset))
        self.cycles(10)
        assert self.controller.runtime == RuntimeState.PLAYING

    def cycles(self, count: int) -> None:
        for _ in range(count):
            self.controller.tick()

    def write(self, command: int, doubles: list[float] | None = None, integer: int = 0) -> None:
        values: dict[str, int | float | tuple[int | float, ...]] = {
            f"input_int_register_{self.offset}": command,
            f"input_int_register_{1 + self.offset}": integer,
        }
        for index, value in enumerate(doubles or []):
            values[f"input_double_register_{index + self.offset}"] = float(value)
        self.controller.write_inputs(values)

    @property
    def status(self) -> int:
        return int(self.controller.output.get(f"output_int_register_{self.offset}")[0])

    def result(self) -> list[float]:
        return [float(self.controller.output.get(f"output_double_register_{i + self.offset}")[0]) for i in range(6)]

    def run(self, command: int, doubles: list[float] | None = None, integer: int = 0) -> int:
        """A blocking command from ready to clear; the number of cycles until it was done."""
        assert self.status == READY
        self.write(command, doubles, integer)
        cycles = 0
        while self.status != DONE:
            self.cycles(1)
            cycles += 1
            assert cycles < 5000
        self.cycles(3)
        assert self.status == DONE, "done stays until it is cleared"
        self.write(0)
        self.cycles(1)
        assert self.status == READY
        return cycles


def servo(target: list[float]) -> list[float]:
    return [*target, 0.0, 0.0, 0.002, 0.1, 300.0]


@pytest.mark.parametrize("offset", [0, 24])
def test_blocking_move(offset: int) -> None:
    robot = Robot(offset)
    target = [angle + 0.2 for angle in ur5e.LEVEL_Q_RAD]
    cycles = robot.run(1, [*target, 1.0, 2.0])
    assert robot.controller.joints.q == target
    assert cycles * 0.002 == pytest.approx(2 * math.sqrt(0.2 / 2.0), abs=0.01)
    assert robot.run(47) < 3
    assert robot.controller.output.get(f"output_int_register_{1 + offset}") == (1,)


def test_asynchronous_move_shows_its_progress() -> None:
    robot = Robot()

    def state() -> tuple[int, bool, int]:
        value = int(robot.controller.output.get("output_int_register_2")[0])
        return value >> 24 & 0x7F, bool(value & 0x8000), value & 0x7FFF

    assert state() == (0, False, 0)
    assert robot.run(1, [*[angle + 0.2 for angle in ur5e.LEVEL_Q_RAD], 1.0, 2.0], integer=1) <= 2
    assert state() == (1, True, 0)
    robot.cycles(1000)
    assert state() == (1, False, 0)
    assert robot.controller.joints.q[0] == pytest.approx(0.2)


def test_a_stop_breaks_off_an_asynchronous_move() -> None:
    robot = Robot()
    robot.run(1, [*[angle + 2.0 for angle in ur5e.LEVEL_Q_RAD], 1.0, 2.0], integer=1)
    robot.cycles(200)
    robot.run(34, [4.0])
    assert robot.controller.joints.at_rest
    assert 0.1 < robot.controller.joints.q[0] < 1.0
    assert not int(robot.controller.output.get("output_int_register_2")[0]) & 0x8000
    assert robot.controller.runtime == RuntimeState.PLAYING


def test_servo_keeps_following_and_stops() -> None:
    robot = Robot()
    target = list(ur5e.LEVEL_Q_RAD)
    target[3] += 0.1
    robot.write(11, servo(target))
    for _ in range(600):
        robot.cycles(1)
        assert robot.status == READY, "a stream is never answered with done"
    assert robot.controller.joints.q == pytest.approx(target, abs=1e-6)
    target[3] -= 0.5
    robot.write(11, servo(target))
    robot.cycles(60)
    assert abs(robot.controller.joints.qd[3]) > 0.5
    robot.run(16, [10.0])
    assert robot.controller.joints.at_rest
    assert abs(robot.controller.joints.q[3] - target[3]) > 0.01


def test_speed_and_speed_stop() -> None:
    robot = Robot()
    robot.write(9, [0.5, 0, 0, 0, 0, 0, 2.0, 0.0])
    robot.cycles(500)
    assert robot.controller.joints.qd[0] == pytest.approx(0.5)
    robot.run(15, [5.0])
    assert robot.controller.joints.at_rest


@pytest.mark.parametrize("other", [1, 9, 34])
def test_two_ways_of_moving_at_once_end_the_program(other: int) -> None:
    robot = Robot()
    robot.write(11, servo([angle + 0.5 for angle in ur5e.LEVEL_Q_RAD]))
    robot.cycles(20)
    robot.write(other, [*ur5e.LEVEL_Q_RAD, 1.0, 1.0])
    robot.cycles(300)
    assert robot.controller.runtime == RuntimeState.STOPPED
    assert robot.controller.joints.at_rest
    assert "another thread" in robot.log[-1]


def test_stop_script_and_upload_again() -> None:
    robot = Robot()
    robot.write(255)
    robot.cycles(1)
    assert robot.controller.runtime == RuntimeState.STOPPED
    robot.start()
    assert robot.status == READY


def test_a_command_that_is_not_simulated_ends_the_program_and_says_so() -> None:
    robot = Robot()
    robot.write(3, [0.0] * 8)
    robot.cycles(2)
    assert robot.controller.runtime == RuntimeState.STOPPED
    assert "command 3 is not simulated" in robot.log[-1]


def test_watchdog_ends_the_program_when_the_client_falls_silent() -> None:
    robot = Robot()
    robot.run(35, [10.0])
    for _ in range(20):
        robot.write(11, servo([angle + 1.0 for angle in ur5e.LEVEL_Q_RAD]))
        robot.cycles(10)
    before = robot.controller.runtime
    robot.cycles(150)
    assert (before, robot.controller.runtime) == (RuntimeState.PLAYING, RuntimeState.STOPPED)
    assert robot.controller.joints.at_rest
    assert "watchdog" in robot.log[-1]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 6.3, -1e300])
@pytest.mark.parametrize("command", [1, 11])
def test_impossible_targets_are_a_protective_stop(command: int, bad: float) -> None:
    robot = Robot()
    start = list(ur5e.LEVEL_Q_RAD)
    robot.write(11, servo([angle + 0.3 for angle in ur5e.LEVEL_Q_RAD]))
    robot.cycles(20)
    robot.run(16, [10.0])
    arguments = [*start, 1.0, 1.0, 0.002, 0.1, 300.0]
    arguments[2] = bad
    robot.write(command, arguments)
    robot.cycles(200)
    assert robot.controller.safety == SafetyMode.PROTECTIVE_STOP
    assert robot.controller.output.get("safety_status_bits") == (0x404,)
    assert robot.controller.runtime == RuntimeState.PAUSED
    assert robot.status == READY, "a paused script does not answer"
    assert all(math.isfinite(angle) for angle in robot.controller.joints.q)
    assert robot.controller.joints.at_rest


def test_speed_over_the_end_of_the_range_is_a_protective_stop() -> None:
    robot = Robot()
    robot.write(9, [3.0, 0, 0, 0, 0, 0, 10.0, 0.0])
    robot.cycles(2000)
    assert robot.controller.safety == SafetyMode.PROTECTIVE_STOP
    assert "beyond its range" in robot.log[-1]
    assert robot.controller.joints.at_rest
    assert robot.controller.joints.q[0] < 2 * math.pi + 0.6


def test_protective_stop_unlocks_after_its_time_and_play_goes_on() -> None:
    robot = Robot()
    controller = robot.controller
    target = [angle + 0.4 for angle in ur5e.LEVEL_Q_RAD]
    robot.write(1, [*target, 1.0, 2.0])
    robot.cycles(100)
    assert hooks.answer(controller, "protective_stop hand in the way") == "ok"
    robot.cycles(100)
    assert controller.joints.at_rest
    assert dashboard.answer(controller, "safetystatus") == "Safetystatus: PROTECTIVE_STOP"
    assert dashboard.answer(controller, "play") == "Failed to execute: play"
    assert dashboard.answer(controller, "unlock protective stop").startswith("Cannot unlock protective stop until 1s")
    robot.cycles(450)
    assert dashboard.answer(controller, "unlock protective stop") == "Protective stop releasing"
    assert controller.output.get("safety_status_bits") == (1,)
    robot.cycles(100)
    assert controller.joints.at_rest, "it does not move by itself"
    assert dashboard.answer(controller, "play") == "Starting program"
    robot.cycles(1000)
    assert controller.joints.q == target
    assert robot.status == DONE


def test_emergency_stop_switches_off_and_is_cleared() -> None:
    robot = Robot()
    controller = robot.controller
    robot.write(11, servo([angle + 0.5 for angle in ur5e.LEVEL_Q_RAD]))
    robot.cycles(50)
    hooks.answer(controller, "emergency_stop")
    robot.cycles(200)
    assert controller.joints.at_rest
    assert controller.output.get("safety_status_bits") == (0x4C0,)
    assert controller.output.get("robot_status_bits") == (0,)
    assert controller.runtime == RuntimeState.STOPPED
    assert dashboard.answer(controller, "robotmode") == "Robotmode: POWER_OFF"
    assert dashboard.answer(controller, "unlock protective stop") == (
        "Cannot unlock protective stop: the robot is stopped by its emergency stop"
    )
    assert dashboard.answer(controller, "safetystatus") == "Safetystatus: ROBOT_EMERGENCY_STOP"
    controller.load_program(ControlProgram(COMMANDS))
    robot.cycles(100)
    assert controller.runtime == RuntimeState.STOPPED, "no program starts during an emergency stop"
    assert hooks.answer(controller, "clear") == "ok"
    assert controller.robot_mode == RobotMode.RUNNING
    robot.start()
    assert controller.output.get("robot_status_bits") == (3,)
    assert "unknown" in hooks.answer(controller, "jump")


def test_power_cycle_over_the_dashboard() -> None:
    robot = Robot()
    controller = robot.controller
    assert dashboard.answer(controller, "running") == "Program running: true"
    assert dashboard.answer(controller, "programState") == "PLAYING rtde_control.urp"
    for line, mode in (("power off", "POWER_OFF"), ("power on", "IDLE"), ("brake release", "RUNNING")):
        dashboard.answer(controller, line)
        assert dashboard.answer(controller, "robotmode") == f"Robotmode: {mode}"
    assert dashboard.answer(controller, "programState") == "STOPPED rtde_control.urp"
    assert dashboard.answer(controller, "stop") == "Stopped"
    assert dashboard.answer(controller, "get serial number").isdigit()
    assert dashboard.answer(controller, "dance") == 'could not understand: "dance"'


def test_a_shutdown_ends_the_program_and_switches_the_arm_off() -> None:
    robot = Robot()
    assert dashboard.answer(robot.controller, "shutdown") == "Shutting down"
    assert dashboard.answer(robot.controller, "robotmode") == "Robotmode: POWER_OFF"
    assert dashboard.answer(robot.controller, "running") == "Program running: false"


def test_what_clients_have_ordered_is_recorded() -> None:
    robot = Robot()
    controller = robot.controller
    controller.orders.clear()
    robot.write(11, servo(list(ur5e.LEVEL_Q_RAD)))
    robot.cycles(5)
    dashboard.answer(controller, "running")
    dashboard.answer(controller, "stop")
    ScriptSession(controller).receive(b"def rtde_control():\n  movej()\nend\n")
    now_s = controller.time_s
    assert json.loads(hooks.answer(controller, "orders")) == [
        [pytest.approx(now_s - 0.01), "rtde", "command 11"],
        [now_s, "dashboard", "stop"],
        [now_s, "script", "program rtde_control"],
    ]


def test_kinematics_answers() -> None:
    robot = Robot()
    q = [0.1, -1.2, 1.1, -0.7, 1.3, 0.4]
    robot.run(29, [0.0, 0.0, 0.05, 0.0, 0.0, 0.0])
    robot.run(1, [*q, 3.0, 10.0])
    robot.run(43)
    expected = ur5e.forward_kinematics(q) @ transform_from_pose([0, 0, 0.05, 0, 0, 0])
    assert transform_from_pose(robot.result()) == pytest.approx(expected, abs=1e-9)
    robot.controller.publish_tcp()
    assert robot.controller.output.get("actual_TCP_pose") == pytest.approx(robot.result(), abs=1e-9)
    robot.run(40)
    assert robot.result() == pytest.approx([0, 0, 0.05, 0, 0, 0])
    robot.run(44, [*ur5e.LEVEL_Q_RAD, *[0.0] * 6])
    assert transform_from_pose(robot.result()) == pytest.approx(ur5e.forward_kinematics(ur5e.LEVEL_Q_RAD), abs=1e-9)
    robot.write(27, integer=0)
    robot.cycles(1)
    assert robot.result() == pytest.approx(q)
    robot.write(26)
    robot.cycles(1)
    assert robot.result()[0] == 0.002


def test_speed_of_the_tool_is_that_of_its_pose() -> None:
    robot = Robot()
    robot.controller.tcp_wanted = True
    robot.write(9, [0.5, 0, 0, 0, 0, 0, 5.0, 0.0])
    robot.cycles(200)
    pose = robot.controller.output.get("actual_TCP_pose")
    speed = robot.controller.output.get("actual_TCP_speed")
    assert speed[:3] == pytest.approx((-0.5 * pose[1], 0.5 * pose[0], 0.0), abs=1e-3)
    assert speed[3:] == pytest.approx((0.0, 0.0, 0.5), abs=1e-3)
    robot.run(15, [5.0])
    robot.cycles(2)
    assert robot.controller.output.get("actual_TCP_speed") == (0.0,) * 6


any_double = st.floats(allow_nan=True, allow_infinity=True)


@settings(deadline=None, max_examples=60)
@given(st.lists(st.tuples(st.integers(0, 75), st.lists(any_double, max_size=18), st.integers(-3, 3)), max_size=15))
def test_no_command_breaks_the_controller(commands: list[tuple[int, list[float], int]]) -> None:
    robot = Robot()
    controller = robot.controller
    for command, doubles, integer in commands:
        robot.write(command, doubles, integer)
        robot.cycles(5)
        controller.publish_tcp()
        assert all(math.isfinite(angle) for angle in (*controller.joints.q, *controller.joints.qd))
        assert all(math.isfinite(value) for value in controller.output.get("actual_TCP_pose"))
        robot.write(0)
        robot.cycles(2)
        if controller.runtime != RuntimeState.PLAYING:
            controller.clear_stops()
            robot.start()
