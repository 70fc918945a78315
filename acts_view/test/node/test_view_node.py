# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node ``view`` over DDS, read as the page reads it; ROS_DOMAIN_ID 176."""

from __future__ import annotations

import math
import tracemalloc
from array import array
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.qos import QoSProfile
from rclpy.timer import Timer
from sensor_msgs.msg import Image
from view_node_bench import DEADLINE_S, Bench
from waiting import wait_for

from acts_core.errors import ArrayError, SettingsError
from acts_core.skin import RegionContact
from acts_msgs.msg import (
    Contact,
    Contacts,
    ContactSeries,
    HandStatus,
    Outline,
    RegionContacts,
    TrackedContact,
)
from acts_ros import qos
from acts_ros.messages import ContactFields, RegionsFields, write_contact, write_regions
from acts_view.nodes import view_node
from acts_view.settings import ViewSettings
from acts_view.skin.snapshot import SkinShape

pytestmark = pytest.mark.slow

DOMAIN_ID = 176


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
        palm = RegionContact("palm", "palm_lower", 3, 1.25, slipping=True)
        regions.publish(write_regions(RegionsFields(0, "hand", 1, [palm])))
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
                and any(one["name"] == "hand/driver" for one in bench.diagnostics)
                # A frame may be made between two presses.
                and bench.is_pressed_with(3.0)
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
    wait_for(lambda: contact_subscribers(bench) == 0)


def test_timers_rest_but_while_a_page_waits_for_a_skin(bench: Bench) -> None:
    """A timer of ROS costs more than what the view would call by it."""
    without_skin(bench)
    assert not frequent_timers(bench)
    with bench.connect() as client:
        wait_for(lambda: frequent_timers(bench), "that a skin is looked for", DEADLINE_S)
        bench.contact = bench.skin.create_publisher(Contact, "contact", qos.STREAM)
        bench.until(lambda: "frame" in bench.headers, client, lambda: bench.press(1.0))
        wait_for(lambda: not frequent_timers(bench), "that no skin is looked for", DEADLINE_S)
    wait_for(lambda: contact_subscribers(bench) == 0)
    assert not frequent_timers(bench)


def test_a_page_that_goes_before_there_is_a_skin_leaves_no_search(bench: Bench) -> None:
    without_skin(bench)
    with bench.connect():
        wait_for(lambda: frequent_timers(bench), "that a skin is looked for", DEADLINE_S)
    wait_for(lambda: not frequent_timers(bench), "that no skin is looked for", DEADLINE_S)


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


def test_more_than_a_board_can_count_is_shown_as_the_most(bench: Bench) -> None:
    image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
    data = array("B", np.full(64, 4000, "<u2").tobytes())
    message = Image(height=8, width=8, encoding="mono16", step=16, data=data)

    with bench.connect() as client:
        bench.until(lambda: "image" in bench.arrays, client, lambda: image.publish(message))
    assert (bench.arrays["image"] == 1023).all()


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


def test_what_no_longer_comes_beside_new_images_is_not_shown_with_them(bench: Bench) -> None:
    image = bench.skin.create_publisher(Image, "view/image_raw", qos.VIEW)
    confidence = bench.skin.create_publisher(Image, "view/confidence", qos.VIEW)
    age = bench.skin.create_publisher(Image, "view/age", qos.VIEW)
    contacts = bench.skin.create_publisher(Contacts, "view/contacts", qos.VIEW)
    regions = bench.skin.create_publisher(RegionContacts, "regions", qos.STREAM)
    picture = Image(height=2, width=2, encoding="mono16", step=4, data=array("B", bytes(8)))
    sure = Image(height=2, width=2, encoding="mono8", step=2, data=array("B", bytes(4)))
    ages = Image(height=2, width=2, encoding="32FC1", step=8, data=array("B", bytes(16)))

    def play() -> None:
        image.publish(picture)
        confidence.publish(sure)
        age.publish(ages)
        contacts.publish(Contacts(contacts=[TrackedContact(number=7)]))
        palm = RegionContact("palm", "palm_lower", 3, 1.25)
        regions.publish(write_regions(RegionsFields(0, "hand", 1, [palm])))
        bench.press(1.0)

    def has(*names: str) -> bool:
        frame = bench.headers.get("frame", {"regions": []})
        shown = {"confidence", "age"} & set(bench.arrays)
        shown |= {"contacts"} if len(bench.arrays.get("contact_numbers", ())) else set()
        shown |= {"regions"} if frame["regions"] else set()
        return shown == set(names) and "image" in bench.arrays

    with bench.connect() as client:
        bench.until(lambda: has("confidence", "age", "contacts", "regions"), client, play)
        bench.destroy([confidence, age, contacts, regions])
        # As of one moment with the last image: without another one both of its arrays stay.
        bench.until(lambda: has("confidence", "age"), client, lambda: bench.press(1.0))
        bench.until(has, client, lambda: image.publish(picture))


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
        regions.publish(write_regions(RegionsFields(0, "hand", 1, patches)))
        status.publish(HandStatus(state=99, reason="r" * 10_000, active=["a"] * 1000))
        names = [f"made_up_{next(named)}" for _ in range(50)]
        diagnostics.publish(DiagnosticArray(status=[DiagnosticStatus(name=name, message="m" * 900) for name in names]))

    with bench.connect() as client:
        bench.until(
            lambda: (
                bool(bench.headers.get("frame", {}).get("regions") and bench.headers["frame"]["hand"])
                and len(bench.diagnostics) == 200
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
        assert max(len(one["message"]) for one in bench.diagnostics) == 500
        bench.until(lambda: bench.headers["frame"]["touch"] is not None, client, lambda: bench.press(2.0))
    assert [record.message for record in caplog.records if record.name == "asyncio"] == []


def test_of_long_diagnostics_only_what_can_be_shown_is_kept_and_that_not_for_ever(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    def report() -> None:
        for number in range(200):
            values = [KeyValue(key="k", value="v" * 1_000_000)]
            one = DiagnosticStatus(name=f"{number}/{'n' * 100_000}", message="m" * 100_000, values=values)
            bench.view._on_diagnostics(DiagnosticArray(status=[one]))

    tracemalloc.start()
    try:
        # Where messages are heard: elsewhere it could meet the look for what is to be forgotten.
        bench.spinning.do(report)
        assert tracemalloc.get_traced_memory()[0] < 5e6
    finally:
        tracemalloc.stop()
    assert len(bench.view._heard) == 200
    many = DiagnosticStatus(name="0/many", values=[KeyValue(key=f"{number}") for number in range(1000)])
    assert [key for key, _ in view_node._shown(many)["values"]] == [f"{number}" for number in range(100)]
    # Forgotten though no page is open.
    monkeypatch.setattr(view_node, "_FORGET_NODE_S", 0.1)
    wait_for(lambda: not any(name[0].isdigit() for name in bench.view._heard), "that they are forgotten", DEADLINE_S)


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


def test_recordings_may_be_meant_for_the_home_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert ViewSettings(record_dir="~/recordings").record_folder == tmp_path / "recordings"
    assert ViewSettings().record_folder == Path("recordings")
    with pytest.raises(SettingsError, match="~no_such_user/x: "):
        ViewSettings(record_dir="~no_such_user/x")


def without_skin(bench: Bench) -> None:
    bench.destroy([bench.contact])
    wait_for(lambda: bench.view.count_publishers("/hand/contact") == 0, "that the skin is gone", DEADLINE_S)


def frequent_timers(bench: Bench) -> list[Timer]:
    """Those that run more often than once a second."""
    return [timer for timer in bench.view.timers if not timer.is_canceled() and timer.timer_period_ns < 1_000_000_000]


def contact_subscribers(bench: Bench) -> int:
    return bench.contact.get_subscription_count()
