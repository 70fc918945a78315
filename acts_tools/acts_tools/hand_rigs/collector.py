# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node that observes a simulated hand and fills a `HandRecording`."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from rclpy.task import Future
from std_srvs.srv import Trigger

from acts_core.errors import ActsError, PacketError
from acts_core.skin import layout
from acts_msgs.msg import HandStatus, HandTiming, RegionContacts
from acts_ros import qos
from acts_ros.log import STEADY
from acts_ros.messages import read_regions, seconds_of
from acts_ros.middleware import ask
from acts_ros.polled import PollingNode
from acts_sim.hand import TruthFollower
from acts_sim.shared import TimedRingReader
from acts_tools.hand_rigs.recording import HandRecording, StatusSample

# Twice the number of messages per second of the most frequent topic.
_DEPTH = 2048
_LAYOUT = "leap_right"
# One in this many messages of regions is decoded: at 1 kHz a hundred a second.
_EVERY = 10
_FRESH_S = 0.1


class HandCollector(PollingNode):
    """Subscribes to the topics that are scored and shown, and polls them ten times a second.

    Parameters
    ----------
    namespace : str
        Namespace of the hand.
    run_dir : Path
        Folder of the rings of `hand_world`.
    recording : HandRecording
        Recording to fill.

    Attributes
    ----------
    status : StatusSample or None
        The newest status.
    touch_age_s : float
        Age of touch in the newest status [s].
    fresh_s : float
        Time for which the hand has reported fresh touch [s].
    has_torque : bool
        Whether the hand moved its goals before the newest status: it does nothing while its motors have no torque.
    """

    def __init__(self, namespace: str, run_dir: Path, recording: HandRecording) -> None:
        super().__init__("live_hand", namespace=namespace)
        self.recording = recording
        self.status: StatusSample | None = None
        self.touch_age_s = float("inf")
        self.fresh_s = 0.0
        self.has_torque = False
        self._steps = 0
        self._stale_s = 0.0
        skin = layout(_LAYOUT, 32, 32)
        recording.patches = tuple(patch.name for patch in skin.patches)
        self._taxels = int(skin.taxels.size)
        # Stamps are of the system's clock, the world's times of CLOCK_MONOTONIC.
        self._clock_offset_s = (time.time_ns() - time.monotonic_ns()) * 1e-9
        self._run_dir = run_dir
        self._truth: TruthFollower | None = None
        self._field: TimedRingReader | None = None
        self._statuses = self.create_polled_subscription(HandStatus, "hand/status", qos.STATE, depth=_DEPTH)
        self._timings = self.create_polled_subscription(HandTiming, "hand/timing", qos.STATE)
        self._touches = self.create_raw_polled_subscription(RegionContacts, "regions", qos.STREAM, depth=_DEPTH)
        self._triggers = {
            name: self.create_client(Trigger, f"hand_reflexes/{name}") for name in ("grasp", "release", "stop")
        }

    def take_in(self) -> None:
        """Process the messages since the last call, which must be at most a second ago."""
        recording = self.recording
        self._take_truth()
        for message, _ in self._statuses.take_all():
            self.touch_age_s = message.touch_age
            self.has_torque = message.steps > self._steps
            self._steps = message.steps
            self.status = StatusSample(
                seconds_of(message.header.stamp) - self._clock_offset_s,
                message.state,
                message.reason,
                tuple(message.active),
                dict(zip(message.reflexes, map(int, message.events), strict=True)),
            )
            recording.statuses.append(self.status)
            if self.touch_age_s > _FRESH_S:
                self._stale_s = self.status.time_s
            self.fresh_s = self.status.time_s - self._stale_s
        for message, _ in self._timings.take_all():
            recording.durations_s.append(np.asarray(message.durations, dtype=np.float32))
            recording.latencies_s.append(np.asarray(message.latencies, dtype=np.float32))
        for data, _ in self._touches.take_all():
            recording.regions_received += 1
            if recording.regions_received % _EVERY == 0:
                self._take_regions(data)

    def ask(self, name: str) -> Future:
        """Call a service of the hand; the future is done when it has replied.

        Raises
        ------
        NotAskedError
            As of `acts_ros.middleware.ask`.
        """
        return ask(self._triggers[name], Trigger.Request())

    @property
    def is_served(self) -> bool:
        """Whether the hand's services are available."""
        return all(service.service_is_ready() for service in self._triggers.values())

    def _take_truth(self) -> None:
        if self._truth is None or self._field is None:
            try:
                self._field = TimedRingReader(self._run_dir / "field.ring", self._taxels)
                self._truth = TruthFollower(self._run_dir / "truth.ring", len(self.recording.patches))
            except ActsError:
                return  # the ring does not exist yet
        times_ns, rows = self._truth.new()
        if len(times_ns):
            self.recording.truth_times.append(np.asarray(times_ns * 1e-9, dtype=np.float64))
            self.recording.truth_rows.append(rows)
        newest = self._field.newest()
        if newest is not None:
            self.recording.fields.append((newest[0] * 1e-9, newest[1]))

    def _take_regions(self, data: bytes) -> None:
        try:
            message = read_regions(data)
        except PacketError as error:
            self.get_logger().warning(
                f"message ignored: {error}", throttle_duration_sec=1.0, throttle_time_source_type=STEADY
            )
            return
        self.recording.regions.append((message.stamp_ns * 1e-9 - self._clock_offset_s, message.regions))
