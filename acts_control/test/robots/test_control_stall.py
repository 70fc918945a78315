# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A robot controller that stands still for a while (SIGSTOP), or is lost at a bad moment, against the simulated UR5e.

ROS_DOMAIN_ID 170, robot addresses 127.0.17.1 to 127.0.17.19.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from balancing_rig import HELD_UP_S, Rig
from child_process import Process
from control_rig import Bench, RollingBall, SimulatedRobot, node_command
from diagnostic_msgs.msg import DiagnosticArray
from waiting import wait_for

import acts_control.robots.ur.process_link
import acts_control.robots.ur.robot
from acts_control.ball import Phase
from acts_control.robots.ur import UrConfig, UrRobot
from acts_control.robots.ur.ur_probe import probe
from acts_core.errors import RobotError
from acts_core.robots import ur5e
from acts_msgs.msg import BalanceStatus

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("ur_rtde")]

# Within it the end of motion must have been told: a few steps after it counts as stale where the machine is not loaded.
# What waited for the library took 6 s.
TOLD_WITHIN_S = 4.0

# From the last reading to the moment of the stall, and on to the end of the robot's first cycle after it.
SETTLED_S = 0.1

CLEAR, MOVE_J, SERVO_J, SET_WATCHDOG = "command 0", "command 1", "command 11", "command 35"


def stall(rig: Rig, stall_s: float, meanwhile: Callable[[Rig], None]) -> tuple[float, tuple[float, ...]]:
    """Stand still for so long, or until that is told; the robot's time just after it, and the last command [rad]."""
    while (paused_s := told_in_time(rig)) is None:
        rig.resume()
        rig.start_again()
    wait_for(lambda: rig.arm.is_over, "the end of the connection", TOLD_WITHIN_S)
    stalled_s, aim = rig.arm.time_s, rig.loop.status.joints
    assert not rig.loop.stop("stopped by request")
    meanwhile(rig)
    time.sleep(max(stall_s - (time.monotonic() - paused_s), 0.0))
    rig.resume()
    return stalled_s + SETTLED_S, aim


def told_in_time(rig: Rig) -> float | None:
    """Stand still until that is told; since when [s], or None where this machine stood still meanwhile."""
    rig.balance()
    rig.held_up_s = 0.0
    paused_s = time.monotonic()
    rig.pause()
    reason = rig.await_phase(Phase.STOPPED)
    told_s = time.monotonic() - paused_s
    if rig.held_up_s > HELD_UP_S:
        return None
    assert reason.startswith("no data from the robot for 0.")
    assert 0.1 < told_s < TOLD_WITHIN_S
    return paused_s


def nothing(rig: Rig) -> None:
    """Wait."""


def start_and_stop(rig: Rig) -> None:
    """Ask to go on, and take it back."""
    assert rig.loop.start()
    assert not rig.loop.start()
    rig.await_phase(Phase.CONNECTING, TOLD_WITHIN_S)
    assert rig.loop.stop("stopped by request")
    assert rig.await_phase(Phase.STOPPED) == "stopped by request"


def start(rig: Rig) -> None:
    """Ask to go on."""
    assert rig.loop.start()


CASES = [(0.3, nothing), (1.0, start), (5.0, start_and_stop), (5.0, start)]
if os.environ.get("ACTS_LONG_FAULTS"):
    # Every stall alone, and with what may be asked for meanwhile; the longest lasts 20 s.
    CASES = [
        (stall_s, meanwhile) for meanwhile in (nothing, start_and_stop, start) for stall_s in (0.3, 1.0, 5.0, 20.0)
    ]


# The first alone: it takes a robot for lost the soonest, also while the programs of the others start beside it.
GROUPS = [CASES[:1], *(CASES[first : first + 4] for first in range(1, len(CASES), 4))]


@pytest.mark.parametrize("cases", GROUPS)
def test_after_a_stall_only_what_is_asked_for_is_commanded(cases: list[tuple[float, Callable[[Rig], None]]]) -> None:
    def scenario(number: int, stall_s: float, meanwhile: Callable[[Rig], None]) -> None:
        with ExitStack() as stack:
            # On a loaded machine robots stand still for a while anyway.
            rig = Rig(f"127.0.17.{number}", stack, stale_after_s=min(0.8, stall_s - 0.1))
            ended_s, aim = stall(rig, stall_s, meanwhile)
            if meanwhile is start:
                began_anew(rig, ended_s)
                return
            rig.await_time(1.0)
            assert rig.orders_since(ended_s) == []
            # The arm has come to where it was last told to be, and the robot has ended its program by itself.
            state = rig.simulated.state()
            assert state["q_rad"] == pytest.approx(aim, abs=1e-3)
            assert state["runtime"] == "STOPPED"
            assert rig.loop.status.phase is Phase.STOPPED
            rig.start_again()
            rig.balance()

    at_the_same_time(scenario, [(number, *case) for number, case in enumerate(cases, 1)])


def at_the_same_time(scenario: Callable[..., None], cases: list[tuple[Any, ...]]) -> None:
    """Run a scenario with each of these arguments in a thread of its own: most of what they do is waiting."""
    with ThreadPoolExecutor(len(cases)) as pool:
        for future in [pool.submit(scenario, *case) for case in cases]:
            future.result()


def began_anew(rig: Rig, ended_s: float) -> None:
    """One program, by us, and from there on what this loop sends: to the level pose first."""
    rig.await_phase(Phase.BALANCING)
    orders = rig.orders_since(ended_s)
    assert orders.count("program rtde_control") == 1
    begin = orders.index("program rtde_control")
    assert [words for words in orders[begin + 1 :] if words != CLEAR][:3] == [SET_WATCHDOG, MOVE_J, SERVO_J]
    assert not {MOVE_J, SERVO_J} & set(orders[:begin])


def test_a_stall_while_connecting_holds_up_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    with ExitStack() as stack:
        host = "127.0.17.10"
        simulated = stack.enter_context(SimulatedRobot(host))
        timeout_s = acts_control.robots.ur.process_link._CONNECT_TIMEOUT_S
        monkeypatch.setattr(acts_control.robots.ur.process_link, "_CONNECT_TIMEOUT_S", 0.5)

        def probe_and_pause(host: str) -> None:
            probe(host)
            # At the worst moment: the library connects next, and waits for an answer with Python's lock in its hand.
            simulated.process.send_signal(signal.SIGSTOP)

        monkeypatch.setattr(acts_control.robots.ur.robot, "probe", probe_and_pause)
        rig = Rig(host, stack, simulated=simulated)
        wait_for(lambda: "watch: no answer" in rig.loop.status.reason, lambda: f"the reason, {rig.loop.status}")
        assert rig.loop.status.phase is Phase.CONNECTING
        assert rig.arm.is_over
        monkeypatch.setattr(acts_control.robots.ur.robot, "probe", probe)
        wait_for(lambda: "does it stand still?" in rig.loop.status.reason, lambda: f"the reason, {rig.loop.status}")
        monkeypatch.setattr(acts_control.robots.ur.process_link, "_CONNECT_TIMEOUT_S", timeout_s)
        rig.resume()
        rig.balance()


def test_a_connection_whose_process_dies_is_lost() -> None:
    with ExitStack() as stack:
        rig = Rig("127.0.17.11", stack)
        rig.balance()
        assert rig.arm._link._process is not None
        rig.arm._link._process.send_signal(signal.SIGSEGV)
        assert "has ended (SIGSEGV)" in rig.await_phase(Phase.STOPPED)
        assert rig.loop.start()
        rig.balance()


@pytest.mark.parametrize("is_patient", [True, False], ids=["one command at a time", "many"])
def test_a_robot_that_vanishes_is_told_as_lost_whatever_notices_it_first(is_patient: bool) -> None:
    # In the loop that is mostly the watch for old readings; here nothing but the command is left to notice.
    def command() -> bool:
        if not (is_patient and robot.is_busy):
            robot.tilt(0.0, 0.0)
        return False

    with SimulatedRobot("127.0.17.18") as simulated:
        robot = UrRobot(UrConfig(robot_ip=simulated.host))
        robot.connect(lambda: True)
        simulated.process.kill()
        with pytest.raises(RobotError, match=r"127\.0\.17\.18: .*the connection is lost"):
            wait_for(command, "the loss")
        robot.disconnect()


def test_an_argument_that_the_library_refuses_is_no_lost_connection() -> None:
    with SimulatedRobot("127.0.17.18") as simulated:
        robot = UrRobot(UrConfig(robot_ip=simulated.host))
        robot.connect(lambda: True)
        # The settings allow no such lookahead time.
        robot._link.send("servoJ", list(ur5e.LEVEL_Q_RAD), 0.0, 0.0, 0.002, 9.0, 300.0)
        with pytest.raises(RobotError, match=r"127\.0\.17\.18: servoJ: "):
            wait_for(lambda: not robot.is_busy, "the refusal")
        robot.disconnect()


def test_a_controller_that_stalls_while_motion_ends_is_lost_too() -> None:
    with ExitStack() as stack:
        rig = Rig("127.0.17.12", stack)
        rig.balance()
        # In this order: motion could otherwise end before the controller stands still.
        rig.pause()
        assert rig.loop.stop("stopped by request")
        assert rig.loop.is_stopping
        assert rig.await_phase(Phase.STOPPED, TOLD_WITHIN_S + 1.0).startswith("no data from the robot")
        rig.resume()


def test_the_robots_program_ends_when_our_process_is_killed() -> None:
    program = """
import os, signal, sys
from acts_control.robots.ur import UrConfig, UrRobot
robot = UrRobot(UrConfig(robot_ip=sys.argv[1]))
robot.connect(lambda: True)
robot.tilt(0.0, 0.0)
while robot.is_busy:
    pass
os.kill(os.getpid(), signal.SIGKILL)
"""
    with SimulatedRobot("127.0.17.13") as simulated:
        result = subprocess.run([sys.executable, "-c", program, simulated.host], timeout=30.0, check=False)
        assert result.returncode == -signal.SIGKILL
        wait_for(lambda: simulated.state()["runtime"] == "STOPPED", "the end of the robot's program")
        assert any(words == SERVO_J for _at_s, _port, words in simulated.orders())


def test_an_arm_on_its_way_to_level_stops_when_nobody_watches_it_any_more() -> None:
    far = (ur5e.LEVEL_Q_RAD[0] + 3.0, *ur5e.LEVEL_Q_RAD[1:])

    def scenario(host: str, number: signal.Signals) -> None:
        with ExitStack() as stack:
            simulated = stack.enter_context(SimulatedRobot(host, far))
            rig = Rig(host, stack, simulated=simulated, homing_speed_rad_s=0.3)
            wait_for(lambda: simulated.state()["q_rad"][0] < far[0] - 0.05, "the arm to be on its way")
            assert rig.arm._link._process is not None
            rig.arm._link._process.send_signal(number)
            rig.await_phase(Phase.STOPPED)
            wait_for(lambda: simulated.state()["runtime"] == "STOPPED", "the robot to end its program")
            wait_for(lambda: not any(simulated.state()["qd_rad_s"]), "rest")
            # It has not gone on to the level pose.
            assert simulated.state()["q_rad"][0] > ur5e.LEVEL_Q_RAD[0] + 1.0
            assert rig.loop.start()
            rig.await_phase(Phase.BALANCING, 60.0)

    at_the_same_time(scenario, [("127.0.17.15", signal.SIGSTOP), ("127.0.17.16", signal.SIGKILL)])


def test_an_arm_stops_when_our_process_stands_still() -> None:
    far = (ur5e.LEVEL_Q_RAD[0] + 3.0, *ur5e.LEVEL_Q_RAD[1:])
    with SimulatedRobot("127.0.17.17", far) as simulated:
        settings = ["--set", f"ball_control.robot_ip={simulated.host}", "--set", "ball_control.homing_speed_rad_s=0.3"]
        # A busy machine may not run the robot for a while.
        settings += ["--set", "ball_control.robot_stale_after_s=2.0"]
        command = node_command("ball_balancing", *settings)
        with Process(*command, domain=170) as ours:
            wait_for(lambda: simulated.state()["q_rad"][0] < far[0] - 0.05, "the arm to be on its way")
            ours.process.send_signal(signal.SIGSTOP)
            wait_for(lambda: simulated.state()["runtime"] == "STOPPED", "the robot to end its program")
            wait_for(lambda: not any(simulated.state()["qd_rad_s"]), "rest")
            assert simulated.state()["q_rad"][0] > ur5e.LEVEL_Q_RAD[0] + 1.0
            ours.process.send_signal(signal.SIGCONT)
            told = "the robot has ended its program: this process stood still for "
            wait_for(lambda: told in ours.text(), "the reason")
            # It has not been sent on.
            assert simulated.state()["q_rad"][0] > ur5e.LEVEL_Q_RAD[0] + 1.0


def test_a_process_that_stood_still_just_before_a_command_says_so() -> None:
    with SimulatedRobot("127.0.17.19") as simulated:
        robot = UrRobot(UrConfig(robot_ip=simulated.host))
        robot.connect(lambda: True)
        robot.read()
        # Nobody tells the robot anything.
        wait_for(lambda: not robot._link.newest().is_playing, "the robot to end its program")
        robot.end_tilting()
        told = "the robot has ended its program: this process stood still for "
        assert robot.read().stopped.startswith(told)
        robot.disconnect()


def test_an_arm_does_not_go_on_when_a_protective_stop_on_its_way_is_released_and_its_program_played() -> None:
    far = (ur5e.LEVEL_Q_RAD[0] + 3.0, *ur5e.LEVEL_Q_RAD[1:])
    with ExitStack() as stack:
        simulated = stack.enter_context(SimulatedRobot("127.0.17.18", far))
        rig = Rig(simulated.host, stack, simulated=simulated, homing_speed_rad_s=0.3)
        wait_for(lambda: simulated.state()["q_rad"][0] < far[0] - 0.05, "the arm to be on its way")
        simulated.hook("protective_stop")
        assert rig.await_phase(Phase.STOPPED) == "robot: protective stop"
        rig.await_time(1.0)
        stopped_at = simulated.state()["q_rad"]
        assert simulated.ask_dashboard("unlock protective stop") == "Protective stop releasing"
        assert simulated.ask_dashboard("play") == "Starting program"
        wait_for(lambda: simulated.state()["runtime"] == "STOPPED", "the robot to end its program")
        assert simulated.state()["q_rad"] == pytest.approx(stopped_at, abs=1e-3)


def test_the_node_tells_a_stall_and_answers_during_it(tmp_path: Path) -> None:
    settings = tmp_path / "params.yaml"
    settings.write_text("/**/ball_control:\n  ros__parameters: {touch_stale_after_s: 1.0, robot_stale_after_s: 0.5}\n")
    with SimulatedRobot("127.0.17.14") as robot, Bench(170) as bench, RollingBall(bench):
        levels: list[tuple[int, str]] = []

        def note(message: DiagnosticArray) -> None:
            levels.extend((status.level[0], status.message) for status in message.status)

        bench.node.create_subscription(DiagnosticArray, "/diagnostics", note, 10)
        bench.start()
        command = node_command("ball_balancing", "--set", f"ball_control.robot_ip={robot.host}")
        with Process(*command, "--params-file", str(settings), domain=170):
            bench.await_phase(BalanceStatus.STATE_BALANCING)
            wait_for(lambda: abs(ur5e.tilt_of(robot.state()["q_rad"])[1]) > 0.005, "a tilt")
            robot.process.send_signal(signal.SIGSTOP)
            stopped = bench.await_phase(BalanceStatus.STATE_STOPPED, TOLD_WITHIN_S)
            # Told at the first step after robot_stale_after_s; the loop counts no step for longer than 32 ms.
            assert re.fullmatch(r"no data from the robot for 0\.5[0-3] s", stopped.reason)
            wait_for(
                lambda: any(level == 2 and stopped.reason in text for level, text in levels),
                "the diagnostics",
                TOLD_WITHIN_S,
            )
            answer = bench.call("stop")
            assert not answer.success
            assert answer.message.startswith(f"already stopped: {stopped.reason}")
            assert bench.call("start").message == "started"
            bench.await_phase(BalanceStatus.STATE_CONNECTING)
            answer = bench.call("start")
            assert (answer.success, answer.message.split(":")[0]) == (False, "already connecting")
            wait_for(lambda: "does it stand still?" in bench.statuses[-1].reason, "the reason")
            assert bench.call("stop").message == "stopping"
            assert bench.await_phase(BalanceStatus.STATE_STOPPED).reason == "stopped by request"
            robot.process.send_signal(signal.SIGCONT)
            assert bench.call("start").success
            bench.await_phase(BalanceStatus.STATE_BALANCING)
