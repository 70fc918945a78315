# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the node publishes for those who watch, over real DDS; ROS_DOMAIN_ID 43."""

from collections.abc import Callable
from itertools import count
from types import SimpleNamespace

import numpy as np
import pytest
from geometry_msgs.msg import PointStamped
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from recon_bench import Bench, publisher_of
from sensor_msgs.msg import Image
from visualization_msgs.msg import MarkerArray

from acts_msgs.msg import Contacts, ContactSeries
from acts_recon.contacts import Contact as FoundContact
from acts_recon.nodes import series_publisher
from acts_recon.nodes.images_publisher import ImagesPublisher
from acts_recon.nodes.series_publisher import SeriesPublisher
from acts_ros import qos
from acts_ros.executor import destroy_subscription

pytestmark = pytest.mark.slow


def test_the_viewer_image_keeps_its_rate_and_costs_nothing_unheard(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(43, image_rate_hz=0.1)
    indices = np.arange(10)
    bench.send(0, indices, indices)
    bench.contact(0)
    assert not bench.node._is_more_wanted
    topics = ("image", "view/image_raw", "view/confidence", "view/age")
    for topic in topics:
        bench.listen(Image, topic, qos.VIEW)
    bench.until(lambda: set(topics) <= set(bench.node._viewed))
    for sequence in range(1, 20):
        bench.send(sequence, indices, indices)
    bench.contact(19)
    bench.until(lambda: all(bench.received[topic] for topic in topics))
    assert [len(bench.received[topic]) for topic in topics] == [1, 1, 1, 1]
    assert [bench.received[topic][0].encoding for topic in topics] == ["rgb8", "mono16", "mono8", "32FC1"]
    assert len({bench.received[topic][0].header.stamp.sec for topic in topics}) == 1
    age_s = np.frombuffer(bench.received["view/age"][0].data, np.float32)
    assert not age_s[indices].any()
    assert np.isinf(np.delete(age_s, indices)).all()


def test_each_topic_is_published_to_somebody_who_listens_to_no_other(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(43, image_rate_hz=1000.0)
    everything, pressed = np.arange(1024), np.full(1024, 500)
    numbers = count(1)
    topics: list[tuple[type, str, QoSProfile]] = [
        (PointStamped, "cop", qos.STREAM),
        (Image, "image_raw", qos.STREAM),
        (Image, "confidence", qos.STREAM),
        (Contacts, "contacts", qos.STREAM),
        (Contacts, "view/contacts", qos.VIEW),
        (MarkerArray, "contacts_view", qos.VIEW),
        (Image, "image", qos.VIEW),
        (Image, "view/image_raw", qos.VIEW),
        (Image, "view/confidence", qos.VIEW),
        (Image, "view/age", qos.VIEW),
        (ContactSeries, "view/contact_series", qos.VIEW),
    ]
    for kind, topic, profile in topics:
        bench.until(lambda: not bench.node._is_more_wanted, what=f"the end of what was before {topic}")
        messages: list[object] = []
        subscription = bench.peer.create_subscription(kind, topic, messages.append, profile)
        bench.until(
            lambda messages=messages: messages,  # type: ignore[misc]
            lambda: bench.send(next(numbers), everything, pressed),
            topic,
        )
        destroy_subscription(bench.peer, subscription)


def test_viewers_get_every_contact_in_a_few_messages(
    make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(43)
    # However long this machine takes for a contact.
    numbers = count(1)
    monkeypatch.setattr(bench.node._view_limit, "due", lambda _: next(numbers) % 10 == 0)
    images = publisher_of(bench.node, ImagesPublisher)
    bench.listen(ContactSeries, "view/contact_series", qos.VIEW)
    bench.until(lambda: images._series.is_wanted)
    series, pressed = bench.received["view/contact_series"], np.arange(320, 330)
    sequence = 0
    # 3 is missing.
    while sum(len(one.age) for one in series) < 30:
        sequence += 2 if sequence == 2 else 1
        bench.send(sequence, pressed, np.full(10, 500))
        bench.contact(sequence)
    contacts = bench.received["contact"]
    told = [force for one in series for force in one.force]
    assert len(series) < len(told) / 2
    assert told == [one.force for one in contacts[: len(told)]]
    assert [number for one in series for number in one.missing] == [0, 0, 1, *[0] * (len(told) - 3)]
    begin = 0
    for one in series:
        these = contacts[begin : begin + len(one.age)]
        assert one.newest == these[-1]
        # Numbers and stamps go together, a second for each.
        assert list(one.age) == [one.newest.sequence - contact.sequence for contact in these]
        assert len(one.delay) == len(these)
        begin += len(these)


def test_no_contact_is_lost_where_viewers_get_few_messages(make_bench: Callable[..., Bench]) -> None:
    """Of ten thousand contacts in ten seconds a message can hold a tenth: there are more messages then."""
    bench = make_bench(43, image_rate_hz=0.1)
    images = publisher_of(bench.node, ImagesPublisher)
    series = bench.listen(ContactSeries, "view/contact_series", qos.VIEW)
    bench.until(lambda: images._series.is_wanted)
    for sequence in range(1, 2500):
        bench.take(sequence, np.zeros((32, 32)))
    bench.until(lambda: sum(len(one.age) for one in series) >= 2048)
    assert sum(len(one.age) for one in series) + len(images._series) == 2499
    assert not any(any(one.missing) for one in series)


@pytest.mark.parametrize("step_s", [-3600, -0.05, 3600])
def test_a_series_ends_where_the_clock_was_set(make_bench: Callable[..., Bench], step_s: float) -> None:
    """Viewers take no contact that is newer than the newest, or older by more than a minute."""
    bench = make_bench(43, image_rate_hz=0.1)
    images = publisher_of(bench.node, ImagesPublisher)
    series = bench.listen(ContactSeries, "view/contact_series", qos.VIEW)
    bench.until(lambda: images._series.is_wanted)
    for sequence in range(1, 1600):
        bench.take(sequence, np.zeros((32, 32)), round(step_s * 1e9) if sequence > 1000 else 0)
    bench.until(lambda: sum(len(one.age) for one in series) + len(images._series) == 1599)
    assert all(0.0 <= age_s <= 60.0 for one in series for age_s in one.age)
    assert not any(any(one.missing) for one in series)


def test_contacts_that_are_dropped_because_nobody_publishes_them_are_missing(make_bench: Callable[..., Bench]) -> None:
    bench = make_bench(43)
    series = SeriesPublisher(bench.node)
    told: list[bytes] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(series._publisher, "publish", told.append)
        # Of every hundred one is lost before it comes here.
        for sequence in range(1, 3601):
            if sequence % 100:
                series.add(sequence, sequence, FoundContact())
            if sequence in (1500, 3600):
                series.publish("plate")
    first, second = (deserialize_message(data, ContactSeries).missing for data in told)
    assert len(first) + sum(first) == 1499
    assert len(second) + sum(second) == 2100


def test_more_missing_contacts_than_a_message_can_tell_do_not_end_the_node(make_bench: Callable[..., Bench]) -> None:
    """With numbers of nanoseconds a million are missing before each contact, and these were added up."""
    bench = make_bench(43)
    series = SeriesPublisher(bench.node)
    told: list[bytes] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(series._publisher, "publish", told.append)
        for number in range(10_000):
            series.add(1_000_000 * number, 1_000_000 * number % 2**32, FoundContact())
        series.publish("plate")
    missing = deserialize_message(told[0], ContactSeries).missing
    assert (missing[0], missing[1]) == (2**32 - 1, 999_999)


def test_a_series_tells_delays_and_misses_nothing_of_the_time_in_which_nobody_listened(
    make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(43)
    series = SeriesPublisher(bench.node)
    told: list[bytes] = []
    now_ns, listeners = 0, 1
    monkeypatch.setattr(series._publisher, "publish", told.append)
    monkeypatch.setattr(series._publisher, "get_subscription_count", lambda: listeners)
    monkeypatch.setattr(series_publisher, "time", SimpleNamespace(time_ns=lambda: now_ns))

    def add(sequence: int, delay_ns: int) -> None:
        nonlocal now_ns
        now_ns = 1_000_000 * sequence + delay_ns
        series.add(1_000_000 * sequence, sequence, FoundContact(force_n=float(sequence)))

    series.look_for_subscribers()
    # There may be nothing to tell yet.
    series.publish("plate")
    assert told == []
    add(10, 500_000)
    add(13, 250_000)
    series.publish("plate")
    add(14, 0)
    listeners = 0
    series.look_for_subscribers()
    assert not series.is_wanted
    listeners = 1
    series.look_for_subscribers()
    assert series.is_wanted
    add(100, 0)
    add(102, 0)
    series.publish("plate")
    first, second = (deserialize_message(data, ContactSeries) for data in told)
    assert list(first.missing) == [0, 2]
    assert list(first.delay) == pytest.approx([0.0005, 0.00025])
    assert list(first.force) == [10.0, 13.0]
    assert list(first.age) == pytest.approx([0.003, 0.0])
    # Nor is what was kept then.
    assert list(second.missing) == [0, 1]
    assert list(second.force) == [100.0, 102.0]


def test_what_was_kept_for_a_viewer_that_left_is_not_told_to_the_next_one_a_minute_later(
    make_bench: Callable[..., Bench], monkeypatch: pytest.MonkeyPatch
) -> None:
    bench = make_bench(43, image_rate_hz=0.1)
    images = publisher_of(bench.node, ImagesPublisher)
    told: list[bytes] = []
    listeners = 1
    monkeypatch.setattr(images._series._publisher, "publish", told.append)
    monkeypatch.setattr(images._series._publisher, "get_subscription_count", lambda: listeners)
    bench.until(lambda: images._series.is_wanted)
    for sequence in range(1, 20):
        bench.take(sequence, np.zeros((32, 32)))
    listeners = 0
    bench.until(lambda: not images._series.is_wanted)
    listeners = 1
    bench.until(lambda: images._series.is_wanted)
    told.clear()
    an_hour_ns = 3600 * 10**9
    bench.take(20, np.zeros((32, 32)), an_hour_ns)
    # A clock that is set back has the new one published.
    bench.take(21, np.zeros((32, 32)))
    (series,) = (deserialize_message(data, ContactSeries) for data in told)
    assert series.newest.sequence == 20
