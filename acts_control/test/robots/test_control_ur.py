# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The UR5e without its library: does its controller answer, what is said of its state, what its gate refuses.

Addresses 127.0.17.20 to 127.0.17.29.
"""

from __future__ import annotations

import math
import re
import socket
import struct
import threading
from collections.abc import Iterator
from contextlib import ExitStack, closing
from types import SimpleNamespace

import pytest

import acts_control.robots.ur.robot
from acts_control.robots.base import CommandRefusedError, RobotStoppedError
from acts_control.robots.ur import UrConfig, UrRobot, ur_process
from acts_control.robots.ur.gate import JointGate
from acts_control.robots.ur.state import UrState
from acts_control.robots.ur.ur_probe import DASHBOARD_PORT, RTDE_PORT, SCRIPT_PORT, probe
from acts_control.robots.ur.ur_process import _Connection
from acts_core.errors import RobotError, SettingsError
from acts_core.robots import ur5e

HOST = "127.0.17.20"
NAN = float("nan")
VERSION = b"\x00\x04V\x01"
GREETING = b"Connected: Universal Robots Dashboard Server\n"


def listen(stack: ExitStack, port: int) -> socket.socket:
    return stack.enter_context(closing(socket.create_server((HOST, port))))


def say(stack: ExitStack, port: int, pieces: list[bytes], clients: int = 1) -> None:
    """Answer clients, piece by piece, and hang up."""
    server = listen(stack, port)

    def serve() -> None:
        for connection, _ in (server.accept() for _ in range(clients)):
            with connection:
                for piece in pieces:
                    connection.sendall(piece)
                connection.shutdown(socket.SHUT_WR)
                connection.recv(100)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    stack.callback(thread.join, 5.0)


@pytest.fixture
def stack() -> Iterator[ExitStack]:
    with ExitStack() as stack:
        yield stack


def test_a_controller_that_answers_is_one(stack: ExitStack) -> None:
    say(stack, RTDE_PORT, [VERSION[:2], VERSION[2:]])
    say(stack, DASHBOARD_PORT, [GREETING[:5], GREETING[5:]])
    listen(stack, SCRIPT_PORT)
    probe(HOST)


@pytest.mark.parametrize(
    ("major", "words"), [(5, "no UR controller at 127.0.17.20 port 29999"), (10, "PolyScope X .10.8")]
)
def test_a_controller_without_a_dashboard(stack: ExitStack, major: int, words: str) -> None:
    # In one piece: who hangs up before all is read resets the connection.
    say(stack, RTDE_PORT, [VERSION + struct.pack(">HB4I", 19, ord("v"), major, 8, 0, 0)], clients=2)
    with pytest.raises(RobotError, match=words):
        probe(HOST)


def test_nobody_there() -> None:
    with pytest.raises(RobotError, match=r"no UR controller at 127.0.17.20 port 30004"):
        probe(HOST)


@pytest.mark.parametrize("silent", [RTDE_PORT, DASHBOARD_PORT])
def test_ports_that_accept_but_do_not_answer(stack: ExitStack, silent: int) -> None:
    # As the system does for a process that stands still.
    listen(stack, silent)
    if silent != RTDE_PORT:
        say(stack, RTDE_PORT, [VERSION])
    # The other port answers on a thread that a busy machine may not run for a while.
    with pytest.raises(RobotError, match=f"at port {silent} but has not answered for 1 s; does it stand still"):
        probe(HOST, 1.0)


@pytest.mark.parametrize("pieces", [[], [b"\x00"], [b"HTTP/1.1 400 Bad Request\r\n" * 300]])
def test_something_else_at_the_port(stack: ExitStack, pieces: list[bytes]) -> None:
    say(stack, RTDE_PORT, pieces)
    with pytest.raises(RobotError, match=r"what answers at 127.0.17.20 port 30004 is no UR controller"):
        probe(HOST, 1.0)


def test_no_new_connection_before_the_former_has_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = UrRobot(UrConfig(robot_ip=HOST))
    monkeypatch.setattr(robot._link, "_process", SimpleNamespace(pid=4711, poll=lambda: None))
    with pytest.raises(RobotError, match=r"waiting for the end of the former connection \(process 4711\)"):
        robot.connect(lambda: True)


def test_without_a_connection_nothing_is_commanded() -> None:
    robot = UrRobot(UrConfig(robot_ip=HOST))
    robot.release()
    robot.disconnect()
    assert not robot.is_busy
    assert robot.address == HOST
    for call in (robot.read, robot.begin_levelling, robot.end_tilting, lambda: robot.tilt(0.0, 0.01)):
        with pytest.raises(RobotError, match="not connected"):
            call()


@pytest.mark.parametrize(
    ("tilt", "words"),
    [
        ((float("nan"), 0.0), "tilt = (nan, 0.0) rad"),
        ((0.0, float("inf")), "tilt = (0.0, inf) rad"),
        ((1.0, 0.0), "tilt = (1.0, 0.0) rad"),
        ((0.2, 0.0), "rad off the level pose, allowed is 0.14"),
        ((0.0, 0.1), "jumps by"),
    ],
)
def test_the_arm_refuses_tilts_that_its_joints_must_not_make(tilt: tuple[float, float], words: str) -> None:
    # Nothing is sent, or it would say that it is not connected.
    with pytest.raises(CommandRefusedError, match=re.escape(words)):
        UrRobot(UrConfig(robot_ip=HOST)).tilt(*tilt)


def test_the_limit_of_the_wrists_is_not_within_that_of_the_tilt() -> None:
    with pytest.raises(SettingsError, match=r"max_wrist_offset_rad = 0.1: allowed is 0.1152 or more"):
        UrConfig(max_wrist_offset_rad=0.1)


def test_where_the_level_pose_is_only_nearly_level_the_first_tilt_is_no_step(monkeypatch: pytest.MonkeyPatch) -> None:
    nearly = tuple(pose(wrist_1=0.013, wrist_2=-0.013))
    robot = UrRobot(UrConfig(robot_ip=HOST, level_q_rad=nearly))
    sent: list[list[float]] = []
    monkeypatch.setattr(robot._link, "send", lambda _name, q_rad, *_others: sent.append(q_rad))
    monkeypatch.setattr(robot._link, "newest", lambda: UrState(True, 1.0, nearly, 1, 2))
    robot.begin_levelling()
    assert robot.tilt(0.0, 0.0) == pytest.approx(sent[0], abs=1e-9)
    assert ur5e.tilt_of(sent[0]) == pytest.approx((0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(
    ("speed_rad_s", "acceleration_rad_s2", "least_s"),
    [(0.5, 1.5, 1.0 / 0.5 + 0.5 / 1.5), (3.0, 0.01, 2.0 * math.sqrt(1.0 / 0.01)), (0.01, 0.01, 101.0)],
)
def test_the_arm_has_time_for_the_way_to_the_level_pose_however_slowly_it_may_go(
    monkeypatch: pytest.MonkeyPatch, speed_rad_s: float, acceleration_rad_s2: float, least_s: float
) -> None:
    robot = UrRobot(
        UrConfig(robot_ip=HOST, homing_speed_rad_s=speed_rad_s, homing_acceleration_rad_s2=acceleration_rad_s2)
    )
    monkeypatch.setattr(robot._link, "send", lambda *_words: None)
    monkeypatch.setattr(robot._link, "newest", lambda: UrState(True, 1.0, tuple(pose(elbow=1.0)), 1, 2))
    # Three times as long, as at a slider of the speed at a third, and some time to settle.
    assert robot.begin_levelling() == pytest.approx(5.0 + 3.0 * least_s)


# --- the gate


def pose(wrist_1: float = 0.0, wrist_2: float = 0.0, elbow: float = 0.0) -> list[float]:
    q = list(ur5e.LEVEL_Q_RAD)
    q[2] += elbow
    q[3] += wrist_1
    q[4] += wrist_2
    return q


def test_the_gate_lets_small_tilts_pass() -> None:
    gate = JointGate(UrConfig())
    for k in range(4):
        assert gate.fault(pose(0.03 * k, -0.03 * k)) == ""


@pytest.mark.parametrize(
    ("q", "words"),
    [
        (pose(NAN), "joint 3 is nan"),
        (pose(0.0, math.inf), "joint 4 is inf"),
        (pose(0.0, 0.0, NAN), "joint 2 is nan"),
        (pose(0.2), "joint 3 is \\+0.2000 rad off the level pose, allowed is 0.14"),
        (pose(0.0, -0.2), "joint 4 is -0.2000 rad off"),
        (pose(0.0, 0.0, 0.001), "joint 2 is \\+0.0010 rad off"),
        (pose(0.1), "joint 3 jumps by \\+0.1000 rad, allowed is 0.05"),
        (pose()[:5], "5 joints"),
    ],
)
def test_the_gate_stops_angles_that_must_not_reach_the_robot(q: list[float], words: str) -> None:
    gate = JointGate(UrConfig())
    with pytest.raises(AssertionError, match=words):
        assert gate.fault(q) == ""
    assert gate.fault(pose()) == ""


# --- what the controller says, in words


STATE = UrState(connected=True, timestamp_s=2.5, q_rad=ur5e.LEVEL_Q_RAD, safety_bits=1, runtime_state=2)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, ""),
        ({"safety_bits": 0x404}, "robot: protective stop"),
        ({"safety_bits": 0x4C0}, "robot: emergency stop"),
        ({"safety_bits": 0x410}, "robot: safeguard stop"),
        ({"runtime_state": 1}, "the robot's program is not running (stopped)"),
        ({"runtime_state": 4}, "the robot's program is not running (paused)"),
        ({"q_rad": (NAN,) * 6}, "the robot reports joint angles (nan, nan, nan, nan, nan, nan)"),
        ({"q_rad": (math.inf,) * 6}, "the robot reports joint angles (inf, inf, inf, inf, inf, inf)"),
        ({"q_rad": (0.0,) * 5}, "the robot reports joint angles (0.0, 0.0, 0.0, 0.0, 0.0)"),
    ],
)
def test_why_the_arm_does_not_do_what_it_is_told(changes: dict[str, object], words: str) -> None:
    assert STATE._replace(**changes).reading(UrConfig()).stopped == words  # type: ignore[arg-type]


def test_a_reading_has_the_plates_tilt_and_how_far_the_arm_is_from_level() -> None:
    q_rad = list(ur5e.LEVEL_Q_RAD)
    q_rad[3:5] = ur5e.wrist_angles_for_tilt(q_rad, 0.02, -0.03, 0.7)
    q_rad[0] += 0.4
    reading = STATE._replace(q_rad=tuple(q_rad), silent_s=0.3).reading(UrConfig(mount_yaw_rad=0.7), 0.1)
    assert reading.tilt_rad == pytest.approx((0.02, -0.03))
    assert reading.off_level == pytest.approx(0.4)
    assert (reading.connected, reading.time_s, reading.joints) == (True, 2.5, tuple(q_rad))
    assert (reading.waiting_s, reading.silent_s) == (0.1, 0.3)


def test_a_command_is_not_overdue_for_what_this_process_stood_still_after_it_looked_for_the_answer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    robot, now_s = UrRobot(UrConfig(robot_ip=HOST)), [10.0]

    def look_and_stand_still() -> UrState:
        now_s[0] += 5.0
        return STATE

    monkeypatch.setattr(acts_control.robots.ur.robot, "steady_s", lambda: now_s[0])
    monkeypatch.setattr(robot._link, "newest", look_and_stand_still)
    robot._link._pending.append(("servoJ", 9.99))
    assert robot.read().waiting_s == pytest.approx(0.01)
    # It has not come since.
    assert robot.read().waiting_s == pytest.approx(5.01)


def test_a_silence_that_a_robot_has_borne_is_not_blamed_for_a_later_stop(monkeypatch: pytest.MonkeyPatch) -> None:
    robot, now_s, states = UrRobot(UrConfig(robot_ip=HOST, robot_watchdog_s=0.5)), [10.0], [STATE]
    monkeypatch.setattr(acts_control.robots.ur.robot, "steady_s", lambda: now_s[0])
    monkeypatch.setattr(robot._link, "newest", lambda: states[0])

    def read_after(seconds: float) -> str:
        now_s[0] += seconds
        stopped = robot.read().stopped
        robot._link._sent_s = now_s[0]
        return stopped

    robot._link._sent_s = now_s[0]
    assert read_after(0.1) == ""
    states[0] = STATE._replace(runtime_state=1)
    assert "this process stood still for 0.6 s, and robot_watchdog_s is 0.5" in read_after(0.6)
    states[0] = STATE
    assert [read_after(0.1) for _ in range(30)] == [""] * 30
    states[0] = STATE._replace(runtime_state=1)
    assert read_after(0.1) == "the robot's program is not running (stopped)"


@pytest.mark.parametrize(
    ("mode", "words"),
    [(7, ""), (3, "it is off"), (5, "its brakes are on"), (99, "its mode is 99, needed is 7")],
)
def test_why_the_arm_is_not_ready(mode: int, words: str) -> None:
    assert STATE._replace(robot_mode=mode).unready == words


@pytest.mark.parametrize(
    ("told", "kind"),
    [
        ("take_control: ur_rtde: Please enable remote control on the robot!", RobotStoppedError),
        ("take_control: ur_rtde: Failed to start control script, before timeout of 5 seconds", RobotStoppedError),
        ("the control script does not run (waited for 2 s)", RobotStoppedError),
        ("take_control: One of the RTDE input registers are already in use!", RobotError),
        ("take_control: no answer (waited for 10 s)", RobotError),
    ],
)
def test_only_an_arm_that_nobody_has_to_make_ready_is_tried_again(
    monkeypatch: pytest.MonkeyPatch, told: str, kind: type[RobotError]
) -> None:
    robot = UrRobot(UrConfig(robot_ip=HOST))

    def carry_out(name: str, *_others: object) -> None:
        if name == "take_control":
            raise RobotError(told)

    monkeypatch.setattr(acts_control.robots.ur.robot, "probe", lambda _host: None)
    monkeypatch.setattr(robot._link, "start", lambda: None)
    monkeypatch.setattr(robot._link, "carry_out", carry_out)
    monkeypatch.setattr(robot._link, "newest", lambda: STATE._replace(runtime_state=1))
    with pytest.raises(RobotError) as caught:
        robot.connect(lambda: True)
    assert type(caught.value) is kind
    assert str(caught.value).startswith(told)
    assert ("then call start" in str(caught.value)) == (kind is RobotStoppedError)


class StopsMeanwhile:
    """A controller whose emergency stop comes after so many of its values were read."""

    def __init__(self, values: int) -> None:
        self._left = values

    def _is_stopped(self) -> bool:
        self._left -= 1
        return self._left < 0

    def isConnected(self) -> bool:  # noqa: N802 - names of ur_rtde
        return self._is_stopped() or True

    def getTimestamp(self) -> float:  # noqa: N802
        return 1.0 + self._is_stopped()

    def getActualQ(self) -> list[float]:  # noqa: N802
        self._is_stopped()
        return [0.0] * 6

    def getSafetyStatusBits(self) -> int:  # noqa: N802
        return 1 << 7 if self._is_stopped() else 1

    def getRuntimeState(self) -> int:  # noqa: N802
        return 1 if self._is_stopped() else 2

    def getRobotMode(self) -> int:  # noqa: N802
        return 7


@pytest.mark.parametrize("values", range(6))
def test_a_program_that_a_safety_function_stops_is_never_told_without_that(values: int) -> None:
    here, there = socket.socketpair()
    with closing(here), closing(there):
        connection = _Connection(here, HOST, 125.0)
        connection._receive = StopsMeanwhile(values)
        state = UrState(*connection._read())  # type: ignore[arg-type]
    assert state.is_playing or state.safety_stop == "emergency stop"


class FallsSilent(StopsMeanwhile):
    """A controller that tells nothing more after 1 s, until the library ends the connection; and a clock."""

    _time_s = 0.0

    def __init__(self) -> None:
        """Of no emergency stop."""

    def _is_stopped(self) -> bool:
        return False

    def isConnected(self) -> bool:  # noqa: N802
        return self._time_s < 3.5

    def getTimestamp(self) -> float:  # noqa: N802
        return min(self._time_s, 1.0)

    def monotonic(self) -> float:
        return self._time_s

    def sleep(self, seconds: float) -> None:
        self._time_s += seconds
        if self._time_s > 4.0:
            raise TimeoutError


def test_how_long_a_controller_was_silent_is_told_with_the_end_of_the_connection(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    controller = FallsSilent()
    monkeypatch.setattr(ur_process, "time", controller)
    told: list[tuple[object, ...]] = []
    with socket.socket() as link:
        connection = _Connection(link, HOST, 125.0)
    monkeypatch.setattr(connection, "_tell", lambda _kind, *words: told.append(words))
    connection._receive = controller
    with pytest.raises(TimeoutError):
        connection._tell_readings()
    *while_connected, last = [UrState(*words) for words in told]  # type: ignore[arg-type]
    assert all(state.connected and state.silent_s < 0.02 for state in while_connected)
    assert not last.connected
    assert last.silent_s == pytest.approx(2.5, abs=0.02)
