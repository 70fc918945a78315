# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names of the frames of skins. ROS_DOMAIN_ID 148."""

from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node

from acts_core.errors import SettingsError
from acts_ros.messages import skin_frame


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=148)
    yield context
    rclpy.shutdown(context=context)


@pytest.mark.parametrize(
    ("namespace", "given", "frame"),
    [
        ("/plate", "", "plate"),
        ("/arm/plate", "none", "arm_plate"),
        ("/", "", "skin"),
        ("/arm/plate", "left", "left"),
        ("/", "arm/plate", "arm/plate"),
    ],
)
def test_a_frame_is_named_as_set_or_as_its_namespace(context: Context, namespace: str, given: str, frame: str) -> None:
    node = Node("namer", namespace=namespace, context=context)
    assert skin_frame(node, given) == frame
    node.destroy_node()


@pytest.mark.parametrize("given", ["/plate", "/a b", "a plate", " ", "plate\n", "plate\0"])
def test_a_name_that_tf2_does_not_take_is_refused(context: Context, given: str) -> None:
    node = Node("namer", context=context)
    with pytest.raises(SettingsError, match="does not begin with /"):
        skin_frame(node, given)
    node.destroy_node()
