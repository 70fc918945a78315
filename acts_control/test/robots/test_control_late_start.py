# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An arm does not begin to move by what was asked for while its program stood still; ROS_DOMAIN_ID 205."""

import signal
import time

import pytest
from child_process import Process
from control_rig import Bench, SimulatedRobot, node_command
from std_srvs.srv import Trigger
from waiting import wait_for

from acts_msgs.msg import BalanceStatus

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("ur_rtde")]


def test_a_start_that_waited_while_the_program_stood_still_moves_no_arm() -> None:
    with SimulatedRobot("127.0.205.1") as robot, Bench(205) as bench:
        start = bench.node.create_client(Trigger, "ball_control/start")
        bench.start()
        settings = ["--set", f"ball_control.robot_ip={robot.host}", "--set", "ball_control.autostart=false"]
        # A busy machine may not run the robot for a while.
        settings += ["--set", "ball_control.robot_stale_after_s=2.0"]
        with Process(*node_command("ball_balancing", *settings), domain=205) as ours:
            bench.await_phase(BalanceStatus.STATE_STOPPED)
            wait_for(start.service_is_ready, "the service")
            ours.process.send_signal(signal.SIGSTOP)
            future = start.call_async(Trigger.Request())
            begin_s = time.monotonic()
            wait_for(lambda: time.monotonic() - begin_s > 1.5, "the time to pass")
            ours.process.send_signal(signal.SIGCONT)
            wait_for(future.done, "the answer")
            answer = future.result()
            assert not answer.success
            assert answer.message.startswith("this program stood still for ")
            assert bench.phase == BalanceStatus.STATE_STOPPED
            assert robot.orders() == []
            wait_for(lambda: bench.call("start").success, "a start that is new")
            bench.await_phase(BalanceStatus.STATE_WAITING)


def test_a_start_from_before_the_program_stood_still_moves_no_arm_that_answers_afterwards() -> None:
    settings = ["--set", "ball_control.robot_ip=127.0.205.2", "--set", "ball_control.autostart=false"]
    settings += ["--set", "ball_control.robot_stale_after_s=2.0"]
    with Bench(205) as bench:
        bench.start()
        with Process(*node_command("ball_balancing", *settings), domain=205) as ours:
            bench.await_phase(BalanceStatus.STATE_STOPPED)
            wait_for(lambda: bench.call("start").success, "a start")
            bench.await_phase(BalanceStatus.STATE_CONNECTING)
            ours.process.send_signal(signal.SIGSTOP)
            begin_s = time.monotonic()
            with SimulatedRobot("127.0.205.2") as robot:
                wait_for(lambda: time.monotonic() - begin_s > 1.5, "the time to pass")
                ours.process.send_signal(signal.SIGCONT)
                status = bench.await_phase(BalanceStatus.STATE_STOPPED)
                assert status.reason.startswith("this program stood still for ")
                assert status.reason.endswith(" while it connected; call start again")
                assert robot.orders() == []
                # One that is new is done.
                wait_for(lambda: bench.call("start").success, "another start")
                bench.await_phase(BalanceStatus.STATE_WAITING)
