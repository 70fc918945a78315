# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The hand, launched for real: it grasps by touch, keeps its grip when touch is lost, and opens.

ROS_DOMAIN_IDs 231, 220.
"""

import os
import signal
from pathlib import Path

import pytest
from launch_support import PACKAGE, START_S, pid_of, shipped_parameters_and
from std_srvs.srv import Trigger

from acts_msgs.msg import HandStatus
from acts_sim.dynamixel import ControlClient
from acts_tools.testing.launch_runner import Launched, LaunchFile, launch_fixture, launch_test

pytestmark = pytest.mark.slow

STATUS = "/hand/hand/status"


@launch_fixture
def hand(tmp_path: Path) -> LaunchFile:
    # A busy machine: touch may come late; the hand may close quickly.
    patient = "{touch_stale_after_s: 2.5, silence_s: 2.0, motor_watchdog_s: 0.0, close_speed_rad_s: 3.0}"
    arguments = {
        "run_dir": str(tmp_path / "run"),
        "params_file": shipped_parameters_and(tmp_path, "hand_reflexes", "/hand/hand_reflexes", patient),
        "rate_hz": "60.0",
        "object": "cylinder",
        "object_held": "true",
        # Nothing real is opened, whatever is said.
        "hand_port": "/dev/ttyUSB0",
    }
    return LaunchFile(PACKAGE, "hand_reflexes.launch.xml", 231, arguments)


def wait_for_state(launched: Launched, state: int, words: str = "") -> None:
    """Wait until the hand says that it is in a state, for a reason with these words."""

    def reached(status: HandStatus) -> bool:
        return bool(status.state == state and words in status.reason)

    launched.wait_for_message(STATUS, HandStatus, START_S, reached)


def ask(launched: Launched, name: str) -> Trigger.Response:
    """Call a service of the hand."""
    probe = launched.probe
    client = probe.node.create_client(Trigger, f"/hand/hand_reflexes/{name}")
    probe.wait_for(client.service_is_ready, START_S, f"the service {name}")
    answer = client.call_async(Trigger.Request())
    probe.wait_for(answer.done, START_S, f"an answer of {name}")
    return answer.result()


@launch_test(hand)
def test_the_hand_grasps_keeps_its_grip_without_touch_and_opens(hand: Launched) -> None:
    # Touch comes also while the torque is off, of which the reason tells.
    hand.wait_for_message(
        STATUS, HandStatus, START_S, lambda status: status.touch_age < 1.0 and "the hand is" not in status.reason
    )
    assert ask(hand, "grasp").success
    wait_for_state(hand, HandStatus.STATE_HOLDING, "gripped by")
    tactile = pid_of(hand, "tactile")
    # Killed only when it is missed: a quick machine has it back before.
    os.kill(tactile, signal.SIGSTOP)
    wait_for_state(hand, HandStatus.STATE_HOLDING, "touch is stale: the grip stays as it is")
    os.kill(tactile, signal.SIGKILL)
    wait_for_state(hand, HandStatus.STATE_HOLDING, "touch is back")
    assert ask(hand, "release").success
    wait_for_state(hand, HandStatus.STATE_OPEN, "released by request")
    assert hand.stop() == 0


@launch_fixture
def simulated(tmp_path: Path) -> LaunchFile:
    return LaunchFile(PACKAGE, "simulated_hand.launch.xml", 220, {"run_dir": str(tmp_path / "run"), "object": "none"})


@launch_test(simulated)
def test_the_simulated_hand_tells_where_its_joints_are(simulated: Launched, tmp_path: Path) -> None:
    control = tmp_path / "run" / "hand.control"
    simulated.wait_for(control.is_socket, START_S, "the control socket")
    with ControlClient(control) as client:
        state = client.state()
    assert len(state["motors"]) == 16
    assert (tmp_path / "run" / "hand").is_symlink()
    assert simulated.stop() == 0
