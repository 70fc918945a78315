"""The node `ball_trajectory`: where the ball should be, from the moment the controller balances it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from acts_control.names import REFERENCE_TOPIC, STATUS_TOPIC, frame_of, set_stamp
from acts_control.trajectory import Trajectory, TrajectoryConfig
from acts_core.settings import setting
from acts_core.stop_signals import StopSignals
from acts_msgs.msg import BalanceStatus, BallReference
from acts_ros.executor import run
from acts_ros.parameters import declare, node_options
from acts_ros.qos import STATE

# A status older than this says nothing any more.
_STATUS_STALE_NS = 500_000_000

_FROM_THE_START = (BalanceStatus.STATE_CONNECTING, BalanceStatus.STATE_HOMING, BalanceStatus.STATE_STOPPED)


@dataclass(frozen=True)
class BallTrajectorySettings(TrajectoryConfig):
    """Parameters of the node."""

    publish_rate_hz: float = setting(125.0, "how often the reference is published", minimum=10.0, maximum=500.0)
    frame_id: str = setting("", "frame of the skin; empty: the name of the namespace")


class BallTrajectoryNode(Node):
    """Publishes the reference; its clock runs while the controller balances and starts anew after a stop."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__("ball_trajectory", **node_options(), **node_arguments)
        settings = declare(self, BallTrajectorySettings)
        self._trajectory = Trajectory(settings)
        self._elapsed_s = 0.0
        self._status = BalanceStatus.STATE_CONNECTING
        self._status_ns = self._last_ns = self.get_clock().now().nanoseconds
        self._finished = False
        self._message = BallReference()
        self._message.header.frame_id = frame_of(self, settings.frame_id)
        self._publisher = self.create_publisher(BallReference, REFERENCE_TOPIC, STATE)
        self.create_subscription(BalanceStatus, STATUS_TOPIC, self._on_status, STATE)
        self.create_timer(1.0 / settings.publish_rate_hz, self._publish)
        self.get_logger().info(f"{settings.trajectory}: {self._trajectory.duration_s:.1f} s")

    def _on_status(self, message: BalanceStatus) -> None:
        self._status = message.state
        self._status_ns = self.get_clock().now().nanoseconds
        if self._status in _FROM_THE_START:
            self._elapsed_s = 0.0
            self._finished = False

    def _publish(self) -> None:
        now_ns = self.get_clock().now().nanoseconds
        if self._status == BalanceStatus.STATE_BALANCING and now_ns - self._status_ns < _STATUS_STALE_NS:
            self._elapsed_s += max(now_ns - self._last_ns, 0) * 1e-9
        self._last_ns = now_ns
        timed, message = self._trajectory.at(self._elapsed_s), self._message
        reference = timed.reference
        set_stamp(message.header.stamp, now_ns)
        message.segment = timed.segment
        message.segment_time = timed.segment_time_s
        message.finished = timed.finished
        message.position.x, message.position.y = reference.x_m, reference.y_m
        message.velocity.x, message.velocity.y = reference.vx_m_s, reference.vy_m_s
        message.acceleration.x, message.acceleration.y = reference.ax_m_s2, reference.ay_m_s2
        self._publisher.publish(message)
        if timed.finished and not self._finished:
            self._finished = True
            self.get_logger().info("trajectory finished; the ball is held where it ended")


def main(signals: StopSignals | None = None) -> int:
    """Run the node; the exit code."""
    return run([BallTrajectoryNode], signals=signals)
