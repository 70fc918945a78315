# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The topics of one skin, polled: what is newest of each, as the page is to show it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image, JointState

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import PacketError
from acts_msgs.msg import (
    BalanceStatus,
    BallReference,
    BallState,
    Contacts,
    HandStatus,
    ObjectClass,
    RegionContacts,
)
from acts_ros import qos
from acts_ros.log import STEADY
from acts_ros.messages import (
    ImageFields,
    RegionsFields,
    read_contacts,
    read_image,
    read_regions,
)
from acts_ros.polled import PolledSubscription, PollingNode
from acts_view.nodes.contact_topic import ContactTopic
from acts_view.nodes.outline_topic import OutlineTopic
from acts_view.nodes.robot_states import (
    SHOWN,
    TEXT,
    balance_state,
    ball_place,
    ball_reference,
    hand_state,
    joint_angles,
    known_object,
)
from acts_view.skin.snapshot import Frame, RegionState, Sample, contact_table

R = TypeVar("R")

_PIXELS = {"mono16": "u2", "mono8": "u1", "32FC1": "f4"}


class _Topic(NamedTuple):
    """Of a topic on which a node says something besides touch.

    `kind` is its type, `read` what is taken of a message, `place` where in `Frame` that goes.
    """

    kind: type
    read: Callable[[Any], dict[str, Any]]
    place: str
    profile: QoSProfile = qos.STATE


_TOPICS = {
    "hand/status": _Topic(HandStatus, hand_state, "hand"),
    "joint_states": _Topic(JointState, lambda message: {"joints": joint_angles(message)}, "hand"),
    "ball/state": _Topic(BallState, ball_place, "ball"),
    "ball/reference": _Topic(BallReference, ball_reference, "ball"),
    "ball/status": _Topic(BalanceStatus, balance_state, "ball"),
    # Of both the latter, which knows the names.
    "board_object": _Topic(ObjectClass, known_object, "object", qos.STREAM),
    "object": _Topic(ObjectClass, known_object, "object"),
}

# All of them come several times a second; as of the diagnostics on the page.
_STALE_S = 3.0
# An image, or a contact beside images, is missed later: bags may have few of them.
_FROZEN_S = 10.0

_NOTHING = Frame()
# Of what comes beside images and contacts: which values of `Frame` are then as if nothing had come.
_BESIDE: dict[str, dict[str, Any]] = {
    "confidence": {"confidence": _NOTHING.confidence},
    "age": {"age_s": _NOTHING.age_s},
    "contacts": {"contact_numbers": _NOTHING.contact_numbers, "contacts": _NOTHING.contacts},
    "regions": {"regions": _NOTHING.regions},
}
# These belong to an image, and are as old as it may be.
_OF_IMAGE = ("confidence", "age")


class SkinTopics:
    """Subscribes to what a skin publishes; one call at a time, from the executor's thread, `take` from any.

    Parameters
    ----------
    node : PollingNode
    namespace : str
        Of the skin, with a slash before.
    with_outlines : bool
        Whether to subscribe to ``outlines`` as well.
    """

    def __init__(self, node: PollingNode, namespace: str, *, with_outlines: bool = False) -> None:
        self._node = node
        self._namespace = namespace
        self._polled: dict[str, PolledSubscription[Any]] = {}
        self._silent: set[str] = set()
        self._frame = Frame(is_touch_known=False)
        # When an image, a contact and each of `_BESIDE` came last, by the monotonic clock [s].
        self._came_s: dict[str, float] = {}
        # Of each topic of `_TOPICS`, what was said last, and when by the monotonic clock [s].
        self._told: dict[str, tuple[float, dict[str, Any]]] = {}
        self._is_teller_gone = False
        # How long what was taken last had waited [s], by topic.
        self._waited_s: dict[str, float] = {}
        self._contact = ContactTopic(node, namespace)
        self._polled["regions"] = node.create_raw_polled_subscription(
            RegionContacts, f"{namespace}/regions", qos.STREAM, depth=1
        )
        for topic, (kind, _, _, profile) in _TOPICS.items():
            if topic != "object":
                self._polled[topic] = node.create_polled_subscription(kind, f"{namespace}/{topic}", profile, depth=1)
        self._outlines = OutlineTopic(node, namespace) if with_outlines else None
        self.look()

    def look(self) -> None:
        """Choose anew, now and then, between the topics for viewers and, as in a bag, those at 1 kHz."""
        self._contact.look()
        self._choose("image_raw", Image)
        self._choose("confidence", Image)
        self._choose("age", Image)
        self._choose("contacts", Contacts)
        self._choose("object", ObjectClass)
        # Each question whether something has come takes the process some 30 us; most skins are no hand and no plate.
        self._silent = {
            what for what, polled in self._polled.items() if not self._node.count_publishers(polled.topic_name)
        }
        # What a controller has said is no longer so when it is gone or hangs; another one may go on.
        since_s = time.monotonic() - _STALE_S
        for topic in [topic for topic, (told_s, _) in self._told.items() if told_s < since_s or topic in self._silent]:
            del self._told[topic]
            self._is_teller_gone = True

    def close(self) -> None:
        """Subscribe no longer."""
        for subscription in self._polled.values():
            self._node.destroy_polled_subscription(subscription)
        self._polled.clear()
        self._contact.close()
        if self._outlines is not None:
            self._outlines.close()

    def without_tellers(self) -> Frame | None:
        """What was taken last without what controllers have said; None where they have said nothing."""
        frame = self._frame
        if not (frame.hand or frame.ball or frame.object):
            return None
        return replace(frame, hand=_NOTHING.hand, ball=_NOTHING.ball, object=_NOTHING.object)

    @property
    def image_waited_s(self) -> float:
        """How long the image that the last call of `take` found had waited [s]; NaN where there was none."""
        return self._waited_s.get("image_raw", math.nan)

    def take(self) -> tuple[Frame, list[Sample]] | None:
        """The newest of everything and all of the 1 kHz stream since the last call; None where nothing came or went."""
        self._waited_s.clear()
        samples, touch, stamp_s = self._contact.take()
        images = {name: self._newest_read(name, read_image) for name in ("image_raw", "confidence", "age")}
        contacts, regions = self._newest_read("contacts", read_contacts), self._newest_read("regions", read_regions)
        told = {topic: message for topic in _TOPICS if (message := self._newest(topic)) is not None}
        nothing_came = not told and all(one is None for one in (*images.values(), contacts, regions))
        if not samples and nothing_came and not self._is_teller_gone:
            return None
        self._is_teller_gone = False
        now_s = time.monotonic()
        self._told |= {topic: (now_s, _TOPICS[topic].read(message)) for topic, message in told.items()}
        self._forget_frozen()
        image = _pixels(images["image_raw"], "mono16")
        # Of a bag without contacts those of the images.
        stamps_s = [] if stamp_s is None else [stamp_s]
        if image is not None and images["image_raw"] is not None:
            stamps_s.append(images["image_raw"].stamp_ns * 1e-9)
        confidence = _pixels(images["confidence"], "mono8")
        age_s = _pixels(images["age"], "32FC1")
        came: dict[str, object] = {"image": image, "touch": samples or None, "confidence": confidence, "age": age_s}
        came |= {"contacts": contacts, "regions": regions}
        self._came_s |= {what: now_s for what, one in came.items() if one is not None}
        old = self._without_stale(now_s, is_image_new=image is not None, is_touch_new=bool(samples))
        numbers, table = old.contact_numbers, old.contacts
        if contacts is not None:
            numbers, table = contact_table(contacts.contacts[:SHOWN])
        self._frame = Frame(
            stamp_s=max(stamps_s, default=old.stamp_s),
            # More than a converter can give has no colour and no force.
            image=old.image if image is None else np.minimum(image, COUNT_MAX),
            confidence=old.confidence if confidence is None else confidence,
            age_s=old.age_s if age_s is None else age_s,
            contact_numbers=numbers,
            contacts=table,
            outlines=() if self._outlines is None else self._outlines.take(),
            touch=touch if samples else old.touch,
            is_touch_known=bool(samples) or old.is_touch_known,
            regions=old.regions if regions is None else _regions(regions),
            hand=self._known("hand"),
            ball=self._known("ball"),
            object=self._known("object"),
        )
        return self._frame, samples

    def _without_stale(self, now_s: float, *, is_image_new: bool, is_touch_new: bool) -> Frame:
        """What was shown, without what has not come for long beside an image or a contact that is new.

        A skin launched again may publish less than before. Of one that is silent all stays, as of one moment.
        """
        stale = [what for what in _BESIDE if self._came_s.get(what, now_s) < now_s - _STALE_S]
        for what in stale:
            if is_image_new or (is_touch_new and what not in _OF_IMAGE):
                del self._came_s[what]
                self._frame = replace(self._frame, **_BESIDE[what])
        return self._frame

    def _forget_frozen(self) -> None:
        """Leave out an image that does not come while contacts do, or a contact while images do, as in many bags.

        By what came before, since at a slow rate both come at long intervals, one shortly after the other.
        """
        image_s, touch_s = self._came_s.get("image"), self._came_s.get("touch")
        if image_s is None or touch_s is None:
            return
        if touch_s > image_s + _FROZEN_S:
            del self._came_s["image"]
            self._frame = replace(self._frame, image=None, confidence=None, age_s=None)
        elif image_s > touch_s + _FROZEN_S:
            del self._came_s["touch"]
            self._frame = replace(self._frame, touch=None, is_touch_known=False)

    def _known(self, place: str) -> dict[str, Any]:
        """What is known of a hand, a ball or an object."""
        return {
            key: value
            for topic in _TOPICS
            if _TOPICS[topic].place == place and topic in self._told
            for key, value in self._told[topic][1].items()
        }

    def _choose(self, what: str, kind: type) -> None:
        at_view_rate = f"{self._namespace}/view/{what}"
        is_published = self._node.count_publishers(f"{self._namespace}/{what}") > 0
        is_for_viewers = self._node.count_publishers(at_view_rate) > 0 or not is_published
        topic, profile = (at_view_rate, qos.VIEW) if is_for_viewers else (f"{self._namespace}/{what}", qos.STREAM)
        present = self._polled.get(what)
        if present is not None and present.topic_name == topic:
            return
        if present is not None:
            self._node.destroy_polled_subscription(present)
        create = self._node.create_polled_subscription if what in _TOPICS else self._node.create_raw_polled_subscription
        self._polled[what] = create(kind, topic, profile, depth=1)

    def _newest(self, what: str) -> Any:
        """The newest message of a topic; None where none has come, or, at the last look, nobody published it."""
        if what in self._silent:
            return None
        taken = self._polled[what].take_newest()
        if taken is None:
            return None
        message, self._waited_s[what] = taken
        return message

    def _newest_read(self, what: str, read: Callable[[bytes], R]) -> R | None:
        """The same of a topic whose messages stay bytes until here; None also for what is no such message."""
        data = self._newest(what)
        if data is None:
            return None
        try:
            return read(data)
        except PacketError as error:
            self._node.get_logger().warning(
                f"{self._namespace}, {what}: {error}", throttle_duration_sec=5.0, throttle_time_source_type=STEADY
            )
            return None


def _pixels(image: ImageFields | None, encoding: str) -> NDArray[Any] | None:
    """The pixels of an image of counts, confidence or ages; None for any other."""
    if image is None or image.encoding != encoding:
        return None
    if not (1 <= image.width <= MAX_SIDE and 1 <= image.height <= MAX_SIDE):
        return None
    kind = np.dtype(_PIXELS[encoding]).newbyteorder(">" if image.is_bigendian else "<")
    if image.step != image.width * kind.itemsize or len(image.data) != image.step * image.height:
        return None
    return np.frombuffer(image.data, kind).reshape(image.height, image.width).astype(_PIXELS[encoding])


def _regions(fields: RegionsFields) -> list[RegionState]:
    return [
        RegionState(one.name[:TEXT], one.force_n, one.slip_m, one.slipping)
        for one in fields.regions[:SHOWN]
        if math.isfinite(one.force_n) and math.isfinite(one.slip_m)
    ]
