# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics ``contacts``, ``view/contacts`` and ``contacts_view`` of the reconstruction node: the contacts one by one."""

from __future__ import annotations

import time
from collections.abc import Collection

import numpy as np
from builtin_interfaces.msg import Duration
from numpy.typing import NDArray
from rclpy.node import Node
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from acts_core.array import ArrayGeometry
from acts_core.runtime import RateLimit
from acts_core.skin import ForceResponse, MeasuredForceResponse
from acts_msgs.msg import Contacts
from acts_recon.contacts import BlobConfig, BlobTracker, TrackedBlob
from acts_recon.images import Borders
from acts_ros import qos
from acts_ros.messages import ContactsFields, ns_of, seconds_of, write_contacts

# Within 4 ms a contact that slides at 1 m/s moves by a taxel.
_VIEWED_RATE_HZ = 250.0
_MARKER_LIFETIME_S = 0.2
_MARKER_HEIGHT_M = 0.004
_MAX_ID = 2**31


class ContactsPublisher:
    """Finds and follows the contacts of every image, and publishes acts_msgs/Contacts, while somebody listens.

    For viewers there are besides, when they are due, the same message on ``view/contacts``, and on ``contacts_view`` a
    visualization_msgs/MarkerArray: a disc as large as the contact and its number. For them alone contacts are followed
    at most 250 times a second.

    Parameters
    ----------
    node : Node
    geometry : ArrayGeometry
        Of the images.
    response : ForceResponse or MeasuredForceResponse
    config : BlobConfig
    borders : Borders, optional
        Of the images.
    """

    def __init__(
        self,
        node: Node,
        geometry: ArrayGeometry,
        response: ForceResponse | MeasuredForceResponse,
        config: BlobConfig,
        borders: Borders | None = None,
    ) -> None:
        self._tracker = BlobTracker(geometry, response, config, borders)
        self._publisher = node.create_publisher(Contacts, "contacts", **qos.overridable(qos.STREAM))
        self._view_publisher = node.create_publisher(Contacts, "view/contacts", **qos.overridable(qos.VIEW))
        self._marker_publisher = node.create_publisher(MarkerArray, "contacts_view", **qos.overridable(qos.VIEW))
        self._viewed_limit = RateLimit(_VIEWED_RATE_HZ)
        self._send = False
        self.viewed: list[str] = []
        """Topics for viewers that somebody listens to."""
        self.is_wanted = False

    def reset(self) -> None:
        """Forget all contacts: the next image is of another board; numbers go on."""
        self._tracker.reset()

    def look_for_subscribers(self) -> None:
        """To be called now and then: whether somebody listens."""
        self._send = self._publisher.get_subscription_count() > 0
        for_viewers = {"view/contacts": self._view_publisher, "contacts_view": self._marker_publisher}
        self.viewed = [topic for topic, publisher in for_viewers.items() if publisher.get_subscription_count() > 0]
        self.is_wanted = self._send or bool(self.viewed)

    def publish(
        self,
        header: Header,
        sequence: int,
        image: NDArray[np.float32],
        sigma: NDArray[np.float32] | None = None,
        due: Collection[str] = (),
    ) -> None:
        """Find the contacts in the image of a frame, and publish them.

        Parameters
        ----------
        header : Header
            Of the frame.
        sequence : int
            The frame's number.
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts.
        sigma : np.ndarray [shape=(rows, cols), dtype=float32], optional
            Standard deviation of every taxel [counts], where it is known.
        due : collection of str
            The topics for viewers to publish now.
        """
        if not self.is_wanted:
            return
        to_view, to_mark = "view/contacts" in due, "contacts_view" in due
        if not (self._send or to_view or to_mark or self._viewed_limit.due(time.monotonic())):
            return
        found = self._tracker.step(image, seconds_of(header.stamp), sigma)
        if self._send or to_view:
            stamp_ns = ns_of(header.stamp)
            data = write_contacts(ContactsFields(stamp_ns, header.frame_id, sequence, found, self._tracker.dropped))
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
