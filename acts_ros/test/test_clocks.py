# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Timers, simulated time and nodes that stand still; ROS_DOMAIN_ID 177."""

import re
import time
from collections.abc import Callable, Iterator

import pytest
import rclpy
from rclpy.clock import ClockType
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.parameter import Parameter
from waiting import wait_for

from acts_ros import clocks
from acts_ros.clocks import Stalls, keep_system_clock, steady_timer
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


def test_what_is_asked_for_after_a_node_stood_still_is_told_from_what_is_new(context: Context) -> None:
    node = make_node(context)
    stalls = Stalls(node, longest_s=0.5)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)

    def spin_until(condition: Callable[[], bool]) -> None:
        wait_for(condition, meanwhile=lambda: executor.spin_once(timeout_sec=0.05))

    # However long a node takes to be made.
    stalls.begin()
    assert stalls.objection() == ""
    spin_until(lambda: stalls.objection() == "")
    begin_s = time.monotonic()
    while time.monotonic() - begin_s < 1.0:
        pass
    told = re.fullmatch(
        r"this program stood still for (\d+\.\d) s, and was perhaps asked meanwhile; ask again", stalls.objection()
    )
    assert told is not None
    assert float(told[1]) >= 1.0
    assert stalls.objection() != ""
    spin_until(lambda: stalls.objection() == "")


def test_a_machine_that_has_slept_has_stood_still(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    stalls = Stalls(make_node(context))
    clock_gettime, slept_s = time.clock_gettime, [0.0]

    def clock(number: int) -> float:
        # Of these, Linux lets only this one run meanwhile.
        return clock_gettime(number) + (slept_s[0] if number == time.CLOCK_BOOTTIME else 0.0)

    monkeypatch.setattr(time, "clock_gettime", clock)
    stalls.begin()
    assert stalls.objection() == ""
    slept_s[0] = 600.0
    assert stalls.objection().startswith("this program stood still for 600.")


def test_what_was_asked_for_before_a_node_stood_still_is_told_also_before_its_executor_goes_on(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    now_s, looks = [100.0], []

    def clock() -> float:
        looks.append(now_s[0])
        return now_s[0]

    monkeypatch.setattr(clocks, "boot_time_s", clock)
    node = make_node(context)
    stalls = Stalls(node, longest_s=0.5)
    # As long as nobody has looked it is not known.
    assert stalls.since(99.0) == ""
    stalls.begin()
    now_s[0] += 0.4
    assert stalls.since(100.0) == ""
    now_s[0] = 102.0
    # Asked from a thread that is up before the executor, which is to find the same.
    assert [stalls.since(asked_s) for asked_s in (100.0, 101.9)] == 2 * ["this program stood still for 2.0 s"]
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    before = len(looks)
    wait_for(lambda: len(looks) > before, meanwhile=lambda: executor.spin_once(timeout_sec=0.05))
    now_s[0] = 102.3
    assert stalls.since(101.9) == "this program stood still for 2.0 s"
    assert stalls.since(102.1) == ""
    assert stalls.objection() == "this program stood still for 2.0 s, and was perhaps asked meanwhile; ask again"
    now_s[0] = 102.7
    assert stalls.objection() == ""


def test_a_node_that_keeps_the_systems_clock_takes_its_other_parameters(context: Context) -> None:
    node = make_node(context)
    node.declare_parameter("is_bright", False)
    keep_system_clock(node, "the board does not wait")
    both = [Parameter("is_bright", value=True), Parameter("use_sim_time", value=True)]
    assert [result.successful for result in node.set_parameters(both)] == [True, False]
    assert not node.set_parameters_atomically(both).successful
    assert node.set_parameters([Parameter("use_sim_time", value=False)])[0].successful
