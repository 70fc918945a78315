# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics contacts, view/contacts and contacts_view over real DDS; ROS_DOMAIN_IDs 120 and 121."""

from array import array
from collections.abc import Callable, Sequence
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from rclpy.node import Node
from recon_bench import Listener, publisher_of
from recon_samples import bump
from visualization_msgs.msg import Marker, MarkerArray

from acts_core.array import ArrayGeometry
from acts_msgs.msg import Contacts, TactileSamples
from acts_recon.contacts import MAX_BLOBS, BlobTracker, Contact, TrackedBlob
from acts_recon.nodes import contacts_publisher
from acts_recon.nodes.contacts_publisher import ContactsPublisher
from acts_recon.nodes.frame_publisher import RecoveredFrame
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_recon.settings import ReconstructionSettings
from acts_ros import qos
from acts_ros.messages import frame_of, stamp_ns_of

GEOMETRY = ArrayGeometry()


def samples_of(image: NDArray, sequence: int) -> TactileSamples:
    """All taxels of an image, one frame a millisecond."""
    message = TactileSamples(sequence=sequence, rows=32, cols=32, scheme=TactileSamples.SCHEME_RASTER)
    message.header.frame_id = "plate"
    message.header.stamp.sec = 100
    message.header.stamp.nanosec = 1_000_000 * sequence
    message.indices = array("H", np.arange(1024, dtype=np.uint16).tobytes())
    message.counts = array("H", image.astype(np.uint16).tobytes())
    return message


def has_more(peers: Listener, count: int) -> bool:
    return len(peers.received["contacts"]) > count


def test_the_node_publishes_contacts_with_numbers_that_last(make_peers: Callable[..., Listener]) -> None:
    peers = make_peers(120)
    node = peers.add(ReconstructionNode(context=peers.context, namespace="/plate", cli_args=[]))
    assert node.get_parameter("contacts_bridge_s").value == pytest.approx(0.02)
    publisher = peers.peer.create_publisher(TactileSamples, "samples", qos.STREAM)
    peers.until(lambda: publisher.get_subscription_count() == 1)
    peers.listen(Contacts, "contacts", qos.STREAM)
    peers.until(lambda: publisher_of(node, ContactsPublisher)._send)

    images = [
        np.maximum(bump(GEOMETRY, 8, 6 + 0.4 * k), bump(GEOMETRY, 24, 26 - 0.4 * k, width=1.2)) for k in range(20)
    ]
    for sequence, image in enumerate(images):
        publisher.publish(samples_of(image, sequence))
        peers.until(partial(has_more, peers, sequence))
    publisher.publish(samples_of(np.zeros((32, 32)), 20))
    peers.until(lambda: len(peers.received["contacts"]) > 20)

    *pressed, untouched = peers.received["contacts"]
    assert [message.sequence for message in pressed] == list(range(20))
    assert all([contact.number for contact in message.contacts] == [1, 2] for message in pressed)
    assert (untouched.sequence, list(untouched.contacts), untouched.dropped) == (20, [], 0)
    last = pressed[-1]
    assert last.header.frame_id == "plate"
    assert (last.header.stamp.sec, last.header.stamp.nanosec) == (100, 19_000_000)
    upper, lower = last.contacts
    assert upper.position.x == pytest.approx(float(GEOMETRY.x_m(13.6)), abs=0.1 * GEOMETRY.pitch_m)
    assert upper.position.y == pytest.approx(float(GEOMETRY.y_m(8)), abs=0.1 * GEOMETRY.pitch_m)
    assert (upper.position.z, upper.velocity.z) == (0, 0)
    assert upper.velocity.x == pytest.approx(400 * GEOMETRY.pitch_m, rel=0.1)
    assert lower.velocity.x == pytest.approx(-400 * GEOMETRY.pitch_m, rel=0.1)
    assert upper.age == pytest.approx(0.019, abs=1e-5)
    assert upper.force > lower.force > 1
    assert upper.active_taxels > lower.active_taxels > 10
    assert upper.area == pytest.approx(upper.active_taxels * GEOMETRY.taxel_area_m2)


def test_contacts_on_a_board_that_begins_anew_have_new_numbers(make_peers: Callable[..., Listener]) -> None:
    peers = make_peers(120)
    node = peers.add(ReconstructionNode(context=peers.context, namespace="/plate", cli_args=[]))
    publisher = peers.peer.create_publisher(TactileSamples, "samples", qos.STREAM)
    peers.until(lambda: publisher.get_subscription_count() == 1)
    peers.listen(Contacts, "contacts", qos.STREAM)
    peers.until(lambda: publisher_of(node, ContactsPublisher)._send)

    pressed = bump(GEOMETRY, 8, 6)
    for count, sequence in enumerate((5, 6, 7, 0, 1), start=1):
        message = samples_of(pressed, sequence)
        message.header.stamp.nanosec = 1_000_000 * count
        publisher.publish(message)
        peers.until(partial(has_more, peers, count - 1))
        assert len(peers.received["contacts"]) == count
    assert [[contact.number for contact in message.contacts] for message in peers.received["contacts"]] == [
        [1],
        [1],
        [1],
        [2],
        [2],
    ]


VIEWED = ["view/contacts", "contacts_view"]


class Publishing:
    """A `ContactsPublisher` that is given images, and a peer that listens to all of its topics."""

    def __init__(self, make_peers: Callable[..., Listener]) -> None:
        self.peers = make_peers(121)
        node = self.peers.add(Node("maker", namespace="/plate", context=self.peers.context))
        settings = ReconstructionSettings()
        self.recovery = settings.recovery()
        self._contacts = ContactsPublisher(node, settings, self.recovery)
        self.peers.listen(Contacts, "contacts", qos.STREAM)
        self.peers.listen(Contacts, "view/contacts", qos.VIEW)
        self.peers.listen(MarkerArray, "contacts_view", qos.VIEW)
        self.peers.until(self._is_heard)

    def publish(self, sequence: int, image: NDArray, due: list[str]) -> None:
        self.recovery.image[:] = image
        samples = samples_of(image, sequence)
        frame = frame_of(samples)
        self._contacts.publish(RecoveredFrame(samples.header, stamp_ns_of(samples), frame, frame, Contact(), due))

    def _is_heard(self) -> bool:
        self._contacts.look_for_subscribers()
        return self._contacts._send and self._contacts.viewed == VIEWED


def test_standard_deviations_and_markers_are_those_of_the_contact(make_peers: Callable[..., Listener]) -> None:
    publishing = Publishing(make_peers)
    received = publishing.peers.received
    image = bump(GEOMETRY, 20.0, 12.0).astype(np.float32)
    sigma = np.full((32, 32), 5, dtype=np.float32)
    assert publishing.recovery.sigma is not None
    publishing.recovery.sigma[:] = sigma
    (expected,) = BlobTracker(GEOMETRY).step(image, 0.0, sigma)
    publishing.publish(1, image, VIEWED)
    publishing.peers.until(lambda: all(received.values()))
    ((contact,),) = (message.contacts for message in received["contacts"])
    assert contact.number == 1
    assert contact.position_sigma.x == expected.x_sd_m > 0
    assert contact.position_sigma.y == expected.y_sd_m > 0
    assert contact.velocity_sigma.x == expected.vx_sd_m_s > 0
    assert contact.force_sigma == pytest.approx(expected.force_sd_n)
    assert contact.area_sigma == pytest.approx(expected.area_sd_m2)
    assert contact.spread_sigma == pytest.approx(expected.spread_sd_m)
    assert expected.spread_sd_m > 0
    assert contact.spread == pytest.approx(expected.spread_m)
    assert contact.orientation == pytest.approx(expected.angle_rad)

    assert received["view/contacts"] == received["contacts"]
    (markers,) = received["contacts_view"]
    disc, text = markers.markers
    assert (disc.type, text.type, text.text) == (Marker.CYLINDER, Marker.TEXT_VIEW_FACING, "1")
    assert (disc.header.frame_id, disc.id, disc.action) == ("plate", 1, Marker.ADD)
    assert disc.pose.position.x == text.pose.position.x == contact.position.x
    assert np.pi * (disc.scale.x / 2) ** 2 == pytest.approx(contact.area)
    assert 0 < disc.lifetime.nanosec < 1e9


def test_of_more_contacts_than_fit_as_many_as_fit_are_sent_and_that_is_said(
    make_peers: Callable[..., Listener],
) -> None:
    publishing = Publishing(make_peers)
    received = publishing.peers.received
    many = np.zeros((32, 32), dtype=np.float32)
    many[::4, ::4] = 200
    publishing.recovery.sigma = None
    publishing.publish(1, many, [])
    publishing.peers.until(lambda: bool(received["contacts"]))
    (message,) = received["contacts"]
    assert len(message.contacts) == MAX_BLOBS
    assert message.dropped == 64 - MAX_BLOBS
    assert message.contacts[0].position_sigma.x == 0
    assert received["view/contacts"] == []


def test_a_contact_that_slides_between_two_messages_for_viewers_keeps_its_number(
    make_peers: Callable[..., Listener], monkeypatch: pytest.MonkeyPatch
) -> None:
    publishing = Publishing(make_peers)
    # Nobody but viewers listens.
    publishing._contacts._send = False
    now_s = 100.0
    monkeypatch.setattr(contacts_publisher, "time", SimpleNamespace(monotonic=lambda: now_s))
    for sequence in range(81):
        now_s += 0.001
        # A taxel in 4 ms.
        publishing.publish(sequence, bump(GEOMETRY, 16, 5 + 0.25 * sequence), VIEWED if sequence in (0, 80) else [])
    received = publishing.peers.received
    publishing.peers.until(lambda: received["view/contacts"] and received["view/contacts"][-1].sequence == 80)
    (contact,) = received["view/contacts"][-1].contacts
    assert contact.number == 1
    assert contact.position.x == pytest.approx(float(GEOMETRY.x_m(25)), abs=GEOMETRY.pitch_m)
    assert received["contacts"] == []


def test_for_viewers_alone_contacts_are_followed_at_most_250_times_a_second(
    make_peers: Callable[..., Listener], monkeypatch: pytest.MonkeyPatch
) -> None:
    publishing = Publishing(make_peers)
    step, steps = publishing._contacts._tracker.step, [0]

    def counted(*arguments: Any) -> Sequence[TrackedBlob]:
        steps[0] += 1
        return step(*arguments)

    monkeypatch.setattr(publishing._contacts._tracker, "step", counted)
    now_s = 100.0
    monkeypatch.setattr(contacts_publisher, "time", SimpleNamespace(monotonic=lambda: now_s))
    taken = {}
    for is_sent in (False, True):
        publishing._contacts._send = is_sent
        steps[0] = 0
        for sequence in range(200):
            now_s += 0.001
            publishing.publish(sequence, bump(GEOMETRY, 16, 5), [])
        taken[is_sent] = steps[0]
    assert taken == {False: pytest.approx(50, abs=2), True: 200}
