# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the node ``view`` tells of a known object that presses, and where it takes that from; ROS_DOMAIN_ID 203."""

from __future__ import annotations

import math
from typing import Any

import pytest
from view_node_bench import Bench

from acts_msgs.msg import ObjectClass
from acts_ros import qos

pytestmark = pytest.mark.slow

DOMAIN_ID = 203


def seen(bench: Bench) -> dict[str, Any]:
    found = bench.headers.get("frame", {"object": {}})["object"]
    assert isinstance(found, dict)
    return found


def test_a_page_sees_the_known_object_until_nobody_classifies(bench: Bench) -> None:
    viewed = bench.skin.create_publisher(ObjectClass, "view/object", qos.VIEW)
    full_rate = bench.skin.create_publisher(ObjectClass, "object", qos.STREAM)
    message = ObjectClass(class_number=2, name="spoon", confidence=0.5, residuals=[0.75, 0.5, 0.25, 1.0, math.nan])

    def play() -> None:
        bench.press(1.0)
        viewed.publish(message)

    with bench.connect() as client:
        bench.until(lambda: bool(seen(bench)), client, play)
        assert seen(bench) == {
            "number": 2,
            "name": "spoon",
            "confidence": 0.5,
            "nearest": [[2, 0.25], [1, 0.5], [0, 0.75]],
        }
        # Of each frame the reconstruction classifies for those who listen to this.
        assert full_rate.get_subscription_count() == 0
        message = ObjectClass(class_number=ObjectClass.NO_OBJECT, residuals=[1.0, 1.0])
        bench.until(lambda: seen(bench).get("number", 2) is None, client, play)
        assert seen(bench) == {"number": None, "name": "", "confidence": None, "nearest": []}
        bench.destroy([viewed, full_rate])
        bench.until(lambda: not seen(bench), client, lambda: bench.press(1.0))


@pytest.mark.parametrize("residuals", [[0.25], [0.25, math.nan]])
def test_without_another_object_there_is_no_confidence(bench: Bench, residuals: list[float]) -> None:
    publisher = bench.skin.create_publisher(ObjectClass, "view/object", qos.VIEW)

    def play() -> None:
        publisher.publish(ObjectClass(class_number=0, name="n" * 300, residuals=residuals))

    with bench.connect() as client:
        bench.until(lambda: bool(seen(bench)), client, play)
    assert seen(bench) == {"number": 0, "name": "n" * 200, "confidence": None, "nearest": [[0, 0.25]]}


def test_the_board_s_own_object_is_shown_where_the_reconstruction_classifies_none(bench: Bench) -> None:
    board = bench.skin.create_publisher(ObjectClass, "board_object", qos.STREAM)
    # As in a bag: nothing for viewers.
    node = bench.skin.create_publisher(ObjectClass, "object", qos.STREAM)

    def play() -> None:
        board.publish(ObjectClass(class_number=7, confidence=0.5, residuals=[1.0] * 7 + [0.5]))

    def play_both() -> None:
        node.publish(ObjectClass(class_number=1, name="spoon", confidence=0.25, residuals=[0.75, 0.5]))
        play()

    with bench.connect() as client:
        bench.until(lambda: bool(seen(bench)), client, play)
        assert (seen(bench)["number"], seen(bench)["name"]) == (7, "")
        bench.until(lambda: seen(bench).get("number") == 1, client, play_both)
        assert seen(bench)["name"] == "spoon"
        bench.destroy([node])
        bench.until(lambda: seen(bench).get("number") == 7, client, play)
