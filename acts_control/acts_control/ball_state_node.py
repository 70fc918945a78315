"""The node `ball_state`: 1 kHz contacts in, the ball's position and velocity out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Vector3Stamped
from rclpy.node import Node

from acts_control.estimator import BallEstimator, ContactMeasurement, EstimatorConfig
from acts_control.names import CONTACT_TOPIC, STATE_TOPIC, STATISTICS_TOPIC, TILT_TOPIC, set_stamp, to_ns
from acts_control.stream_statistics import StreamCounter
from acts_core.settings import setting
from acts_core.stop_signals import StopSignals
from acts_msgs.msg import BallState, Contact, StreamStatistics
from acts_ros.diagnostics import OK, WARN, DiagnosticsReporter, Report
from acts_ros.executor import run
from acts_ros.parameters import declare, node_options
from acts_ros.qos import STATE, STREAM, overridable

_STATISTICS_PERIOD_S = 1.0


@dataclass(frozen=True)
class BallStateSettings(EstimatorConfig):
    """Parameters of the node."""

    publish_rate_hz: float = setting(
        250.0, "how often the state is published, at most as often as contacts arrive", minimum=1.0, maximum=2000.0
    )


class BallStateNode(Node):
    """Runs the estimator on every contact and publishes every n-th state, as the paper's "system state node"."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__("ball_state", **node_options(), **node_arguments)
        settings = declare(self, BallStateSettings)
        self._estimator = BallEstimator(settings)
        self._counter = StreamCounter()
        self._period_ns = round(1e9 / settings.publish_rate_hz)
        self._due_ns = 0
        self._message = BallState()
        self._clock = self.get_clock()
        self._interval_start_ns = self._clock.now().nanoseconds
        self._reported = 0
        self._state_publisher = self.create_publisher(BallState, STATE_TOPIC, STATE)
        self._statistics_publisher = self.create_publisher(StreamStatistics, STATISTICS_TOPIC, STATE)
        self.create_subscription(Vector3Stamped, TILT_TOPIC, self._on_tilt, STREAM)
        self._contacts = self.create_subscription(Contact, CONTACT_TOPIC, self._on_contact, **overridable(STREAM))
        self.create_timer(_STATISTICS_PERIOD_S, self._publish_statistics)
        self._diagnostics = DiagnosticsReporter(self, "ball", self._report)

    def _on_tilt(self, message: Vector3Stamped) -> None:
        self._estimator.set_tilt(to_ns(message.header.stamp), message.vector.x, message.vector.y)

    def _on_contact(self, message: Contact) -> None:
        # A thousand times a second: nothing here that is not needed.
        stamp_ns = to_ns(message.header.stamp)
        self._counter.step(message.sequence, (self._clock.now().nanoseconds - stamp_ns) * 1e-9)
        centre = message.centre_of_pressure
        self._estimator.step(ContactMeasurement(stamp_ns, message.in_contact, centre.x, centre.y, message.force))
        state_ns = self._estimator.state.stamp_ns
        if state_ns >= self._due_ns or state_ns < self._due_ns - 2 * self._period_ns:
            # Kept on a grid, so that the rate is right on average whatever the contacts' own rate.
            late = state_ns - self._due_ns
            self._due_ns += self._period_ns if 0 <= late < self._period_ns else late + self._period_ns
            self._publish_state(message.header.frame_id)

    def _publish_state(self, frame_id: str) -> None:
        state, message = self._estimator.state, self._message
        message.header.frame_id = frame_id
        set_stamp(message.header.stamp, state.stamp_ns)
        message.valid = state.valid
        message.position.x, message.position.y = state.x_m, state.y_m
        message.velocity.x, message.velocity.y = state.vx_m_s, state.vy_m_s
        message.position_sigma = state.sigma_m
        message.contacts_received = state.received
        self._state_publisher.publish(message)

    def _publish_statistics(self) -> None:
        now_ns = self._clock.now().nanoseconds
        message = StreamStatistics(
            topic=self._contacts.topic_name,
            receiver=self.get_fully_qualified_name(),
            interval=(now_ns - self._interval_start_ns) * 1e-9,
            received=self._counter.received,
            lost=self._counter.lost,
            latencies=self._counter.take_latencies(),
        )
        set_stamp(message.header.stamp, now_ns)
        self._interval_start_ns = now_ns
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
            "out_of_order": state.out_of_order,
            "restarts": state.restarts,
            "valid": state.valid,
        }
        if not arrived:
            return WARN, f"no contact messages on {self._contacts.topic_name}", values
        if state.not_finite:
            return WARN, f"{state.not_finite} contacts were not finite and were left out", values
        return OK, "ball" if state.valid else "no ball", values


def main(signals: StopSignals | None = None) -> int:
    """Run the node; the exit code."""
    return run([BallStateNode], signals=signals)
