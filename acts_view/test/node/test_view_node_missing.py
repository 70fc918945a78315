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


@pytest.fixture
def bench_of_a_robot() -> Iterator[Bench]:
    made = Bench(DOMAIN_ID, namespace="/robot", skins="hand, /foot")
    yield made
    made.close()


@pytest.fixture
def bench_of_the_root() -> Iterator[Bench]:
    made = Bench(DOMAIN_ID, skins="/")
    yield made
    made.close()


def missing_of(bench: Bench) -> dict[str, tuple[int, str]]:
    """Level and message of each skin that is told missing."""
    told = {one["name"]: (one["level"], one["message"]) for one in bench.diagnostics}
    return {name: one for name, one in told.items() if one[1].startswith("nobody publishes touch of this skin")}


def test_a_skin_that_was_asked_for_is_told_missing_until_somebody_publishes_it(bench: Bench) -> None:
    def missing() -> dict[str, tuple[int, str]]:
        return missing_of(bench)

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


def test_a_skin_of_a_robot_is_within_the_namespace_that_a_launch_file_has_pushed(bench_of_a_robot: Bench) -> None:
    bench = bench_of_a_robot
    with bench.connect() as client:
        bench.until(lambda: "/foot" in missing_of(bench), client, lambda: bench.press(1.0))
        assert bench.headers["status"]["skins"] == ["/robot/hand", "/foot"]
        bench.until(lambda: missing_of(bench).keys() == {"/foot"}, client, lambda: bench.press(2.0))
        bench.until(lambda: "frame" in bench.headers and bench.is_pressed_with(2.0), client, lambda: bench.press(2.0))
        assert bench.headers["frame"]["skin"] == "/robot/hand"


def test_of_the_skin_in_the_root_namespace_no_other_is_shown(bench_of_the_root: Bench) -> None:
    """It could not be asked for: all skins were shown."""
    bench = bench_of_the_root
    player = Node("player", context=bench.skin.context)
    with bench.connect() as client:
        bench.until(lambda: "/" in missing_of(bench), client, lambda: bench.press(1.0))
        assert bench.headers["status"]["skins"] == [""]
        player.create_publisher(Image, "/image_raw", qos.STREAM)
        bench.until(lambda: missing_of(bench) == {}, client, lambda: bench.press(1.0))
        assert bench.headers["status"]["skins"] == [""]
    player.destroy_node()
