# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node ``view`` where one of its skins fails; ROS_DOMAIN_ID 223."""

from __future__ import annotations

import time
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from spinning import Spinning
from view_messages import decode
from websockets.sync.client import connect
from websockets.typing import Origin

from acts_msgs.msg import Contact
from acts_ros import qos
from acts_view.nodes.skin_topics import SkinTopics
from acts_view.nodes.view_node import ViewNode

pytestmark = pytest.mark.slow

DOMAIN_ID = 223
DEADLINE_S = 30.0


def test_a_skin_that_cannot_be_shown_leaves_the_others_and_is_told_of(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    taken = SkinTopics.take

    def take(topics: SkinTopics) -> Any:
        if topics._namespace == "/broken":
            raise ValueError("made for the test")
        return taken(topics)

    monkeypatch.setattr(SkinTopics, "take", take)
    context = Context()
    rclpy.init(context=context, domain_id=DOMAIN_ID)
    skins = [Node("skin", namespace=name, context=context) for name in ("broken", "whole")]
    publishers = [skin.create_publisher(Contact, "contact", qos.STREAM) for skin in skins]
    view = ViewNode(context=context, parameter_overrides=[Parameter("port", value=0)])
    spinning = Spinning(context, *skins, view)
    address, shown, deadline_s = view.address, "", time.monotonic() + DEADLINE_S
    try:
        url = f"ws://127.0.0.1:{address.port}/stream"
        with connect(url, origin=Origin(address.url.rstrip("/")), compression=None) as client:
            while not shown:
                assert time.monotonic() < deadline_s, "no frame is shown"
                for publisher in publishers:
                    publisher.publish(Contact(in_contact=True, force=1.0))
                header, _ = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
                shown = header["skin"] if header["type"] == "frame" else ""
    finally:
        spinning.end()
        view.close()
        for node in (*skins, view):
            node.destroy_node()
        rclpy.try_shutdown(context=context)
    assert shown == "/whole"
    told = capfd.readouterr().err
    assert "/broken cannot be shown" in told
    assert "ValueError: made for the test" in told
