# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Timers and simulated time; ROS_DOMAIN_ID 177."""

from collections.abc import Iterator

import pytest
import rclpy
from rclpy.clock import ClockType
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.parameter import Parameter

from acts_ros.clocks import keep_system_clock, steady_timer
from acts_ros.parameters import node_options


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=177)
    yield context
    rclpy.try_shutdown(context=context)


def make_node(context: Context, kind: type[Node] = Node) -> Node:
    arguments = ["--ros-args", "-p", "use_sim_time:=true"]
    return kind("example", namespace="/plate", context=context, cli_args=arguments, **node_options())


def test_a_steady_timer_runs_although_simulated_time_stands_still(context: Context) -> None:
    node = make_node(context)
    calls: list[int] = []
    timer = steady_timer(node, 0.01, lambda: calls.append(1))
    assert node.get_clock().now().nanoseconds == 0
    assert timer.clock.clock_type is ClockType.STEADY_TIME
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    for _ in range(1000):
        if len(calls) > 3:
            break
        executor.spin_once(timeout_sec=0.1)
    assert len(calls) > 3


@pytest.mark.parametrize("kind", [Node, LifecycleNode])
def test_a_node_that_keeps_the_systems_clock_says_so(
    context: Context, kind: type[Node], capfd: pytest.CaptureFixture[str]
) -> None:
    node = make_node(context, kind)
    keep_system_clock(node, "the board does not wait")
    assert node.get_clock().now().nanoseconds > 10**18
    assert node.get_parameter("use_sim_time").value is False
    # Its own only: those of a test before may take a while to be forgotten by the graph.
    assert "/clock" not in [subscription.topic_name for subscription in node.subscriptions]
    told = capfd.readouterr().err
    assert "/plate/example does not run on simulated time and goes on with the system's clock: the board" in told
    [result] = node.set_parameters([Parameter("use_sim_time", value=True)])
    assert not result.successful
    assert result.reason == "/plate/example runs on the system's clock: the board does not wait"
    assert node.get_clock().now().nanoseconds > 10**18
