# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `ball_trajectory`: where the ball should be, from the moment the controller balances it.

Topics: ball/status in; ball/reference out.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from acts_control.ball import Phase, Reference, TimedReference, Trajectory, TrajectoryConfig
from acts_control.ball.nodes.names import CLOCK_REASON, REFERENCE_TOPIC, STATUS_TOPIC
from acts_core.runtime import RateLimit
from acts_core.settings import Changeable, setting
from acts_core.stop_signals import StopSignals
from acts_msgs.msg import BalanceStatus, BallReference
from acts_ros.clocks import keep_system_clock, steady_timer
from acts_ros.composition import run_nodes
from acts_ros.messages import set_stamp, skin_frame
from acts_ros.parameters import declare, node_options, set_rate
from acts_ros.publishers import TolerantPublisher
from acts_ros.qos import STATE

# A status older than this says nothing any more.
_STATUS_STALE_S = 0.5

_FROM_THE_START = (Phase.CONNECTING, Phase.HOMING, Phase.STOPPED)

# How often the reference is published while the control loop does not ask, since it is connecting or stopped [s].
_UNDRIVEN_S = 0.1

# After the process was held up for longer, the trajectory goes on from where it was: the ball is not led by a leap.
_LONGEST_STEP_S = 0.1


@dataclass(frozen=True)
class BallTrajectorySettings(TrajectoryConfig):
    """Parameters of the node."""

    publish_rate_hz: float = setting(
        125.0, "how often the reference is published [Hz]", minimum=10.0, maximum=500.0, changeable=Changeable.RUNNING
    )
    frame_id: str = setting("", "frame of the skin; empty or none: the name of the namespace, with _ for /")


class BallTrajectoryNode(Node):
    """Publishes the reference; its clock runs while the controller balances and starts anew after a stop.

    Parameters
    ----------
    is_driven : bool
        Whether a controller of the same process calls `advance`; the node does so itself while nobody does. Otherwise
        it does so at the rate it publishes with.

    Attributes
    ----------
    phase : callable
        What the controller does, as far as is known; by default as the topic of the status says.
    """

    def __init__(self, *, is_driven: bool = False, **node_arguments: Any) -> None:
        super().__init__("ball_trajectory", **node_options(), **node_arguments)
        settings = declare(self, BallTrajectorySettings, self._change)
        keep_system_clock(self, CLOCK_REASON)
        self._trajectory = Trajectory(settings)
        self.phase: Callable[[], Phase] = self._told_phase
        self._lock = threading.Lock()
        # A controller may ask more often; a timer of our own is not held up by being a little early.
        self._limit = RateLimit(settings.publish_rate_hz if is_driven else 0.0)
        self._is_driven = is_driven
        self._elapsed_s = 0.0
        self._told = Phase.CONNECTING
        # By the steady clock, as all that is timed here: that of the stamps may be set.
        self._told_s = self._last_s = time.monotonic()
        self._finished = False
        self._message = BallReference()
        self._message.header.frame_id = skin_frame(self, settings.frame_id)
        self._publisher = self.create_publisher(
            BallReference, REFERENCE_TOPIC, STATE, publisher_class=TolerantPublisher
        )
        if not is_driven:
            self.create_subscription(BalanceStatus, STATUS_TOPIC, self._on_status, STATE)
        self._timer = steady_timer(self, _UNDRIVEN_S if is_driven else 1.0 / settings.publish_rate_hz, self._on_timer)
        self.get_logger().info(f"{settings.trajectory}: {self._trajectory.duration_s:.1f} s")

    def advance(self, now_ns: int, phase: Phase) -> Reference:
        """The reference for a moment, which is also published. From any thread.

        Parameters
        ----------
        now_ns : int
            The time, by the clock of the stamps [ns].
        phase : Phase
            What the controller does.
        """
        with self._lock:
            now_s = time.monotonic()
            passed_s, self._last_s = now_s - self._last_s, now_s
            if phase in _FROM_THE_START:
                self._elapsed_s = 0.0
                self._finished = False
            elif phase is Phase.BALANCING:
                self._elapsed_s += min(passed_s, _LONGEST_STEP_S)
            timed = self._trajectory.at(self._elapsed_s)
            if self._publisher.get_subscription_count() and self._limit.due(now_s):
                self._publish(now_ns, timed)
            if timed.finished and not self._finished:
                self._finished = True
                self.get_logger().info("trajectory finished; the ball is held where it ended")
            return timed.reference

    def _change(self, settings: BallTrajectorySettings) -> str:
        """Put changed parameters in force."""
        if self._is_driven:
            self._limit.set_rate(settings.publish_rate_hz)
        else:
            set_rate(self._timer, settings.publish_rate_hz)
        return ""

    def _on_status(self, message: BalanceStatus) -> None:
        self._told = Phase(message.state) if message.state in list(Phase) else Phase.WAITING
        self._told_s = time.monotonic()

    def _told_phase(self) -> Phase:
        is_stale = time.monotonic() - self._told_s >= _STATUS_STALE_S
        # Whether it still balances is not known: the trajectory waits.
        return Phase.WAITING if is_stale and self._told is Phase.BALANCING else self._told

    def _on_timer(self) -> None:
        if not self._is_driven or time.monotonic() - self._last_s > _UNDRIVEN_S:
            self.advance(self.get_clock().now().nanoseconds, self.phase())

    def _publish(self, now_ns: int, timed: TimedReference) -> None:
        reference, message = timed.reference, self._message
        set_stamp(message.header.stamp, now_ns)
        message.segment = timed.segment
        message.segment_time = timed.segment_time_s
        message.finished = timed.finished
        message.position.x, message.position.y = reference.x_m, reference.y_m
        message.velocity.x, message.velocity.y = reference.vx_m_s, reference.vy_m_s
        message.acceleration.x, message.acceleration.y = reference.ax_m_s2, reference.ay_m_s2
        self._publisher.publish(message)


SETTINGS: dict[str, type] = {"ball_trajectory": BallTrajectorySettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    return run_nodes({"ball_trajectory": BallTrajectoryNode}, SETTINGS, signals, args)
