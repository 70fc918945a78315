# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A diagnostic status over DDS; ROS_DOMAIN_ID 12."""

from functools import partial

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.task import Future
from waiting import wait_for

from acts_ros.diagnostics import WARN, DiagnosticsReporter


def test_the_report_arrives_with_name_level_and_values() -> None:
    context = Context()
    rclpy.init(context=context, domain_id=12)
    node = Node("driver", namespace="/plate", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    received: Future = Future()
    node.create_subscription(DiagnosticArray, "/diagnostics", lambda message: received.set_result(message), 10)
    DiagnosticsReporter(
        node, "/dev/ttyACM0", lambda: (WARN, "3 frames lost", {"lost": 3, "rate_hz": 999.5}), period_s=0.05
    )
    executor.spin_until_future_complete(received, timeout_sec=20)
    assert received.done()
    status = received.result().status[0]
    assert status.name == "plate/driver"
    assert status.hardware_id == "/dev/ttyACM0"
    assert status.level == b"\x01"
    assert status.message == "3 frames lost"
    assert {value.key: value.value for value in status.values} == {"lost": "3", "rate_hz": "999.5"}
    executor.shutdown()
    node.destroy_node()
    rclpy.try_shutdown(context=context)


def test_a_node_that_cannot_spin_yet_is_heard_until_it_can() -> None:
    context = Context()
    rclpy.init(context=context, domain_id=12)
    node, peer = (Node(name, namespace="/plate", context=context) for name in ("reconstruction", "peer"))
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(peer)
    received: list[DiagnosticArray] = []
    peer.create_subscription(DiagnosticArray, "/diagnostics", received.append, 10)
    reporter = DiagnosticsReporter(node, "/plate/samples", lambda: (WARN, "ready", {}), period_s=0.05)
    turn = partial(executor.spin_once, timeout_sec=0.05)
    with reporter.busy("compiling", period_s=0.05):
        wait_for(lambda: len(received) >= 2, timeout_s=20.0, meanwhile=turn)
    for message in received:
        (status,) = message.status
        assert status.name == "plate/reconstruction"
        assert status.hardware_id == "/plate/samples"
        assert (status.level, status.message) == (b"\x01", "compiling")
    executor.add_node(node)
    wait_for(lambda: sum(message.status[0].message == "ready" for message in received) >= 3, meanwhile=turn)
    words = [message.status[0].message for message in received]
    assert "compiling" not in words[words.index("ready") :]
    executor.shutdown()
    node.destroy_node()
    peer.destroy_node()
    rclpy.try_shutdown(context=context)
