# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node ``view`` over DDS, read as the page reads it; ROS_DOMAIN_ID 176."""

from __future__ import annotations

import math
import time
import tracemalloc
from array import array
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from numpy.typing import NDArray
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image, JointState
from spinning import Spinning
from test_view_codec import decode
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from acts_core.errors import ArrayError, SettingsError
from acts_core.skin import RegionContact
from acts_msgs.msg import (
    BalanceStatus,
    BallReference,
    BallState,
    Contact,
    Contacts,
    ContactSeries,
    HandStatus,
    Outline,
    RegionContacts,
    TrackedContact,
)
from acts_ros import qos
from acts_ros.messages import ContactFields, write_contact, write_regions
from acts_view.nodes import view_node
from acts_view.nodes.view_node import ViewNode
from acts_view.settings import ViewSettings
from acts_view.skin.snapshot import SkinShape

pytestmark = pytest.mark.slow

DOMAIN_ID = 176
DEADLINE_S = 30.0
SHAPE = {"layout": "leap_right", "rows": 32, "cols": 32, "pitch_m": 0.0, "row_pitch_m": 0.0, "touch_counts": 50}
SHAPE |= {"force_full_scale_counts": 1000.0, "force_dead_n": 0.01, "force_half_n": 0.5, "force_response": ""}


class Bench:
    """The node, a skin that a test plays, and what pages were sent."""

    def __init__(self) -> None:
        self._context = Context()
        rclpy.init(context=self._context, domain_id=DOMAIN_ID)
        self.skin = Node("skin", namespace="hand", context=self._context)
        # The node asks this one what the skin is like.
        self._reconstruction = Node("reconstruction", namespace="hand", context=self._context)
        for name, value in SHAPE.items():
            self._reconstruction.declare_parameter(name, value)
        self.contact = self.skin.create_publisher(Contact, "contact", qos.STREAM)
        options = [Parameter("port", value=0), Parameter("outlines", value=True)]
        self.view = ViewNode(context=self._context, parameter_overrides=options)
        self._spinning = Spinning(self._context, self.skin, self._reconstruction, self.view)
        self.headers: dict[str, dict[str, Any]] = {}
        self.arrays: dict[str, NDArray[Any]] = {}
        self.history: list[NDArray[np.float32]] = []
        self._sequence = 0

    def connect(self) -> ClientConnection:
        address = self.view.address
        origin = Origin(address.url.rstrip("/"))
        return connect(f"ws://127.0.0.1:{address.port}/stream", origin=origin, compression=None)

    def press(self, force_n: float) -> None:
        self._sequence += 1
        stamp_ns = self.skin.get_clock().now().nanoseconds
        fields = ContactFields(
            stamp_ns, "hand", self._sequence, True, 0.01, 0.02, force_n, 700.0, 1e-4, 5, 0.002, 0, 0, 0, 0, 0
        )
        self.contact.publish(write_contact(fields))

    def destroy(self, publishers: list[Publisher]) -> None:
        # By the thread that spins: the executor may not meet one that is being destroyed.
        task = self._spinning.executor.create_task(lambda: [self.skin.destroy_publisher(one) for one in publishers])
        deadline_s = time.monotonic() + DEADLINE_S
        while not task.done():
            assert time.monotonic() < deadline_s
        task.result()

    def until(self, condition: Callable[[], bool], client: ClientConnection, meanwhile: Callable[[], Any]) -> None:
        deadline_s = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < deadline_s, (self.headers, self.arrays)
            meanwhile()
            self.read(client)

    def read(self, client: ClientConnection) -> None:
        patience_s = 0.02
        while True:
            try:
                message = client.recv(timeout=patience_s)
            except TimeoutError:
                return
            patience_s = 0.001
            header, arrays = decode(message)  # type: ignore[arg-type]
            self.headers[header["type"]] = header
            if header["type"] == "frame":
                self.arrays = arrays
                self.history.append(arrays["history"])

    def spin_until(self, condition: Callable[[], bool]) -> None:
        deadline_s = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < deadline_s
            time.sleep(0.002)

    def close(self) -> None:
        self._spinning.end()
        self.view.close()
        for node in (self.view, self._reconstruction, self.skin):
            node.destroy_node()
        rclpy.try_shutdown(context=self._context)


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench()
    yield made
    made.close()


def test_a_page_sees_a_skin_that_it_was_not_told_of_and_the_skin_is_left_alone_afterwards(bench: Bench) -> None:
    image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
    full_rate = bench.skin.create_publisher(Image, "image_raw", qos.STREAM)
    confidence = bench.skin.create_publisher(Image, "view/confidence", qos.VIEW)
    age = bench.skin.create_publisher(Image, "view/age", qos.VIEW)
    outlines = bench.skin.create_publisher(Outline, "outlines", qos.STREAM)
    contacts = bench.skin.create_publisher(Contacts, "view/contacts", qos.VIEW)
    regions = bench.skin.create_publisher(RegionContacts, "regions", qos.STREAM)
    status = bench.skin.create_publisher(HandStatus, "hand/status", qos.STATE)
    diagnostics = bench.skin.create_publisher(DiagnosticArray, "/diagnostics", 10)
    counts = np.arange(1024, dtype=np.uint16)
    message = Image(height=32, width=32, encoding="mono16", step=64, data=array("B", counts.tobytes()))
    sure = Image(height=32, width=32, encoding="mono8", step=32, data=array("B", bytes(range(256)) * 4))
    age_s = np.full(1024, np.inf, np.float32)
    age_s[:3] = [0.0, 0.00001, 0.0125]
    ages = Image(height=32, width=32, encoding="32FC1", step=128, data=array("B", age_s.tobytes()))
    one = TrackedContact(number=7, force=1.5, peak=700.0, area=1e-4)
    one.velocity.x, one.velocity.y = 0.3, 0.4

    def play() -> None:
        bench.press(1.0)
        bench.press(3.0)
        image.publish(message)
        confidence.publish(sure)
        age.publish(ages)
        outlines.publish(Outline(number=7, x=[0.0, 0.01, 0.0], y=[0.0, 0.0, 0.02]))
        outlines.publish(Outline(number=8, x=[0.0, 0.01, math.nan], y=[0.0, 0.0, 0.02]))
        outlines.publish(Outline(number=9, x=[0.0, 0.01], y=[0.0, 0.0, 0.02]))
        contacts.publish(Contacts(contacts=[one]))
        regions.publish(write_regions(0, "hand", 1, [RegionContact("palm", "palm_lower", 3, 1.25, slipping=True)]))
        status.publish(HandStatus(state=HandStatus.STATE_HOLDING, reason="something is gripped", active=["slip"]))
        diagnostics.publish(DiagnosticArray(status=[DiagnosticStatus(name="hand/driver", message="no board")]))

    assert contact_subscribers(bench) == 0
    with bench.connect() as client:
        bench.until(
            lambda: (
                {"image", "confidence", "age", "outlines"} <= bench.arrays.keys()
                and len(bench.arrays["contact_numbers"]) == 1
                and bool(bench.headers["frame"]["regions"] and bench.headers["frame"]["hand"])
                and bench.headers["skin"]["layout"] == "leap_right"
                and sum(map(len, bench.history)) > 2
                and any(one["name"] == "hand/driver" for one in bench.headers["status"]["diagnostics"])
            ),
            client,
            play,
        )
        assert full_rate.get_subscription_count() == 0
    np.testing.assert_array_equal(bench.arrays["image"].ravel(), counts)
    # In tenths of a millisecond.
    assert bench.arrays["age"].ravel()[:4].tolist() == [0, 1, 125, 65535]
    assert bench.arrays["contact_numbers"].tolist() == [7]
    assert bench.arrays["outline_sizes"].tolist() == [3]
    np.testing.assert_allclose(bench.arrays["outlines"], [[0.0, 0.0], [0.01, 0.0], [0.0, 0.02]], atol=1e-6)
    np.testing.assert_allclose(bench.arrays["contacts"][0, [2, 3, 6]], [1.5, 700.0, 0.5])
    frame = bench.headers["frame"]
    np.testing.assert_allclose(frame["touch"], [0.01, 0.02, 3.0, 700.0, 1e-4])
    assert frame["regions"] == [["palm", 1.25, 0.0, True]]
    assert frame["hand"] == {"state": "holding", "reason": "something is gripped", "active": ["slip"], "events": []}
    assert (bench.headers["skin"]["skin"], len(bench.headers["skin"]["patches"])) == ("/hand", 13)
    assert bench.headers["skin"]["touch_counts"] == 50
    history = np.concatenate(bench.history)
    assert history[:, 3].min() == 1.0
    assert history[:, 4].max() == 3.0
    assert history[:, 2].sum() == 0
    bench.spin_until(lambda: contact_subscribers(bench) == 0)


def test_where_nothing_is_for_viewers_the_image_is_that_at_frame_rate_as_in_a_bag(bench: Bench) -> None:
    full_rate = bench.skin.create_publisher(Image, "image_raw", qos.STREAM)
    data = array("B", np.full(64, 300, ">u2").tobytes())
    message = Image(height=8, width=8, encoding="mono16", is_bigendian=1, step=16, data=data)
    odd = Image(height=8, width=8, encoding="rgb8", step=24, data=array("B", bytes(192)))

    def play() -> None:
        full_rate.publish(odd)
        bench.press(1.0)
        full_rate.publish(message)

    with bench.connect() as client:
        bench.until(lambda: "image" in bench.arrays, client, play)
    assert (bench.arrays["image"] == 300).all()


def test_contacts_that_come_many_in_a_message_are_all_plotted(bench: Bench) -> None:
    publisher = bench.skin.create_publisher(ContactSeries, "view/contact_series", qos.VIEW)
    sent = 0

    def play() -> None:
        nonlocal sent
        series = ContactSeries(age=[0.003, 0.0], force=[1.0, 2.0], delay=[0.001, 0.002], missing=[4, 0])
        series.newest.header.stamp = bench.skin.get_clock().now().to_msg()
        series.newest.in_contact, series.newest.force, series.newest.peak = True, 2.0, 300.0
        publisher.publish(series)
        series.age = [math.nan, 0.0]
        publisher.publish(series)
        series.age = [0.0]
        publisher.publish(series)
        sent += 1

    with bench.connect() as client:
        bench.until(lambda: bool(sum(one[:, 1].sum() for one in bench.history) >= 6), client, play)
        assert contact_subscribers(bench) == 0
    history = np.concatenate(bench.history)
    assert history[:, 1].sum() <= 2 * sent
    # The second contact of the last message may still be in a row that is not complete.
    assert history[:, 2].sum() == 4 * math.ceil(history[:, 1].sum() / 2)
    assert history[:, 3].min() == 1.0
    assert history[:, 4].max() == 2.0
    np.testing.assert_allclose([history[:, 5].min(), history[:, 6].max()], [1.0, 2.0], rtol=1e-6)
    np.testing.assert_allclose(bench.headers["frame"]["touch"][2:4], [2.0, 300.0])


@pytest.mark.parametrize(
    ("topic", "kind", "profile"),
    [
        ("view/image_raw", Image, qos.VIEW),
        ("view/contacts", Contacts, qos.VIEW),
        ("regions", RegionContacts, qos.STREAM),
    ],
)
def test_bytes_that_are_no_message_are_told_and_the_page_goes_on(
    bench: Bench, capfd: pytest.CaptureFixture[str], topic: str, kind: type, profile: QoSProfile
) -> None:
    told = ""

    def is_told() -> bool:
        nonlocal told
        told += capfd.readouterr().err
        return f", {topic.removeprefix('view/')}: " in told

    with bench.connect() as client:
        bench.until(lambda: "frame" in bench.headers, client, lambda: bench.press(1.0))
        # Published only now: a page that is open finds topics that come later.
        publisher = bench.skin.create_publisher(kind, topic, profile)
        bench.until(is_told, client, lambda: publisher.publish(b"\xff" * 9))
        bench.headers.clear()
        bench.until(lambda: bench.headers.get("frame", {}).get("touch") is not None, client, lambda: bench.press(2.0))


def test_what_cannot_be_is_left_out_and_the_page_goes_on(bench: Bench, caplog: pytest.LogCaptureFixture) -> None:
    image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
    contacts = bench.skin.create_publisher(Contacts, "view/contacts", qos.VIEW)
    regions = bench.skin.create_publisher(RegionContacts, "regions", qos.STREAM)
    status = bench.skin.create_publisher(HandStatus, "hand/status", qos.STATE)
    diagnostics = bench.skin.create_publisher(DiagnosticArray, "/diagnostics", 10)
    huge = Image(height=65, width=64, encoding="mono16", step=128, data=array("B", bytes(65 * 128)))
    none = Image(height=0, width=0, encoding="mono16")
    broken = ContactFields(0, "hand", 7, True, math.nan, math.inf, math.nan, 0, 0, 0, 0, 0, 0, 0, 0, 0)
    patches = [RegionContact("palm", "palm_lower", 3, math.nan), *[RegionContact("x" * 300, "y", 1, 1.0)] * 70]
    named = iter(range(100_000))

    def play() -> None:
        image.publish(huge)
        image.publish(none)
        bench.contact.publish(write_contact(broken))
        bench.contact.publish(b"\x00\x01\x00\x00\xff")
        contacts.publish(Contacts(contacts=[TrackedContact(force=math.nan)] * 100))
        regions.publish(write_regions(0, "hand", 1, patches))
        status.publish(HandStatus(state=99, reason="r" * 10_000, active=["a"] * 1000))
        names = [f"made_up_{next(named)}" for _ in range(50)]
        diagnostics.publish(DiagnosticArray(status=[DiagnosticStatus(name=name, message="m" * 900) for name in names]))

    with bench.connect() as client:
        bench.until(
            lambda: (
                bool(bench.headers.get("frame", {}).get("regions") and bench.headers["frame"]["hand"])
                and len(bench.headers["status"]["diagnostics"]) == 200
                and len(bench.arrays["contacts"]) > 0
            ),
            client,
            play,
        )
        frame = bench.headers["frame"]
        assert "image" not in bench.arrays
        assert frame["touch"] is None
        assert len(bench.arrays["contacts"]) == 64
        assert (len(frame["regions"]), len(frame["regions"][0][0])) == (63, 200)
        assert (len(frame["hand"]["reason"]), len(frame["hand"]["active"])) == (200, 64)
        assert max(len(one["message"]) for one in bench.headers["status"]["diagnostics"]) == 500
        bench.until(lambda: bench.headers["frame"]["touch"] is not None, client, lambda: bench.press(2.0))
    assert [record.message for record in caplog.records if record.name == "asyncio"] == []


def test_of_long_diagnostics_only_what_can_be_shown_is_kept_and_that_not_for_ever(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    tracemalloc.start()
    try:
        for number in range(200):
            values = [KeyValue(key="k", value="v" * 1_000_000)]
            one = DiagnosticStatus(name=f"{number}/{'n' * 100_000}", message="m" * 100_000, values=values)
            bench.view._on_diagnostics(DiagnosticArray(status=[one]))
        assert tracemalloc.get_traced_memory()[0] < 5e6
    finally:
        tracemalloc.stop()
    assert len(bench.view._heard) == 200
    # Forgotten though no page is open.
    monkeypatch.setattr(view_node, "_FORGET_NODE_S", 0.1)
    deadline_s = time.monotonic() + DEADLINE_S
    while any(name[0].isdigit() for name in bench.view._heard):
        assert time.monotonic() < deadline_s


@pytest.mark.parametrize(
    "change",
    [{"rows": -5}, {"cols": 10**9}, {"rows": "8"}, {"layout": 3}, {"pitch_m": math.nan}, {"row_pitch_m": -1.0}],
)
def test_a_skin_that_cannot_be_is_refused(change: dict[str, Any]) -> None:
    with pytest.raises(ArrayError, match="cannot be shown"):
        SkinShape(**change)


@pytest.mark.parametrize("skins", ["my skin", "plate,9lives", "a//b", "~/plate"])
def test_only_namespaces_are_taken_as_skins(skins: str) -> None:
    with pytest.raises(SettingsError, match="is no namespace"):
        ViewSettings(skins=skins)


def contact_subscribers(bench: Bench) -> int:
    return bench.contact.get_subscription_count()


@pytest.mark.parametrize("presses", [0, 1])
def test_a_page_sees_ball_reference_tilt_and_joints_and_no_more_when_they_are_gone(bench: Bench, presses: int) -> None:
    place = bench.skin.create_publisher(BallState, "ball/state", qos.STATE)
    reference = bench.skin.create_publisher(BallReference, "ball/reference", qos.STATE)
    status = bench.skin.create_publisher(BalanceStatus, "ball/status", qos.STATE)
    joints = bench.skin.create_publisher(JointState, "joint_states", qos.STATE)
    ball = BallState(valid=True)
    ball.position.x, ball.position.y = 0.01, -0.02
    wanted = BallReference(segment="N")
    wanted.position.x = 0.03
    balancing = BalanceStatus(state=BalanceStatus.STATE_BALANCING, reason="a ball and a reference")
    balancing.tilt_measured.x, balancing.tilt_commanded.y = 0.05, float("nan")

    def play() -> None:
        bench.press(1.0)
        place.publish(ball)
        reference.publish(wanted)
        status.publish(balancing)
        joints.publish(JointState(name=["knee", "hip"], position=[0.5, float("nan")]))

    def seen() -> dict[str, Any]:
        return bench.headers.get("frame", {"ball": {}, "hand": {}})

    def press() -> None:
        for _ in range(presses):
            bench.press(1.0)

    with bench.connect() as client:
        bench.until(lambda: len(seen()["ball"]) == 7 and "joints" in seen()["hand"], client, play)
        assert seen()["ball"] == {
            "ball": [0.01, -0.02],
            "reference": [0.03, 0.0],
            "segment": "N",
            "state": "balancing",
            "reason": "a ball and a reference",
            "tilt_measured": [0.05, 0.0],
            "tilt_commanded": None,
        }
        assert seen()["hand"] == {"joints": [["knee", 0.5]]}
        bench.destroy([place, reference, status, joints])
        none: dict[str, Any] = {"ball": {}, "hand": {}}
        bench.until(lambda: seen() | none == seen(), client, press)
