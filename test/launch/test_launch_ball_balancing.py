# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Ball balancing, launched for real: it balances, and ends level when parts are lost. ROS_DOMAIN_ID 96 to 98, 183."""

import os
import signal
from pathlib import Path

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped
from launch_support import LONG_S, PACKAGE, START_S, patient_parameters, pid_of

from acts_msgs.msg import BalanceStatus
from acts_tools.testing.launch_runner import Launched, LaunchFile, launch_fixture, launch_test

pytestmark = pytest.mark.slow


@launch_fixture
def balancing(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "robot_ip": "127.0.6.2", "trajectory": "hold"}
    arguments["params_file"] = patient_parameters(tmp_path)
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 96, arguments)


@launch_fixture
def elsewhere(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "robot_ip": "127.evil.example.com", "trajectory": "hold"}
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 183, arguments)


@launch_test(elsewhere)
def test_with_a_simulated_skin_no_robot_of_another_address_is_moved(elsewhere: Launched) -> None:
    elsewhere.wait_for_output("robot_ip = '127.evil.example.com': nothing is controlled", START_S)
    assert elsewhere.stop() == 1


def wait_for_state(launched: Launched, state: int, timeout_s: float) -> BalanceStatus:
    """Wait until the controller reports a state."""
    status: BalanceStatus = launched.wait_for_message(
        "/plate/ball/status", BalanceStatus, timeout_s, lambda status: status.state == state
    )
    return status


@pytest.mark.usefixtures("ur_rtde")
@launch_test(balancing)
def test_the_ball_is_brought_to_the_centre_and_the_end_is_orderly(balancing: Launched) -> None:
    wait_for_state(balancing, BalanceStatus.STATE_BALANCING, START_S)

    def centred(truth: PointStamped) -> bool:
        return float(np.hypot(truth.point.x, truth.point.y)) < 0.005

    balancing.wait_for_message("/plate/ball/truth", PointStamped, LONG_S, centred)
    assert balancing.stop() == 0


@launch_fixture
def separate(tmp_path: Path) -> LaunchFile:
    arguments = {
        "run_dir": str(tmp_path / "run"),
        "robot_ip": "127.0.6.3",
        "trajectory": "hold",
        "composed": "false",
        # The shipped time: only once the ball is balanced does late touch end motion, and then it is what is wanted.
        "params_file": patient_parameters(tmp_path, touch_stop_after_s=3.0),
    }
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 97, arguments)


@pytest.mark.usefixtures("ur_rtde")
@launch_test(separate)
def test_in_separate_processes_a_lost_board_ends_motion_level(separate: Launched) -> None:
    wait_for_state(separate, BalanceStatus.STATE_BALANCING, START_S)
    os.kill(pid_of(separate, "virtual_board"), signal.SIGKILL)

    def level(status: BalanceStatus) -> bool:
        tilted = max(abs(status.tilt_measured.x), abs(status.tilt_measured.y))
        return status.state != BalanceStatus.STATE_BALANCING and tilted < 0.002

    separate.wait_for_message("/plate/ball/status", BalanceStatus, LONG_S, level)
    assert separate.stop() == 1  # the board died


@launch_fixture
def robot_lost(tmp_path: Path) -> LaunchFile:
    arguments = {"run_dir": str(tmp_path / "run"), "robot_ip": "127.0.6.4", "trajectory": "hold"}
    arguments["params_file"] = patient_parameters(tmp_path)
    return LaunchFile(PACKAGE, "ball_balancing.launch.xml", 98, arguments)


@pytest.mark.usefixtures("ur_rtde")
@launch_test(robot_lost)
def test_a_lost_robot_stops_the_controller_with_a_reason(robot_lost: Launched) -> None:
    wait_for_state(robot_lost, BalanceStatus.STATE_BALANCING, START_S)
    os.kill(pid_of(robot_lost, "ur_controller"), signal.SIGKILL)
    status = wait_for_state(robot_lost, BalanceStatus.STATE_STOPPED, LONG_S)
    assert "lost" in status.reason or "no data from the robot" in status.reason
    assert robot_lost.stop() == 1  # the robot died
