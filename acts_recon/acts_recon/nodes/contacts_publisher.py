# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics ``contacts``, ``view/contacts`` and ``contacts_view`` of the reconstruction node: the contacts one by one."""

from __future__ import annotations

import time

import numpy as np
from builtin_interfaces.msg import Duration
from rclpy.node import Node
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from acts_core.runtime import RateLimit
from acts_msgs.msg import Contacts
from acts_recon.contacts import BlobTracker, TrackedBlob
from acts_recon.methods import Recovery
from acts_recon.nodes.frame_publisher import FramePublisher, RecoveredFrame
from acts_recon.settings import ReconstructionConfig
from acts_ros import qos
from acts_ros.messages import ContactsFields, write_contacts
from acts_ros.publishers import published

# Within 4 ms a contact that slides at 1 m/s moves by a taxel.
_VIEWED_RATE_HZ = 250.0
_MARKER_LIFETIME_S = 0.2
_MARKER_HEIGHT_M = 0.004
_MAX_ID = 2**31


class ContactsPublisher(FramePublisher):
    """Finds and follows the contacts of every image, and publishes acts_msgs/Contacts.

    For viewers there are besides, when they are due, the same message on ``view/contacts``, and on ``contacts_view`` a
    visualization_msgs/MarkerArray: a disc as large as the contact and its number. For them alone contacts are followed
    at most 250 times a second.

    Parameters
    ----------
    node : Node
    settings : ReconstructionConfig
    recovery : Recovery
        Holds the image.
    """

    def __init__(self, node: Node, settings: ReconstructionConfig, recovery: Recovery) -> None:
        self._recovery = recovery
        self._tracker = BlobTracker(recovery.geometry, recovery.response, settings.blob_config(), recovery.borders)
        self._publisher = node.create_publisher(Contacts, "contacts", **published(qos.STREAM))
        self._view_publisher = node.create_publisher(Contacts, "view/contacts", **published(qos.VIEW))
        self._marker_publisher = node.create_publisher(MarkerArray, "contacts_view", **published(qos.VIEW))
        self._viewed_limit = RateLimit(_VIEWED_RATE_HZ)
        self._send = False

    def reset(self) -> None:
        """See `FramePublisher.reset`; numbers go on."""
        self._tracker.reset()

    def look_for_subscribers(self) -> None:
        """See `FramePublisher.look_for_subscribers`."""
        self._send = self._publisher.get_subscription_count() > 0
        for_viewers = {"view/contacts": self._view_publisher, "contacts_view": self._marker_publisher}
        self.viewed = [topic for topic, publisher in for_viewers.items() if publisher.get_subscription_count() > 0]
        self.is_wanted = self._send or bool(self.viewed)

    def publish(self, frame: RecoveredFrame) -> None:
        """See `FramePublisher.publish`."""
        header, recovery = frame.header, self._recovery
        to_view, to_mark = "view/contacts" in frame.due, "contacts_view" in frame.due
        if not (self._send or to_view or to_mark or self._viewed_limit.due(time.monotonic())):
            return
        found = self._tracker.step(recovery.image, frame.end_s, recovery.sigma)
        if self._send or to_view:
            dropped = self._tracker.dropped
            fields = ContactsFields(frame.stamp_ns, header.frame_id, frame.sequence, found, dropped)
            data = write_contacts(fields)
            if self._send:
                self._publisher.publish(data)
            if to_view:
                self._view_publisher.publish(data)
        if to_mark:
            markers = [marker for blob in found for marker in _markers(header, blob)]
            self._marker_publisher.publish(MarkerArray(markers=markers))


def _markers(header: Header, blob: TrackedBlob) -> list[Marker]:
    """A disc and a number; both vanish by themselves when they are not sent again."""
    markers = []
    diameter_m = 2.0 * float(np.sqrt(blob.area_m2 / np.pi))
    # Colours by number, far apart for numbers that follow one another.
    hue = 2 * np.pi * ((blob.number * 0.618) % 1.0)
    red, green, blue = (float(0.5 + 0.5 * np.cos(hue + shift)) for shift in (0.0, 2.1, 4.2))
    for namespace, kind in (("contacts", Marker.CYLINDER), ("numbers", Marker.TEXT_VIEW_FACING)):
        marker = Marker(header=header, ns=namespace, id=blob.number % _MAX_ID, type=kind, action=Marker.ADD)
        marker.lifetime = Duration(nanosec=round(1e9 * _MARKER_LIFETIME_S))
        marker.pose.position.x, marker.pose.position.y = blob.x_m, blob.y_m
        marker.pose.orientation.w = 1.0
        marker.color.r, marker.color.g, marker.color.b, marker.color.a = red, green, blue, 0.8
        if kind == Marker.CYLINDER:
            marker.scale.x = marker.scale.y = diameter_m
            marker.scale.z = _MARKER_HEIGHT_M
        else:
            marker.pose.position.z = 3 * _MARKER_HEIGHT_M
            marker.scale.z = 2.5 * _MARKER_HEIGHT_M
            marker.text = str(blob.number)
        markers.append(marker)
    return markers
