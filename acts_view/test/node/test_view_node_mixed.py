# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Several nodes that publish the touch of one skin, and too many skins, as pages are told; ROS_DOMAIN_ID 204."""

from __future__ import annotations

from typing import Any

import pytest
from rclpy.node import Node
from view_node_bench import Bench

from acts_msgs.msg import Contact, TactileSamples
from acts_ros import qos

pytestmark = pytest.mark.slow

DOMAIN_ID = 204


def test_a_second_publisher_of_a_skin_is_named_until_it_is_gone(bench: Bench) -> None:
    player = Node("player", context=bench.skin.context)
    contact = player.create_publisher(Contact, "/hand/contact", qos.STREAM)
    # One alone is as it should be.
    player.create_publisher(TactileSamples, "/hand/samples", qos.STREAM)

    def told() -> list[dict[str, Any]]:
        return [one for one in bench.diagnostics if one["name"] == "/hand"]

    with bench.connect() as client:
        bench.until(lambda: bool(told()), client, lambda: bench.press(1.0))
        (one,) = told()
        assert one["level"] == 1
        assert one["message"] == "/hand/contact has 2 publishers (/hand/skin, /player): end all but one"
        player.destroy_publisher(contact)
        bench.until(lambda: not told(), client, lambda: bench.press(1.0))
    player.destroy_node()


def test_of_skins_that_anybody_makes_up_no_more_are_shown_than_a_page_can_take(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = [(f"/made_{number}/contact", ["acts_msgs/msg/Contact"]) for number in range(100)]
    others = [("/hand/contact", ["std_msgs/msg/String"]), ("/foot/contacts", ["acts_msgs/msg/Contact"])]
    monkeypatch.setattr(bench.view, "get_topic_names_and_types", lambda: [*others, *made])
    for _ in range(2):
        names = bench.view._recorded()
        assert len(set(names)) == len(names) == 32
        assert all(name.startswith("/made_") for name in names)
        assert list(names) == sorted(names)
