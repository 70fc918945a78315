# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An arm that is not ready, or not wanted any more, when it is connected to, against the simulated UR5e.

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
from acts_core.errors import RobotError
from acts_core.robots import ur5e

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("ur_rtde")]

FAR = (ur5e.LEVEL_Q_RAD[0] + 0.5, *ur5e.LEVEL_Q_RAD[1:])
PROGRAM, MOVE_J = "program rtde_control", "command 1"


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


def test_connecting_that_is_given_up_leaves_no_program_on_the_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    # The machine may be busy.
    monkeypatch.setattr(acts_control.robots.ur.robot, "_GIVE_UP_S", 20.0)
    with SimulatedRobot("127.0.17.31") as simulated:
        robot = UrRobot(UrConfig(robot_ip=simulated.host))

        def is_uploaded() -> bool:
            return any(words == PROGRAM for _at_s, _port, words in simulated.orders())

        def is_wanted() -> bool:
            if [name for name, _sent_s in robot._pending] != ["take_control"]:
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
    monkeypatch.setattr(robot, "_start_process", lambda: monkeypatch.setattr(robot, "_link", ours))
    monkeypatch.setattr(robot, "_carry_out", carry_out)
    monkeypatch.setattr(robot, "_state", UrState(True, 1.0, FAR, 1, 1))
    with closing(theirs):
        begin_s = time.monotonic()
        with pytest.raises(RobotError, match="connecting was given up"):
            robot.connect(lambda: False)
        # It waits for 0.5 s; the rest is for a busy machine.
        assert time.monotonic() - begin_s < 4.0
        with pytest.raises(RobotError, match="while it was uploaded"):
            robot.release()
