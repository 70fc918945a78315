# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `ball_state`: 1 kHz contacts in, the ball's position and velocity out.

Topics: contact and ball/tilt in; ball/state and contact_statistics out.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Vector3Stamped

from acts_control.ball import Ball, BallEstimator, BallReport, ContactMeasurement, EstimatorConfig
from acts_control.ball.nodes.names import CLOCK_REASON, CONTACT_TOPIC, STATE_TOPIC, STATISTICS_TOPIC, TILT_TOPIC
from acts_control.ball.nodes.other_frames import OtherFrames
from acts_core.errors import PacketError
from acts_core.runtime import StreamCounter
from acts_core.settings import Changeable, setting
from acts_core.stop_signals import StopSignals
from acts_core.words import counted
from acts_msgs.msg import BallState, Contact, StreamStatistics
from acts_ros.clocks import keep_system_clock, steady_timer
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import OK, WARN, DiagnosticsReporter, Report
from acts_ros.log import STEADY
from acts_ros.messages import ns_of, read_contact, set_stamp, skin_frame
from acts_ros.parameters import declare, node_options, set_rate
from acts_ros.polled import PollingNode
from acts_ros.publishers import TolerantPublisher
from acts_ros.qos import STATE, STREAM

_STATISTICS_PERIOD_S = 1.0

# At 1 kHz: how long a reader may be held up before contacts are lost [ms].
_CONTACTS = 128
# While the control loop does not ask, since it is connecting or stopped, the node itself takes contacts so often [s].
_UNDRIVEN_S = 0.1


@dataclass(frozen=True)
class BallStateSettings(EstimatorConfig):
    """Parameters of the node."""

    publish_rate_hz: float = setting(
        250.0,
        "how often the state is published, at most as often as contacts arrive [Hz]",
        minimum=1.0,
        maximum=2000.0,
        changeable=Changeable.RUNNING,
    )
    frame_id: str = setting(
        "",
        "frame of the skin; empty or none: the name of the namespace, with _ for /; contacts in another are left out",
    )


class BallStateNode(PollingNode):
    """Runs the estimator on every contact and publishes every n-th state, as the paper's "system state node".

    Contacts wake nobody: all that have arrived are worked on when `update` is due.

    Parameters
    ----------
    is_driven : bool
        Whether a controller of the same process calls `update` and `set_tilt`. The node does so itself while nobody
        does; without a controller it does so at the rate it publishes with, and subscribes the tilt.

    Attributes
    ----------
    lever_arm_m : float
        As its parameter; a controller has to have the same [m].
    """

    def __init__(self, *, is_driven: bool = False, **node_arguments: Any) -> None:
        super().__init__("ball_state", **node_options(), **node_arguments)
        settings = declare(self, BallStateSettings, self._change)
        keep_system_clock(self, CLOCK_REASON)
        self.lever_arm_m = settings.lever_arm_m
        self._is_driven = is_driven
        self._lock = threading.Lock()
        self._updated_s = 0.0
        self._estimator = BallEstimator(settings)
        self._counter = StreamCounter()
        self._period_ns = round(1e9 / settings.publish_rate_hz)
        self._due_ns = 0
        self._frame_id = skin_frame(self, settings.frame_id)
        self._other_contacts = OtherFrames("contact", "contacts", self._frame_id)
        self._other_tilts = OtherFrames("tilt", "tilts", self._frame_id)
        self._left_out: tuple[int, ...] = (0, 0)  # of each kind, as told last
        self._message = BallState()
        self._message.header.frame_id = self._frame_id
        self._clock = self.get_clock()
        self._interval_start_s = time.monotonic()
        self._reported = 0
        self._state_publisher = self.create_publisher(BallState, STATE_TOPIC, STATE, publisher_class=TolerantPublisher)
        self._statistics_publisher = self.create_publisher(
            StreamStatistics, STATISTICS_TOPIC, STATE, publisher_class=TolerantPublisher
        )
        self._contacts = self.create_raw_polled_subscription(Contact, CONTACT_TOPIC, STREAM, depth=_CONTACTS)
        if is_driven:
            self._timer = steady_timer(self, _UNDRIVEN_S, self._update_undriven)
        else:
            self.create_subscription(Vector3Stamped, TILT_TOPIC, self._on_tilt, STREAM)
            self._timer = steady_timer(self, 1.0 / settings.publish_rate_hz, self.update)
        steady_timer(self, _STATISTICS_PERIOD_S, self._publish_statistics)
        self._diagnostics = DiagnosticsReporter(
            self, "ball", self._report, only_publishers=[CONTACT_TOPIC, *([] if is_driven else [TILT_TOPIC])]
        )

    def update(self) -> BallReport | None:
        """Take in the contacts that have arrived; the newest estimate, None before the first contact. From any thread.

        Of a queue that ran over, the newest are there: too slow a reader loses contacts, but touch does not grow old.
        """
        with self._lock:
            self._updated_s = time.monotonic()
            is_heard = self._state_publisher.get_subscription_count() > 0
            for data, received_ns in self._contacts.take_all():
                self._take(data, received_ns, is_heard)
            state = self._estimator.state
            if not state.received:
                return None
            return BallReport(state.stamp_ns, state.valid, Ball(state.x_m, state.y_m, state.vx_m_s, state.vy_m_s))

    def set_tilt(self, stamp_ns: int, tilt_rad: tuple[float, float]) -> None:
        """Tell the measured tilt of the plate, about x and y. From any thread."""
        with self._lock:
            self._estimator.set_tilt(stamp_ns, *tilt_rad)

    def _change(self, settings: BallStateSettings) -> str:
        """Put changed parameters in force."""
        with self._lock:
            self._estimator.config = settings
            self._period_ns = round(1e9 / settings.publish_rate_hz)
        if not self._is_driven:
            set_rate(self._timer, settings.publish_rate_hz)
        return ""

    def _update_undriven(self) -> None:
        if time.monotonic() - self._updated_s > _UNDRIVEN_S:
            self.update()

    def _on_tilt(self, message: Vector3Stamped) -> None:
        if not self._other_tilts.has(message.header.frame_id):
            self.set_tilt(ns_of(message.header.stamp), (message.vector.x, message.vector.y))

    def _take(self, data: bytes, received_ns: int, is_heard: bool) -> None:
        # A thousand times a second: nothing here that is not needed.
        try:
            contact = read_contact(data)
        except PacketError as error:
            self.get_logger().warning(
                f"contact dropped: {error}", throttle_duration_sec=5.0, throttle_time_source_type=STEADY
            )
            return
        if contact.frame_id != self._frame_id:
            self._other_contacts.note(contact.frame_id)
            return
        self._counter.step(contact.sequence, (received_ns - contact.stamp_ns) * 1e-9)
        self._estimator.step(
            ContactMeasurement(contact.stamp_ns, contact.in_contact, contact.x_m, contact.y_m, contact.force_n)
        )
        state_ns = self._estimator.state.stamp_ns
        if state_ns >= self._due_ns or state_ns < self._due_ns - 2 * self._period_ns:
            # Kept on a grid, so that the rate is right on average whatever the contacts' own rate.
            late = state_ns - self._due_ns
            self._due_ns += self._period_ns if 0 <= late < self._period_ns else late + self._period_ns
            if is_heard:
                self._publish_state()

    def _publish_state(self) -> None:
        state, message = self._estimator.state, self._message
        set_stamp(message.header.stamp, state.stamp_ns)
        message.valid = state.valid
        message.position.x, message.position.y = state.x_m, state.y_m
        message.velocity.x, message.velocity.y = state.vx_m_s, state.vy_m_s
        message.position_sigma = state.sigma_m
        message.contacts_received = state.received
        self._state_publisher.publish(message)

    def _publish_statistics(self) -> None:
        now_s = time.monotonic()
        with self._lock:
            message = StreamStatistics(
                topic=self._contacts.topic_name,
                receiver=self.get_fully_qualified_name(),
                interval=now_s - self._interval_start_s,
                received=self._counter.received,
                lost=self._counter.lost,
                latencies=self._counter.take_latencies(),
            )
        set_stamp(message.header.stamp, self._clock.now().nanoseconds)
        self._interval_start_s = now_s
        self._statistics_publisher.publish(message)

    def _report(self) -> Report:
        state, counter = self._estimator.state, self._counter
        arrived = counter.received - self._reported
        self._reported = counter.received
        values = {
            "received": counter.received,
            "lost": counter.lost,
            "since_last_report": arrived,
            "without_contact": state.without_contact,
            "outliers": state.outliers,
            "not_finite": state.not_finite,
            "implausible": state.implausible,
            "in_another_frame": self._other_contacts.count + self._other_tilts.count,
            "out_of_order": state.out_of_order,
            "restarts": state.restarts,
            "valid": state.valid,
        }
        complaints = [] if arrived else [f"no contact messages on {self._contacts.topic_name}"]
        complaints += self._newly_left_out()
        if complaints:
            return WARN, "; ".join(complaints), values
        return OK, "ball" if state.valid else "no ball", values

    def _newly_left_out(self) -> list[str]:
        """Of what kind messages were left out since the last report, in words, and how many so far."""
        state = self._estimator.state
        beyond = "at places or of forces beyond reason and"
        kinds = (
            (state.not_finite, "contact was not finite and was left out", "contacts were not finite and were left out"),
            (state.implausible, f"contact was {beyond} was left out", f"contacts were {beyond} were left out"),
        )
        before, self._left_out = self._left_out, tuple(count for count, _, _ in kinds)
        told = [counted(*kind) for kind, told in zip(kinds, before, strict=True) if kind[0] > told]
        return [*filter(None, (self._other_contacts.newly(), self._other_tilts.newly())), *told]


SETTINGS: dict[str, type] = {"ball_state": BallStateSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    return run_nodes({"ball_state": BallStateNode}, SETTINGS, signals, args)
