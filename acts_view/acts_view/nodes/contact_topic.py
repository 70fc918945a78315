# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The contact of one skin, polled: all of the 1 kHz stream, and where the newest touch is."""

from __future__ import annotations

import math
from typing import Any

from acts_core.errors import PacketError
from acts_core.runtime import SequenceNumbers
from acts_msgs.msg import Contact, ContactSeries
from acts_ros import qos
from acts_ros.log import STEADY
from acts_ros.messages import ContactFields, SeriesFields, read_contact, read_series
from acts_ros.polled import PolledSubscription, PollingNode
from acts_view.skin.snapshot import Sample

# A stamp further from the clock than this is by another clock, as in a bag that is played.
_SAME_CLOCK_S = 10.0
# Of a series.
_LONGEST = 4096
_OLDEST_S = 60.0

Taken = tuple[list[Sample], tuple[float, ...] | None, float | None]
"""The contacts since the last call; x, y [m], force [N], peak [counts] and area [m^2] of the newest, None where it is
no touch; its stamp [s], None where nothing came."""


class ContactTopic:
    """Subscribes to ``view/contact_series`` or, where only that is published, as in a bag, to ``contact``.

    One call at a time, from the executor's thread, `take` from any.

    Parameters
    ----------
    node : PollingNode
    namespace : str
        Of the skin, with a slash before.
    """

    def __init__(self, node: PollingNode, namespace: str) -> None:
        self._node = node
        self._namespace = namespace
        self._series: PolledSubscription[bytes] | None = None
        self._contact: PolledSubscription[Any] | None = None
        self._numbers = SequenceNumbers()
        self.look()

    def look(self) -> None:
        """Choose anew, now and then, between the two."""
        is_series = self._is_published("view/contact_series") or not self._is_published("contact")
        if (self._series if is_series else self._contact) is not None:
            return
        self.close()
        if is_series:
            topic = f"{self._namespace}/view/contact_series"
            self._series = self._node.create_raw_polled_subscription(ContactSeries, topic, qos.VIEW)
        else:
            topic = f"{self._namespace}/contact"
            self._contact = self._node.create_raw_polled_subscription(Contact, topic, qos.STREAM)
            self._numbers = SequenceNumbers()

    def take(self) -> Taken:
        """All that has come since the last call."""
        return self._take_series() if self._series is not None else self._take_contacts()

    def close(self) -> None:
        """Subscribe no longer."""
        for subscription in (self._series, self._contact):
            if subscription is not None:
                self._node.destroy_polled_subscription(subscription)
        self._series = self._contact = None

    def _is_published(self, topic: str) -> bool:
        return self._node.count_publishers(f"{self._namespace}/{topic}") > 0

    def _take_series(self) -> Taken:
        samples: list[Sample] = []
        newest: ContactFields | None = None
        for data, _ in self._series.take_all() if self._series is not None else []:
            try:
                series = read_series(data)
                samples += _samples(series)
            except PacketError as error:
                self._node.get_logger().warning(
                    f"{self._namespace}/view/contact_series: {error}",
                    throttle_duration_sec=5.0,
                    throttle_time_source_type=STEADY,
                )
                continue
            newest = series.newest
        return _taken(samples, newest)

    def _take_contacts(self) -> Taken:
        samples = []
        newest: ContactFields | None = None
        for data, received_ns in self._contact.take_all() if self._contact is not None else []:
            try:
                newest = read_contact(data)
            except PacketError as error:
                self._node.get_logger().warning(
                    f"{self._namespace}: {error}", throttle_duration_sec=5.0, throttle_time_source_type=STEADY
                )
                continue
            latency_ms = _latency_ms((received_ns - newest.stamp_ns) * 1e-9)
            samples.append(
                Sample(newest.stamp_ns * 1e-9, newest.force_n, latency_ms, self._numbers.step(newest.sequence))
            )
        return _taken(samples, newest)


def _taken(samples: list[Sample], newest: ContactFields | None) -> Taken:
    if newest is None:
        return samples, None, None
    touch = (newest.x_m, newest.y_m, newest.force_n, newest.peak_counts, newest.area_m2)
    return samples, _finite(touch) if newest.in_contact else None, newest.stamp_ns * 1e-9


def _samples(series: SeriesFields) -> list[Sample]:
    """Its contacts, or `PacketError` where the columns do not belong together: anybody in the domain can send any."""
    newest, *columns = series
    count = len(series.age_s)
    if count > _LONGEST or any(len(column) != count for column in columns):
        raise PacketError("no series of contacts")
    ages_s, forces_n, delays_s, missing = (column.tolist() for column in columns)
    # Of so few numbers Python itself takes less time than numpy.
    if not all(0 <= age_s <= _OLDEST_S for age_s in ages_s):
        raise PacketError("no series of contacts")
    last_s = newest.stamp_ns * 1e-9
    stamps_s = [last_s - age_s for age_s in ages_s]
    return list(map(Sample, stamps_s, forces_n, map(_latency_ms, delays_s), missing))


def _latency_ms(delay_s: float) -> float:
    return 1e3 * delay_s if abs(delay_s) < _SAME_CLOCK_S else math.nan


def _finite(touch: tuple[float, ...]) -> tuple[float, ...] | None:
    return touch if all(map(math.isfinite, touch)) else None
