# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An arm that is not ready, in use, or not wanted any more, when it is connected to, against the simulated UR5e.

Robot addresses 127.0.17.30 to 127.0.17.39.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Callable
from contextlib import ExitStack, closing

import pytest
from balancing_rig import Rig
from control_rig import SimulatedRobot
from waiting import wait_for

import acts_control.robots.ur.robot
from acts_control.ball import Phase
from acts_control.robots.ur import UrConfig, UrRobot
from acts_control.robots.ur.state import UrState
from acts_control.robots.ur.ur_probe import SCRIPT_PORT
from acts_core.errors import RobotError
from acts_core.robots import ur5e

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("ur_rtde")]

FAR = (ur5e.LEVEL_Q_RAD[0] + 0.5, *ur5e.LEVEL_Q_RAD[1:])
PROGRAM, MOVE_J = "program rtde_control", "command 1"
# Of a program that takes its commands through other registers, so that these are not in use.
OTHER_PROGRAM = b"def rtde_control():\n  reg_offset_int = # int register offset\n24\nend\n"


@pytest.mark.parametrize(
    ("before", "meanwhile", "words"),
    [
        (["power off"], ["power on", "brake release"], "it is off"),
        (["power off", "power on"], ["brake release"], "its brakes are on"),
    ],
    ids=["off", "brakes"],
)
def test_an_arm_that_is_made_ready_at_its_panel_does_not_move_before_it_is_started(
    before: list[str], meanwhile: list[str], words: str
) -> None:
    with ExitStack() as stack:
        simulated = stack.enter_context(SimulatedRobot("127.0.17.30", FAR))
        for line in before:
            simulated.ask_dashboard(line)
        rig = Rig(simulated.host, stack, simulated=simulated)
        wait_for(lambda: words in rig.loop.status.reason, lambda: f"the reason, {rig.loop.status}")
        reason = rig.await_phase(Phase.STOPPED)
        assert reason.endswith("switch the arm on, release its brakes, put it into remote control, then call start")
        for line in meanwhile:
            simulated.ask_dashboard(line)
        assert simulated.state()["robot_mode"] == "RUNNING"
        # Attempts to connect would come every 0.1 s.
        rig.await_time(2.0)
        assert rig.loop.status.phase is Phase.STOPPED
        assert not {PROGRAM, MOVE_J} & set(rig.orders_since(0.0))
        assert simulated.state()["q_rad"] == pytest.approx(FAR, abs=1e-6)
        assert rig.loop.start()
        wait_for(lambda: MOVE_J in rig.orders_since(0.0), lambda: f"the way to the level pose, {rig.loop.status}")


def test_a_controller_that_tells_nothing_is_not_told_as_an_arm_that_is_off(monkeypatch: pytest.MonkeyPatch) -> None:
    # The library's values then: all is 0.
    nothing = UrState(connected=False, timestamp_s=0.0, q_rad=(), safety_bits=0, runtime_state=0, robot_mode=0)
    robot = UrRobot(UrConfig(robot_ip="127.0.17.35"))
    monkeypatch.setattr(acts_control.robots.ur.robot, "probe", lambda _host: None)
    monkeypatch.setattr(robot._link, "start", lambda: None)
    monkeypatch.setattr(robot._link, "carry_out", lambda *_: None)
    monkeypatch.setattr(robot._link, "newest", lambda: nothing)
    with pytest.raises(RobotError, match="accepts connections but sends no data; does it stand still") as caught:
        robot.connect(lambda: True)
    # It is tried again.
    assert type(caught.value) is RobotError


def test_a_program_that_runs_on_the_robot_is_not_ended_by_connecting() -> None:
    with ExitStack() as stack:
        simulated = stack.enter_context(SimulatedRobot("127.0.17.33", FAR))
        with socket.create_connection((simulated.host, SCRIPT_PORT)) as other:
            other.sendall(OTHER_PROGRAM)
        wait_for(lambda: simulated.state()["runtime"] == "PLAYING", "the other program")
        rig = Rig(simulated.host, stack, simulated=simulated)
        wait_for(lambda: "a program runs" in rig.loop.status.reason, lambda: f"the reason, {rig.loop.status}")
        reason = rig.await_phase(Phase.STOPPED)
        assert reason.endswith("end it at the robot, or where it was started, then call start")
        assert simulated.state()["runtime"] == "PLAYING"
        # Who ends it may be beside the robot.
        assert simulated.ask_dashboard("stop") == "Stopped"
        # Attempts to connect would come every 0.1 s.
        rig.await_time(1.0)
        assert rig.orders_since(0.0) == [PROGRAM, "stop"]
        assert simulated.state()["q_rad"] == pytest.approx(FAR, abs=1e-6)
        assert rig.loop.start()
        rig.balance()


def test_a_program_that_ends_soon_as_by_the_robots_watchdog_is_waited_for() -> None:
    with SimulatedRobot("127.0.17.36") as simulated:
        with socket.create_connection((simulated.host, SCRIPT_PORT)) as other:
            other.sendall(OTHER_PROGRAM)
        wait_for(lambda: simulated.state()["runtime"] == "PLAYING", "the other program")
        robot = UrRobot(UrConfig(robot_ip=simulated.host, robot_watchdog_s=5.0))
        answers: list[str] = []

        def end_it_meanwhile() -> bool:
            if robot._link._state is not None and robot._link._state.is_playing and not answers:
                answers.append(simulated.ask_dashboard("stop"))
            return True

        robot.connect(end_it_meanwhile)
        assert answers == ["Stopped"]
        assert robot.read().stopped == ""
        robot.disconnect()


def test_a_program_that_an_attempt_of_ours_has_left_is_replaced(monkeypatch: pytest.MonkeyPatch) -> None:
    with SimulatedRobot("127.0.17.34") as simulated:
        robot = UrRobot(UrConfig(robot_ip=simulated.host))
        with socket.create_connection((simulated.host, SCRIPT_PORT)) as other:
            other.sendall(OTHER_PROGRAM)
        wait_for(lambda: simulated.state()["runtime"] == "PLAYING", "the program")
        monkeypatch.setattr(robot, "_is_left_running", True)
        robot.connect(lambda: True)
        assert robot.read().stopped == ""
        robot.disconnect()


def test_connecting_that_is_given_up_leaves_no_program_on_the_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    # The machine may be busy.
    monkeypatch.setattr(acts_control.robots.ur.robot, "_GIVE_UP_S", 20.0)
    with SimulatedRobot("127.0.17.31") as simulated:
        robot = UrRobot(UrConfig(robot_ip=simulated.host))

        def is_uploaded() -> bool:
            return any(words == PROGRAM for _at_s, _port, words in simulated.orders())

        def is_wanted() -> bool:
            if [name for name, _sent_s in robot._link._pending] != ["take_control"]:
                return True
            wait_for(is_uploaded, "the program to be uploaded")
            return False

        with pytest.raises(RobotError, match="connecting was given up"):
            robot.connect(is_wanted)
        # An uploaded program starts 0.1 s later.
        given_up_s = float(simulated.state()["time_s"])
        wait_for(lambda: float(simulated.state()["time_s"]) > given_up_s + 1.0, "the robot's time to pass")
        assert simulated.state()["runtime"] == "STOPPED"
        # Nothing is left to be told.
        robot.release()


def test_a_program_that_cannot_be_ended_holds_up_nobody_and_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    robot = UrRobot(UrConfig(robot_ip="127.0.17.32"))
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    ours.setblocking(False)

    def carry_out(name: str, _is_wanted: Callable[[], bool], *_arguments: object) -> None:
        if name == "take_control":
            raise RobotError("connecting was given up")

    monkeypatch.setattr(acts_control.robots.ur.robot, "probe", lambda _host: None)
    monkeypatch.setattr(robot._link, "start", lambda: monkeypatch.setattr(robot._link, "_link", ours))
    monkeypatch.setattr(robot._link, "carry_out", carry_out)
    monkeypatch.setattr(robot._link, "_state", UrState(True, 1.0, FAR, 1, 1))
    with closing(theirs):
        begin_s = time.monotonic()
        with pytest.raises(RobotError, match="connecting was given up"):
            robot.connect(lambda: False)
        # It waits for 0.5 s; the rest is for a busy machine.
        assert time.monotonic() - begin_s < 4.0
        with pytest.raises(RobotError, match="while it was uploaded"):
            robot.release()
