# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A skin that was asked for and that nobody publishes, as pages are told of it; ROS_DOMAIN_ID 211."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from rclpy.node import Node
from sensor_msgs.msg import Image
from view_node_bench import Bench

from acts_ros import qos

pytestmark = pytest.mark.slow

DOMAIN_ID = 211


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench(DOMAIN_ID, skins="hand, foot,palm")
    yield made
    made.close()


def test_a_skin_that_was_asked_for_is_told_missing_until_somebody_publishes_it(bench: Bench) -> None:
    def missing() -> dict[str, tuple[int, str]]:
        told = {one["name"]: (one["level"], one["message"]) for one in bench.diagnostics}
        return {name: one for name, one in told.items() if one[1].startswith("nobody publishes touch of this skin")}

    player = Node("player", context=bench.skin.context)
    with bench.connect() as client:
        bench.until(lambda: {"/foot", "/palm"} == missing().keys(), client, lambda: bench.press(1.0))
        level, message = missing()["/foot"]
        assert level == 1
        assert message.endswith("is its name right, and do its driver and its reconstruction run?")
        # As of a bag of images alone.
        player.create_publisher(Image, "/foot/image_raw", qos.STREAM)
        bench.until(lambda: {"/palm"} == missing().keys(), client, lambda: bench.press(1.0))
    player.destroy_node()
