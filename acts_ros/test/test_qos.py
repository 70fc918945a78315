# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Overriding quality of service; ROS_DOMAIN_ID 13."""

import rclpy
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import Empty

from acts_ros.qos import STREAM, overridable


def test_an_override_reaches_its_topic_and_nobody_else() -> None:
    context = Context()
    rclpy.init(context=context, domain_id=13)
    arguments = ["--ros-args", "-p", "qos_overrides./overridden.publisher.depth:=17"]
    node = Node("example", context=context, cli_args=arguments)
    publisher = node.create_publisher(Empty, "overridden", **overridable(STREAM))
    assert publisher.qos_profile.depth == 17
    assert node.get_parameter("qos_overrides./overridden.publisher.depth").value == 17
    assert STREAM.depth == 256
    node.destroy_node()
    rclpy.try_shutdown(context=context)
