# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is taken of the topics of a skin, and for how long it counts; without ROS."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from view_made_node import S_NS, MadeNode, series

from acts_core.skin import RegionContact, TrackedBlob
from acts_msgs.msg import BallState, HandStatus, ObjectClass
from acts_ros.messages import ContactsFields, ImageFields, RegionsFields, write_contacts, write_image, write_regions
from acts_view.nodes import skin_topics
from acts_view.nodes.skin_topics import SkinTopics
from acts_view.skin.snapshot import Frame, RegionState, Sample

BESIDE = ("confidence", "age", "contacts")
FOR_VIEWERS = {f"/plate/view/{what}" for what in ("contact_series", "image_raw", *BESIDE, "object")}
PICTURE: NDArray[np.uint16] = np.arange(6, dtype=np.uint16).reshape(2, 3)
PALM = RegionContact("palm", "palm_lower", 3, 1.25, slipping=True)._replace(slip_m=0.5)


class Clock:
    def __init__(self) -> None:
        self.now_s = 500.0


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(skin_topics, "time", SimpleNamespace(monotonic=lambda: clock.now_s))
    return clock


def topics_of(node: MadeNode, **options: bool) -> SkinTopics:
    return SkinTopics(node, "/plate", **options)  # type: ignore[arg-type]


def image(pixels: NDArray[Any], encoding: str, stamp_s: int = 1000, **changes: Any) -> bytes:
    rows, cols = pixels.shape
    fields = ImageFields(stamp_s * S_NS, "plate", rows, cols, encoding, False, pixels.strides[0], pixels.tobytes())
    return write_image(fields._replace(**changes))


def blob(number: int) -> TrackedBlob:
    return TrackedBlob(*[0] * len(TrackedBlob._fields))._replace(number=number, force_n=2.0)


def taken(topics: SkinTopics) -> Frame:
    found = topics.take()
    assert found is not None
    return found[0]


def test_all_that_a_skin_publishes_for_viewers_is_one_frame() -> None:
    node = MadeNode(*FOR_VIEWERS, "/plate/image_raw", "/plate/contact", "/plate/regions")
    topics = topics_of(node)
    assert topics.take() is None
    node.come("/plate/view/contact_series", series(1003.0, 0.25, 0.0))
    node.come("/plate/view/image_raw", image(PICTURE, "mono16", stamp_s=1001))
    assert math.isnan(topics.image_waited_s)
    node.come("/plate/view/confidence", image(PICTURE.astype(np.uint8), "mono8"))
    node.come("/plate/view/age", image(PICTURE.astype(np.float32), "32FC1"))
    node.come("/plate/view/contacts", write_contacts(ContactsFields(0, "plate", 1, [blob(4)] * 70, 0)))
    node.come("/plate/regions", write_regions(RegionsFields(0, "plate", 1, [PALM] * 70)))
    found = topics.take()
    assert found is not None
    frame, samples = found
    assert topics.image_waited_s == 0.5
    assert samples == pytest.approx(np.array([Sample(1002.75, 1.0, 2.0, 3), Sample(1003.0, 2.0, 2.0, 3)]))
    assert frame.stamp_s == pytest.approx(1003.0)
    for shown, kind in ((frame.image, np.uint16), (frame.confidence, np.uint8), (frame.age_s, np.float32)):
        assert shown is not None
        assert shown.dtype == kind
        np.testing.assert_array_equal(shown, PICTURE)
    assert frame.contact_numbers.tolist() == [4] * 64
    assert frame.regions == [RegionState("palm", 1.25, 0.5, True)] * 64
    assert frame.touch == pytest.approx((0.01, 0.02, 1.0, 700.0, 1e-4))
    assert frame.is_touch_known
    assert topics.take() is None
    assert math.isnan(topics.image_waited_s)
    # What has not come again is as it was; the stamp is that of what has.
    node.come("/plate/view/image_raw", image(PICTURE + 1, "mono16", stamp_s=1004))
    later = taken(topics)
    assert later.stamp_s == pytest.approx(1004.0)
    assert later.image is not None
    assert later.image[0, 0] == 1
    assert later.confidence is frame.confidence
    assert later.age_s is frame.age_s
    assert later.contacts is frame.contacts
    assert later.regions == frame.regions
    assert (later.touch, later.is_touch_known) == (frame.touch, True)
    node.come("/plate/view/contacts", write_contacts(ContactsFields(0, "plate", 1, [], 0)))
    last = taken(topics)
    assert (last.stamp_s, len(last.contacts)) == (later.stamp_s, 0)
    assert last.image is later.image


@pytest.mark.parametrize(
    "changes",
    [
        {"encoding": "mono8"},
        {"height": 0},
        {"width": 0, "step": 0},
        {"step": 8},
        {"step": 8, "data": bytes(16)},
        {"data": bytes(11)},
        {"height": 65, "width": 3, "data": bytes(6 * 65)},
        {"height": 1, "width": 65, "step": 130, "data": bytes(130)},
    ],
)
def test_an_image_that_cannot_be_one_of_counts_is_not_shown(changes: dict[str, Any]) -> None:
    node = MadeNode("/plate/view/image_raw", "/plate/view/contact_series")
    topics = topics_of(node)
    node.come("/plate/view/contact_series", series(1000.0, 0.0))
    node.come("/plate/view/image_raw", image(PICTURE, **{"encoding": "mono16", "stamp_s": 2000, **changes}))
    frame = taken(topics)
    assert frame.image is None
    assert frame.stamp_s == pytest.approx(1000.0)
    # The largest that there can be is.
    largest = np.full((64, 64), 300, ">u2")
    largest[0, 0] = 2000
    node.come("/plate/view/image_raw", image(largest, "mono16", is_bigendian=True))
    frame = taken(topics)
    assert frame.image is not None
    np.testing.assert_array_equal(frame.image, np.minimum(largest, 1023))


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_regions_are_shown_but_those_that_are_no_numbers(number: float) -> None:
    node = MadeNode("/plate/regions")
    topics = topics_of(node)
    regions = [
        PALM,
        RegionContact("thumb", "thumb_tip", 3, number),
        RegionContact("index", "index_tip", 3, 1.0)._replace(slip_m=number),
    ]
    node.come("/plate/regions", write_regions(RegionsFields(0, "plate", 1, regions)))
    assert taken(topics).regions == [RegionState("palm", 1.25, 0.5, True)]


def test_what_no_longer_comes_is_not_shown_beside_what_is_newer(clock: Clock) -> None:
    node = MadeNode(*FOR_VIEWERS, "/plate/regions")
    topics = topics_of(node)

    def come_image() -> Frame:
        node.come("/plate/view/image_raw", image(PICTURE, "mono16"))
        return taken(topics)

    def come_touch() -> Frame:
        node.come("/plate/view/contact_series", series(1000.0, 0.0))
        return taken(topics)

    def shown(frame: Frame) -> list[bool]:
        return [frame.confidence is not None, frame.age_s is not None, len(frame.contacts) > 0]

    node.come("/plate/view/confidence", image(PICTURE.astype(np.uint8), "mono8"))
    node.come("/plate/view/age", image(PICTURE.astype(np.float32), "32FC1"))
    node.come("/plate/view/contacts", write_contacts(ContactsFields(0, "plate", 1, [blob(4)], 0)))
    assert shown(come_image()) == [True, True, True]
    clock.now_s += 2.9
    assert shown(come_image()) == shown(come_touch()) == [True, True, True]
    clock.now_s += 0.2
    # Of one moment with the last image, which stays.
    assert shown(come_touch()) == [True, True, False]
    assert shown(come_image()) == [False, False, False]
    # What has been left out comes again.
    node.come("/plate/view/age", image(PICTURE.astype(np.float32), "32FC1"))
    assert shown(come_image()) == [False, True, False]


def test_an_image_or_a_touch_that_does_not_come_while_the_other_does_is_left_out_after_ten_seconds(
    clock: Clock,
) -> None:
    node = MadeNode(*FOR_VIEWERS)
    topics = topics_of(node)

    def come_image() -> tuple[bool, bool]:
        node.come("/plate/view/image_raw", image(PICTURE, "mono16"))
        return shown()

    def come_touch() -> tuple[bool, bool]:
        node.come("/plate/view/contact_series", series(1000.0, 0.0))
        return shown()

    def shown() -> tuple[bool, bool]:
        frame = taken(topics)
        assert frame.is_touch_known == (frame.touch is not None)
        assert (frame.confidence is None) == (frame.image is None)
        return frame.image is not None, frame.touch is not None

    node.come("/plate/view/confidence", image(PICTURE.astype(np.uint8), "mono8"))
    assert come_image() == (True, False)
    assert come_touch() == (True, True)
    for come, alone in ((come_touch, (False, True)), (come_image, (True, False))):
        node.come("/plate/view/confidence", image(PICTURE.astype(np.uint8), "mono8"))
        come_image()
        assert come_touch() == (True, True)
        for _ in range(4):
            clock.now_s += 2.4
            if come is come_image:
                node.come("/plate/view/confidence", image(PICTURE.astype(np.uint8), "mono8"))
            assert come() == (True, True)
        clock.now_s += 1.0
        # By what came before.
        come()
        assert come() == alone


def test_what_controllers_have_said_is_not_so_when_they_are_gone_or_silent(clock: Clock) -> None:
    node = MadeNode("/plate/ball/state", "/plate/hand/status", "/plate/view/object", "/plate/view/contact_series")
    topics = topics_of(node)
    assert topics.without_tellers() is None

    def come_all() -> Frame:
        node.come("/plate/ball/state", BallState(valid=False))
        node.come("/plate/hand/status", HandStatus(state=HandStatus.STATE_HOLDING))
        node.come("/plate/view/object", ObjectClass(class_number=3, name="spoon"))
        return taken(topics)

    def told(frame: Frame) -> list[bool]:
        return [bool(frame.ball), bool(frame.hand), bool(frame.object)]

    assert told(come_all()) == [True, True, True]
    clock.now_s += 2.9
    topics.look()
    assert topics.take() is None
    # One is gone: what it has said goes at once, without anything else that comes.
    node.published.remove("/plate/view/object")
    topics.look()
    assert told(taken(topics)) == [True, True, False]
    assert topics.take() is None
    # One says something again, and the other hangs.
    node.come("/plate/ball/state", BallState(valid=False))
    assert told(taken(topics)) == [True, True, False]
    clock.now_s += 0.2
    topics.look()
    assert told(taken(topics)) == [True, False, False]


@pytest.mark.parametrize(
    ("topic", "message"),
    [
        ("ball/state", BallState(valid=False)),
        ("hand/status", HandStatus(state=HandStatus.STATE_HOLDING)),
        ("view/object", ObjectClass(class_number=3, name="spoon")),
    ],
)
def test_for_who_comes_later_there_is_what_was_last_without_what_controllers_said(topic: str, message: Any) -> None:
    node = MadeNode("/plate/view/contact_series", f"/plate/{topic}")
    topics = topics_of(node)
    node.come("/plate/view/contact_series", series(1000.0, 0.0))
    node.come(f"/plate/{topic}", message)
    frame = taken(topics)
    assert frame.ball or frame.hand or frame.object
    later = topics.without_tellers()
    assert later is not None
    assert (later.ball, later.hand, later.object) == ({}, {}, {})
    assert later.touch == frame.touch is not None


def test_topics_at_frame_rate_are_taken_only_where_there_is_nothing_for_viewers() -> None:
    at_frame_rate = {f"/plate/{what}" for what in ("contact", "image_raw", *BESIDE, "object")}
    always = {f"/plate/{what}" for what in ("regions", "hand/status", "joint_states", "board_object", "outlines")}
    always |= {f"/plate/ball/{what}" for what in ("state", "reference", "status")}
    node = MadeNode()
    topics = topics_of(node, with_outlines=True)
    # Where nothing is published yet, what is for viewers is waited for.
    assert node.subscriptions.keys() == FOR_VIEWERS | always
    node.published |= at_frame_rate
    topics.look()
    assert node.subscriptions.keys() == at_frame_rate | always
    node.published |= FOR_VIEWERS
    topics.look()
    assert node.subscriptions.keys() == FOR_VIEWERS | always
    topics.close()
    assert node.subscriptions == {}
