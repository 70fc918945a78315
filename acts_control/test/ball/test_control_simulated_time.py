# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The control node where simulated time is asked for: it goes on with the system's clock. ROS_DOMAIN_ID 175."""

import time
from collections.abc import Iterator

import pytest
import rclpy
from arm_in_process import ArmInProcess
from geometry_msgs.msg import Vector3
from rclpy.context import Context
from waiting import wait_for

from acts_control.ball import Phase
from acts_control.ball.nodes.ball_control_node import BallControlNode
from acts_msgs.msg import BallReference, BallState
from acts_ros.messages import set_stamp


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=175)
    yield context
    rclpy.try_shutdown(context=context)


def test_the_control_loop_balances_although_nobody_publishes_the_clock(context: Context) -> None:
    arguments = ["--ros-args", "-p", "use_sim_time:=true", "-p", "touch_stale_after_s:=1.0"]
    arm = ArmInProcess()
    node = BallControlNode(lambda _settings: arm, context=context, namespace="/plate", cli_args=arguments)
    node.begin()

    def balances() -> bool:
        for message, take in ((BallState(valid=True), node._on_state), (BallReference(), node._on_reference)):
            set_stamp(message.header.stamp, time.time_ns())
            message.velocity = Vector3(x=0.01)
            take(message)
        return node._loop.status.phase is Phase.BALANCING and len(arm.commands) > 20

    wait_for(balances, "a closed loop")
    assert 0.0 <= node._loop.status.touch_age_s < 1.0
    node.close()
    assert node._loop.status.reason == "shutting down"
    assert arm.calls[-1] == "disconnect"
    node.destroy_node()
