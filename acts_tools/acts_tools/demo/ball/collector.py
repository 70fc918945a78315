# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node that observes a ball-balancing run and fills a `Recording`."""

from __future__ import annotations

import numpy as np
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from numpy.typing import NDArray
from sensor_msgs.msg import Image
from std_srvs.srv import Trigger

from acts_msgs.msg import BalanceStatus, BallReference, StreamStatistics
from acts_ros import qos
from acts_ros.messages import seconds_of
from acts_ros.middleware import NotAskedError, ask
from acts_ros.polled import PollingNode
from acts_tools.demo.ball.recording import Recording
from acts_tools.driver.status import driver_values, node_values

# Twice the number of messages per second of the most frequent topic.
_DEPTH = 256


class Collector(PollingNode):
    """Subscribes to the topics that the demo scores and shows, and polls them ten times a second.

    Parameters
    ----------
    namespace : str
        The skin's namespace.
    recording : Recording
        Filled while the control loop is closed.
    """

    def __init__(self, namespace: str, recording: Recording) -> None:
        super().__init__("demo", namespace=namespace)
        self.recording = recording
        self.state = BalanceStatus.STATE_CONNECTING
        self.reason = "starting"
        self.segment = ""
        self.ball_m: tuple[float, float] | None = None
        self.rate_hz = 0.0
        self.latency_s: NDArray[np.float32] = np.empty(0, dtype=np.float32)
        self._balancing = False
        self._first: StreamStatistics | None = None
        self._frames_lost_before: int | None = None
        self._crc_errors_before = 0
        self._start = self.create_client(Trigger, "ball_control/start")
        self._inputs = [
            (self.create_polled_subscription(kind, topic, profile, depth=_DEPTH), handle)
            for kind, topic, profile, handle in (
                (BalanceStatus, "ball/status", qos.STATE, self._on_status),
                (BallReference, "ball/reference", qos.STATE, self._on_reference),
                (PointStamped, "ball/truth", qos.STATE, self._on_truth),
                (StreamStatistics, "contact_statistics", qos.STATE, self._on_statistics),
                (DiagnosticArray, "/diagnostics", qos.STATE, self._on_diagnostics),
                (Image, "image_raw", qos.STREAM, self._on_image),
            )
        ]

    def ask_to_start(self) -> bool:
        """Ask a controller that has stopped to begin anew; whether it was asked. Its state tells whether it does."""
        if not self._start.service_is_ready():
            return False
        try:
            ask(self._start, Trigger.Request())
        except NotAskedError:
            return False
        return True

    def take_in(self) -> None:
        """Process the messages since the last call, which must be at most a second ago."""
        for subscription, handle in self._inputs:
            for message, _ in subscription.take_all():
                handle(message)

    def _on_status(self, message: BalanceStatus) -> None:
        self.state, self.reason = message.state, message.reason
        if message.state == BalanceStatus.STATE_BALANCING:
            self._balancing = True
            recording = self.recording
            recording.tilt_time_s.append(seconds_of(message.header.stamp))
            recording.touch_age_s.append(message.touch_age)
            recording.tilt_commanded_rad.append((message.tilt_commanded.x, message.tilt_commanded.y))
            recording.tilt_measured_rad.append((message.tilt_measured.x, message.tilt_measured.y))
        elif message.state == BalanceStatus.STATE_STOPPED and self._balancing:
            self.recording.stop_reason = message.reason

    def _on_reference(self, message: BallReference) -> None:
        if not self._balancing or self.recording.finished:
            return
        self.segment = message.segment
        track = self.recording.reference
        before = len(track.time_s)
        track.add(seconds_of(message.header.stamp), message.position.x, message.position.y)
        self.recording.segments.extend([message.segment] * (len(track.time_s) - before))
        self.recording.finished = message.finished

    def _on_truth(self, message: PointStamped) -> None:
        self.ball_m = (message.point.x, message.point.y)
        self.recording.truth.add(seconds_of(message.header.stamp), message.point.x, message.point.y)

    def _on_statistics(self, message: StreamStatistics) -> None:
        latencies = np.asarray(message.latencies, dtype=np.float32)
        self.latency_s = latencies
        self.rate_hz = latencies.size / message.interval if message.interval > 0 else 0.0
        if not self._balancing:
            return
        if self._first is None:
            # Counts begin here, because those before the loop was closed are of the start-up.
            self._first = message
            return
        recording = self.recording
        recording.latencies_s.append(latencies)
        recording.contacts_received = message.received - self._first.received
        recording.contacts_lost = message.lost - self._first.lost
        elapsed_s = seconds_of(message.header.stamp) - seconds_of(self._first.header.stamp)
        recording.contact_rate_hz = recording.contacts_received / elapsed_s if elapsed_s > 0 else 0.0

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        namespace = self.get_namespace()
        if self._balancing and int(node_values(message, namespace, "ball_world").get("falls", 0)):
            self.recording.has_fallen = True
        values = driver_values(message, namespace)
        if values is None:
            return
        lost, crc_errors = int(values["lost"]), int(values["crc_errors"])
        if self._frames_lost_before is None or not self._balancing:
            self._frames_lost_before, self._crc_errors_before = lost, crc_errors
        self.recording.frames_lost = lost - self._frames_lost_before
        self.recording.crc_errors = crc_errors - self._crc_errors_before

    def _on_image(self, message: Image) -> None:
        if not self._balancing or self.recording.finished:
            return
        image = np.frombuffer(message.data, dtype=np.uint16).reshape(message.height, message.width)
        total = self.recording.segment_pressure.setdefault(self.segment, np.zeros(image.shape))
        total += image
