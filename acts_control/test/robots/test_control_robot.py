# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The whole of acts_control against a simulated UR5e over the unmodified ur_rtde, with faults.

The client side runs in a process of its own: ur_rtde may take its process down when a controller vanishes.
ROS_DOMAIN_IDs 64 to 69, robot addresses 127.0.2.1 to 127.0.2.9.
"""

import math
import signal
import subprocess
from contextlib import suppress
from pathlib import Path

import pytest
from child_process import Process
from control_rig import Bench, RollingBall, SimulatedRobot, node_command
from waiting import wait_for

from acts_control.robots.base import SafetyConfig
from acts_core.robots import ur5e
from acts_msgs.msg import BalanceStatus

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("ur_rtde")]

CONNECTING, WAITING = BalanceStatus.STATE_CONNECTING, BalanceStatus.STATE_WAITING
BALANCING, STOPPED = BalanceStatus.STATE_BALANCING, BalanceStatus.STATE_STOPPED

# The ball of these tests rolls on published tilts, on a plate that turns about the ball and without resistance; and the
# machine may be busy, so touch and readings may be older than in earnest.
SETTINGS = """
/**/ball_state:
  ros__parameters: {lever_arm_m: 0.0}
/**/ball_control:
  ros__parameters:
    lever_arm_m: 0.0
    rolling_resistance: 0.0
    touch_stale_after_s: 0.3
    ball_lost_after_s: 0.3
    robot_stale_after_s: 1.0
    robot_watchdog_s: 1.0
    connect_retry_s: 0.2
    homing_speed_rad_s: 2.0
    homing_acceleration_rad_s2: 8.0
"""

# The program that moves the arm, moveJ and servoJ.
MOTIONS = ("program rtde_control", "command 1", "command 11")


def balancing_process(
    tmp_path: Path, robot: SimulatedRobot, domain: int, trajectory: str = "hold", touch_stop_after_s: float = 1.0
) -> Process:
    path = tmp_path / "params.yaml"
    path.write_text(SETTINGS + f"    touch_stop_after_s: {touch_stop_after_s}\n")
    command = node_command(
        "ball_balancing",
        "--set",
        f"ball_control.robot_ip={robot.host}",
        "--set",
        f"ball_trajectory.trajectory={trajectory}",
    )
    return Process(*command, "--params-file", str(path), domain=domain)


def tilt(robot: SimulatedRobot) -> float:
    """How far the plate of the simulated robot is from level [rad]."""
    return math.hypot(*ur5e.tilt_of(robot.state()["q_rad"]))


def test_a_ball_is_held_and_led_and_a_signal_stops_the_robot_in_order(tmp_path: Path) -> None:
    with SimulatedRobot("127.0.2.1") as robot, Bench(64) as bench, RollingBall(bench) as ball:
        bench.start()
        with balancing_process(tmp_path, robot, 64, "hold,circle,", touch_stop_after_s=20.0) as process:
            bench.await_phase(BALANCING)
            wait_for(lambda: tilt(robot) > 0.005, "a tilt of the robot")
            wait_for(lambda: math.hypot(ball.x, ball.y) < 0.003, "the ball at the centre")
            # On a topic of their own: they may be heard later than the state.
            wait_for(lambda: bool(bench.references), "references")
            wait_for(lambda: bench.references[-1].segment == "circle", "the circle")
            wait_for(lambda: bench.references[-1].segment_time > 1.0, "the ball on its way")

            def led() -> BalanceStatus | None:
                reference, status = bench.references[-1], bench.statuses[-1]
                x, y = reference.position.x, reference.position.y
                near = math.hypot(ball.x - x, ball.y - y) < 0.01 and math.hypot(status.error.x, status.error.y) < 0.01
                return status if reference.segment == "circle" and near and status.touch_age < 0.3 else None

            # This process publishes the touch, and may be held up: the ball is led anew then.
            status = wait_for(led, "the ball near its reference")
            assert status.header.frame_id == "plate"
            assert list(status.joints_commanded[:3]) == pytest.approx(ur5e.LEVEL_Q_RAD[:3], abs=1e-6)
            assert ur5e.tilt_of(status.joints_commanded) == pytest.approx(
                (status.tilt_commanded.x, status.tilt_commanded.y), abs=1e-9
            )
            assert status.steps > 0
            assert process.stop(signal.SIGINT) == 0, process.text()
            assert "Traceback" not in process.text()
            assert tilt(robot) < 1e-3
            assert robot.state()["runtime"] == "STOPPED"


def test_signals_while_motion_ends_change_nothing(tmp_path: Path) -> None:
    with SimulatedRobot("127.0.2.9") as robot, Bench(64) as bench, RollingBall(bench):
        bench.start()
        with balancing_process(tmp_path, robot, 64) as process:
            bench.await_phase(BALANCING)
            wait_for(lambda: tilt(robot) > 0.005, "a tilt of the robot")
            signals = [signal.SIGINT, signal.SIGTERM]
            while process.process.poll() is None:
                # Again every few milliseconds, all the way out.
                process.process.send_signal(signals[0])
                signals.reverse()
                with suppress(subprocess.TimeoutExpired):
                    process.process.wait(0.01)
            assert process.process.returncode == 0, process.text()
            assert "Traceback" not in process.text()
            assert tilt(robot) < 1e-3
            assert robot.state()["runtime"] == "STOPPED"
            assert bench.await_phase(STOPPED).reason == "shutting down"


def test_stop_and_start_by_service(tmp_path: Path) -> None:
    with SimulatedRobot("127.0.2.2") as robot, Bench(65) as bench, RollingBall(bench):
        bench.start()
        with balancing_process(tmp_path, robot, 65) as process:
            bench.await_phase(BALANCING)
            assert not bench.call("start").success
            assert bench.call("stop").success
            assert bench.await_phase(STOPPED).reason == "stopped by request"
            assert tilt(robot) < 1e-3
            answer = bench.call("stop")
            assert (answer.success, answer.message) == (False, "already stopped: stopped by request")
            assert bench.call("start").success
            bench.await_phase(BALANCING)
            assert process.stop(signal.SIGTERM) == 0, process.text()


def test_touch_that_stops_or_turns_nan_and_a_ball_that_is_lost(tmp_path: Path) -> None:
    with SimulatedRobot("127.0.2.3") as robot, Bench(66) as bench, RollingBall(bench) as ball:
        bench.start()
        with balancing_process(tmp_path, robot, 66):
            bench.await_phase(BALANCING)
            ball.touched = False
            waiting = bench.await_phase(WAITING)
            # Where this process stood still, it has sent no touch, and the controller waits for that at first.
            is_stale = waiting.touch_age > SafetyConfig().touch_stale_after_s
            assert waiting.reason.endswith("waiting for touch" if is_stale else "waiting for a ball")
            wait_for(lambda: bench.statuses[-1].reason.endswith("waiting for a ball"), "a reason")
            wait_for(lambda: tilt(robot) < 1e-3, "a level plate")
            assert robot.state()["runtime"] == "PLAYING"
            ball.touched = True
            bench.await_phase(BALANCING)
            for fault in ("nan", "silent"):
                setattr(ball, fault, True)
                assert bench.await_phase(STOPPED).reason.startswith("touch is stale: the newest is")
                assert tilt(robot) < 1e-3
                assert robot.state()["runtime"] == "STOPPED"
                setattr(ball, fault, False)
                assert bench.call("start").success
                bench.await_phase(BALANCING)


@pytest.mark.parametrize(
    ("hook", "reason"), [("protective_stop", "robot: protective stop"), ("emergency_stop", "robot: emergency stop")]
)
def test_a_stop_of_the_robot_ends_motion_until_it_is_released_and_started(
    tmp_path: Path, hook: str, reason: str
) -> None:
    with SimulatedRobot("127.0.2.4") as robot, Bench(67) as bench, RollingBall(bench):
        bench.start()
        with balancing_process(tmp_path, robot, 67) as process:
            bench.await_phase(BALANCING)
            robot.hook(hook)
            stopped = bench.await_phase(STOPPED)
            assert stopped.reason == reason
            stopped_s = float(robot.state()["time_s"])
            # Still held: a start is answered with the reason, and nothing moves.
            assert bench.call("start").success
            wait_for(
                lambda: bench.phase == STOPPED and "release it at the robot" in bench.statuses[-1].reason, "the refusal"
            )
            assert bench.statuses[-1].steps == 0
            assert not [words for at_s, _port, words in robot.orders() if at_s > stopped_s and words in MOTIONS]
            robot.hook("clear")
            assert bench.call("start").success
            bench.await_phase(BALANCING)
            assert process.process.poll() is None


def test_a_controller_that_vanishes_and_comes_back(tmp_path: Path) -> None:
    with Bench(68) as bench, RollingBall(bench):
        bench.start()
        with SimulatedRobot("127.0.2.5") as robot:
            process = balancing_process(tmp_path, robot, 68)
            with process:
                bench.await_phase(BALANCING)
                robot.process.kill()
                robot.process.wait()
                reason = bench.await_phase(STOPPED).reason
                assert "lost" in reason or "no data from the robot" in reason
                # It can be started before the robot is back, and then waits for it.
                assert bench.call("start").success
                waiting = bench.await_phase(CONNECTING)
                wait_for(lambda: "no UR controller at 127.0.2.5" in bench.statuses[-1].reason, "a reason")
                assert waiting.steps == 0
                with SimulatedRobot("127.0.2.5"):
                    bench.await_phase(BALANCING)
                    assert process.stop() == 0, process.text()


def test_homing_from_another_pose_and_a_second_client(tmp_path: Path) -> None:
    elsewhere = [
        angle + offset for angle, offset in zip(ur5e.LEVEL_Q_RAD, (0.4, -0.1, 0.2, 0.0, -0.3, 0.1), strict=True)
    ]
    with SimulatedRobot("127.0.2.6", elsewhere) as robot, Bench(69) as bench:
        bench.start()
        with balancing_process(tmp_path, robot, 69) as process:
            assert bench.await_phase(WAITING).reason == "waiting for touch"
            assert robot.state()["q_rad"] == pytest.approx(ur5e.LEVEL_Q_RAD, abs=2e-3)
            # Another program must not take the robot over, and this one tells why it cannot.
            has_it = f"robot {robot.host} is controlled by process {process.process.pid} ("
            for _ in range(5):
                with Process(*node_command("ball_control_node", robot_ip=robot.host), domain=68) as second:
                    wait_for(lambda: has_it in second.text() or bench.phase != WAITING, "the second client's message")
                    is_told = has_it in second.text()
                    assert second.stop() == 0
                if is_told:
                    break
                # The machine stood still, and the first has let go of a robot that was silent: once more.
                assert bench.statuses[-1].reason.startswith("no data from the robot")
                assert bench.call("start").success
                bench.await_phase(WAITING)
            assert is_told
            assert process.process.poll() is None
            assert bench.phase == WAITING
