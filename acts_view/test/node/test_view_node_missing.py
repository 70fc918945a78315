# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A skin that was asked for and that nobody publishes, as pages are told of it; ROS_DOMAIN_ID 211."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from rclpy.node import Node
from sensor_msgs.msg import Image
from spinning import spinning_node
from view_node_bench import SHAPE, Bench, header_where
from waiting import wait_for

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


PATCH = "{at: [%s, 0], wires: {down: rows %s, across: cols}}"


def test_a_skin_that_is_launched_again_with_a_changed_layout_file_is_drawn_as_that_says(
    bench: Bench, tmp_path: Path
) -> None:
    """It was drawn as the file had said before, until the page's node was started again."""
    file = tmp_path / "sole.yaml"

    def furnish(node: Node) -> None:
        for name, value in {**SHAPE, "layout": str(file), "rows": 8, "cols": 8}.items():
            node.declare_parameter(name, value)

    def is_unasked() -> bool:
        return "/foot" in bench.view._begun_anew

    with bench.connect() as client:
        for patches in ({"whole": (0, "0 to 7")}, {"heel": (0, "0 to 3"), "toes": (4, "4 to 7")}):
            wait_for(is_unasked)
            lines = [f"  {name}: {PATCH % one}" for name, one in patches.items()]
            file.write_text("\n".join(["matrix: [8, 8]", "patches:", *lines, ""]))
            with spinning_node("reconstruction", "/foot", DOMAIN_ID, furnish):
                told = header_where(client, lambda one: one["type"] == "skin" and one["skin"] == "/foot")
                assert [patch["name"] for patch in told["patches"]] == list(patches)
                # The file is not read again with every answer.
                wait_for(lambda: not is_unasked())
