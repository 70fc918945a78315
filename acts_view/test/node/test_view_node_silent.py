# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images and contacts of a skin of which one comes seldom or no longer, as a page is shown them; ROS_DOMAIN_ID 210."""

from __future__ import annotations

import time
from array import array
from types import SimpleNamespace

import pytest
from sensor_msgs.msg import Image
from view_node_bench import Bench

from acts_ros import qos
from acts_view.nodes import skin_topics

pytestmark = pytest.mark.slow

DOMAIN_ID = 210


@pytest.fixture
def quick_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the clock of the topics, five times as much time passes."""
    monkeypatch.setattr(skin_topics, "time", SimpleNamespace(monotonic=lambda: 5.0 * time.monotonic()))


@pytest.mark.usefixtures("quick_clock")
def test_images_without_contacts_have_the_time_of_their_stamps_and_tell_nothing_of_touch(bench: Bench) -> None:
    image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
    picture = Image(height=2, width=2, encoding="mono16", step=4, data=array("B", bytes(8)))
    picture.header.stamp.sec = 1_790_000_000

    def play() -> None:
        image.publish(picture)

    def touch() -> tuple[bool, bool]:
        frame = bench.headers["frame"]
        return frame["touch_known"], frame["touch"] is not None

    with bench.connect() as client:
        bench.until(lambda: "image" in bench.arrays, client, play)
        assert bench.headers["frame"]["stamp_s"] == 1_790_000_000
        assert touch() == (False, False)
        bench.until(lambda: touch() == (True, True), client, lambda: bench.press(1.0))
        # As where a bag of images is played after the skin has ended.
        bench.until(lambda: touch() == (False, False), client, play)


@pytest.mark.usefixtures("quick_clock")
def test_an_image_that_no_longer_comes_is_not_shown_with_new_contacts(bench: Bench) -> None:
    image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
    picture = Image(height=2, width=2, encoding="mono16", step=4, data=array("B", bytes(8)))

    def play() -> None:
        image.publish(picture)
        bench.press(1.0)

    with bench.connect() as client:
        bench.until(lambda: "image" in bench.arrays, client, play)
        # As where a recording from the page, which has no images, is played after the skin has ended.
        bench.destroy([image])
        bench.until(lambda: "image" not in bench.arrays, client, lambda: bench.press(2.0))
        assert bench.is_pressed_with(2.0)
        image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
        bench.until(lambda: "image" in bench.arrays, client, play)


def test_an_image_that_comes_seldom_stays(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    # By the clock of the topics it is twenty seconds from one image, and one contact, to the next.
    now_s = 100.0
    monkeypatch.setattr(skin_topics, "time", SimpleNamespace(monotonic=lambda: now_s))
    image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
    picture = Image(height=2, width=2, encoding="mono16", step=4, data=array("B", bytes(8)))

    def play() -> None:
        bench.press(1.0)
        image.publish(picture)

    with bench.connect() as client:
        bench.until(lambda: "image" in bench.arrays, client, play)
        for force_n in (2.0, 3.0):
            now_s += 20.0
            bench.press(force_n)
            bench.until(lambda force_n=force_n: bench.is_pressed_with(force_n), client, lambda: None)  # type: ignore[misc]
            assert "image" in bench.arrays
            bench.arrays.clear()
            image.publish(picture)
            bench.until(lambda: "image" in bench.arrays, client, lambda: None)
