# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A diagnostic status over DDS; ROS_DOMAIN_ID 12."""

from diagnostic_msgs.msg import DiagnosticArray
from peers import Peers
from rclpy.node import Node

from acts_ros.diagnostics import WARN, DiagnosticsReporter


def test_the_report_arrives_with_name_level_and_values() -> None:
    peers = Peers(domain_id=12, name="driver", namespace="/plate")
    peers.timeout_s = 20.0
    received = peers.listen(DiagnosticArray, "/diagnostics", 10)
    DiagnosticsReporter(
        peers.peer, "/dev/ttyACM0", lambda: (WARN, "3 frames lost", {"lost": 3, "rate_hz": 999.5}), period_s=0.05
    )
    peers.until(lambda: received)
    status = received[0].status[0]
    assert status.name == "plate/driver"
    assert status.hardware_id == "/dev/ttyACM0"
    assert status.level == b"\x01"
    assert status.message == "3 frames lost"
    assert {value.key: value.value for value in status.values} == {"lost": "3", "rate_hz": "999.5"}
    peers.close()


def test_a_node_that_cannot_spin_yet_is_heard_until_it_can() -> None:
    peers = Peers(domain_id=12, namespace="/plate")
    peers.timeout_s = 20.0
    node = Node("reconstruction", namespace="/plate", context=peers.context)
    received = peers.listen(DiagnosticArray, "/diagnostics", 10)
    reporter = DiagnosticsReporter(node, "/plate/samples", lambda: (WARN, "ready", {}), period_s=0.05)
    with reporter.busy("compiling", period_s=0.05):
        peers.until(lambda: len(received) >= 2)
    for message in received:
        (status,) = message.status
        assert status.name == "plate/reconstruction"
        assert status.hardware_id == "/plate/samples"
        assert (status.level, status.message) == (b"\x01", "compiling")
    peers.add(node)
    peers.until(lambda: sum(message.status[0].message == "ready" for message in received) >= 3)
    words = [message.status[0].message for message in received]
    assert "compiling" not in words[words.index("ready") :]
    peers.close()
