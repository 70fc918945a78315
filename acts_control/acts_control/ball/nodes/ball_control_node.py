# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `ball_control`: estimate and reference in, tilts of the plate to the robot out.

Topics: ball/state and ball/reference in; ball/status and ball/tilt out. Services: ~/start, ~/stop.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Vector3Stamped
from rclpy.duration import Duration
from rclpy.node import Node
from std_srvs.srv import Trigger

from acts_control.ball import Ball, BallReport, ControlLoop, LoopConfig, LoopStatus, Phase, Reference, ReferenceReport
from acts_control.ball.nodes.ball_state_node import BallStateNode
from acts_control.ball.nodes.ball_trajectory_node import BallTrajectoryNode
from acts_control.ball.nodes.names import CLOCK_REASON, REFERENCE_TOPIC, STATE_TOPIC, STATUS_TOPIC, TILT_TOPIC
from acts_control.ball.nodes.other_frames import OtherFrames
from acts_control.robots import make_robot, with_robots
from acts_control.robots.base import Robot
from acts_core.errors import SettingsError
from acts_core.runtime import RealtimeConfig, enter_realtime
from acts_core.settings import Changeable, setting
from acts_core.stop_signals import StopSignals
from acts_msgs.msg import BalanceStatus, BallReference, BallState
from acts_ros.clocks import Stalls, keep_system_clock, steady_timer
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import ERROR, OK, WARN, DiagnosticsReporter, Report
from acts_ros.log import LoggedChanges, log_of
from acts_ros.messages import ns_of, set_stamp, skin_frame
from acts_ros.parameters import declare, node_options, set_rate
from acts_ros.publishers import TolerantPublisher
from acts_ros.qos import STATE, STREAM

# Nothing older than this means anything; it stands for "never" in the status.
_LONG_AGO_S = 1e6

_LEVELS = {Phase.CONNECTING: WARN, Phase.STOPPED: ERROR}

# In these, touch and reference are looked at.
_FEELING = (Phase.WAITING, Phase.BALANCING)

# How long the last status may take to arrive where it is heard.
_LAST_WORDS_S = 0.5


@dataclass(frozen=True)
class _OwnSettings(RealtimeConfig, LoopConfig):
    """Parameters of the node."""

    status_rate_hz: float = setting(
        50.0, "how often the status is published [Hz]", minimum=1.0, maximum=500.0, changeable=Changeable.RUNNING
    )
    frame_id: str = setting("", "frame of the skin; empty or none: the name of the namespace, with _ for /")

    def __post_init__(self) -> None:
        LoopConfig.__post_init__(self)
        RealtimeConfig.__post_init__(self)


def settings_class() -> type:
    """The node's own parameters, and those of every robot there is."""
    return with_robots(_OwnSettings)


BallControlSettings = settings_class()


class BallControlNode(Node):
    """Hands messages to the control loop's thread and publishes what it does.

    Parameters
    ----------
    make : callable
        Makes the robot from the settings; by default the one that they name.
    subscribes : bool
        Whether estimate and reference come as messages; otherwise `follow` says who gives them.
    """

    def __init__(
        self,
        make: Callable[[Any], Robot] = make_robot,
        *,
        subscribes: bool = True,
        **node_arguments: Any,
    ) -> None:
        super().__init__("ball_control", **node_options(), **node_arguments)
        # Made anew: a robot may have been entered into `ROBOTS` since this module was imported.
        settings: Any = declare(self, settings_class(), self._change)
        keep_system_clock(self, CLOCK_REASON)
        self._settings = settings
        first = LoopStatus()
        self._changes = LoggedChanges(first.phase, first.reason)
        self._told_phase = first.phase
        frame_id = skin_frame(self, settings.frame_id)
        self._status = BalanceStatus()
        self._status.header.frame_id = frame_id
        self._other_states = OtherFrames("estimate", "estimates", frame_id)
        self._other_references = OtherFrames("reference", "references", frame_id)
        self._tilt = Vector3Stamped()
        self._tilt.header.frame_id = frame_id
        self._status_publisher = self.create_publisher(
            BalanceStatus, STATUS_TOPIC, STATE, publisher_class=TolerantPublisher
        )
        self._tilt_publisher = self.create_publisher(
            Vector3Stamped, TILT_TOPIC, STREAM, publisher_class=TolerantPublisher
        )
        clock = self.get_clock()
        robot = make(settings)
        self._loop = ControlLoop(settings, robot, lambda: clock.now().nanoseconds, self._on_step)
        self._state_node: BallStateNode | None = None
        if subscribes:
            self.create_subscription(BallState, STATE_TOPIC, self._on_state, STATE)
            self.create_subscription(BallReference, REFERENCE_TOPIC, self._on_reference, STATE)
        self._stalls = Stalls(self)
        self._loop.stood_still = self._stalls.since
        self.create_service(Trigger, "~/start", self._on_start)
        self.create_service(Trigger, "~/stop", self._on_stop)
        self._status_timer = steady_timer(self, 1.0 / settings.status_rate_hz, self._publish_status)
        self._diagnostics = DiagnosticsReporter(
            self,
            robot.address,
            self._report,
            only_publishers=[STATE_TOPIC, REFERENCE_TOPIC] if subscribes else [],
        )

    def follow(self, state: BallStateNode, trajectory: BallTrajectoryNode) -> None:
        """Ask these two nodes of the same process at the begin of every control step; they wait for no timer then.

        Raises
        ------
        SettingsError
            When the estimator has another `lever_arm_m`: what it follows is not what is controlled then.
        """
        own_m = self._settings.lever_arm_m
        if state.lever_arm_m != own_m:
            raise SettingsError(
                f"lever_arm_m: ball_state has {state.lever_arm_m:g} and ball_control {own_m:g}; both are of one plate, "
                f"give them the same"
            )
        self._state_node = state
        trajectory.phase = lambda: self._loop.status.phase

        clock = self.get_clock()

        def look(phase: Phase) -> None:
            self._loop.ball = state.update()
            now_ns = clock.now().nanoseconds
            self._loop.reference = ReferenceReport(now_ns, trajectory.advance(now_ns, phase))

        self._loop.look = look

    def begin(self) -> None:
        """Start the control loop, and with `autostart` the robot."""
        enter_realtime(self._settings, "ball_control", log_of(self))
        self._stalls.begin()
        self._loop.launch()

    def close(self) -> None:
        """Stop the robot in order, and say so."""
        self._loop.close()
        self._publish_status()
        # What has not arrived when the publisher is destroyed is lost.
        self._status_publisher.wait_for_all_acked(Duration(seconds=_LAST_WORDS_S))

    def _change(self, settings: Any) -> str:
        """Put changed parameters in force."""
        self._loop.change(settings)
        set_rate(self._status_timer, settings.status_rate_hz)
        return ""

    def _on_state(self, message: BallState) -> None:
        if self._other_states.has(message.header.frame_id):
            return
        position, velocity = message.position, message.velocity
        self._loop.ball = BallReport(
            ns_of(message.header.stamp), message.valid, Ball(position.x, position.y, velocity.x, velocity.y)
        )

    def _on_reference(self, message: BallReference) -> None:
        if self._other_references.has(message.header.frame_id):
            return
        position, velocity, acceleration = message.position, message.velocity, message.acceleration
        reference = Reference(position.x, position.y, velocity.x, velocity.y, acceleration.x, acceleration.y)
        self._loop.reference = ReferenceReport(ns_of(message.header.stamp), reference)

    def _on_step(self, now_ns: int, tilt_rad: tuple[float, float]) -> None:
        # From the loop's thread.
        if self._state_node is not None:
            self._state_node.set_tilt(now_ns, tilt_rad)
        if not self._tilt_publisher.get_subscription_count():
            return
        set_stamp(self._tilt.header.stamp, now_ns)
        self._tilt.vector.x, self._tilt.vector.y = tilt_rad
        self._tilt_publisher.publish(self._tilt)

    def _on_start(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.message = self._stalls.objection()
        if response.message:
            return response
        response.success = self._loop.start()
        status = self._loop.status
        if response.success:
            response.message = "started"
        elif self._loop.is_stopping:
            response.message = f"still stopping ({status.reason}); call again once the state is STOPPED"
        elif status.phase is Phase.STOPPED:
            response.message = f"the control loop has ended ({status.reason}); start the node anew"
        else:
            response.message = f"already {status.phase.name.lower()}: {status.reason}"
        return response

    def _on_stop(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success = self._loop.stop("stopped by request")
        response.message = "stopping" if response.success else f"already stopped: {self._loop.status.reason}"
        return response

    def _publish_status(self) -> None:
        status, message = self._loop.status, self._status
        if self._changes.is_due(status.phase, status.reason):
            self._tell(status)
        if status.phase is not self._told_phase:
            self._diagnostics.publish()
        self._told_phase = status.phase
        set_stamp(message.header.stamp, self.get_clock().now().nanoseconds)
        message.state = int(status.phase)
        message.reason = status.reason
        message.error.x, message.error.y = status.error_m
        message.tilt_commanded.x, message.tilt_commanded.y = status.tilt_commanded_rad
        message.tilt_measured.x, message.tilt_measured.y = status.tilt_measured_rad
        message.joints_commanded = list(status.joints)
        message.touch_age = min(status.touch_age_s, _LONG_AGO_S)
        message.steps = status.steps
        message.late_steps = status.late_steps
        self._status_publisher.publish(message)

    def _tell(self, status: LoopStatus) -> None:
        text = f"{status.phase.name.lower()}: {status.reason}"
        if status.phase is Phase.STOPPED:
            self.get_logger().warning(text)
        else:
            self.get_logger().info(text)

    def _report(self) -> Report:
        status = self._loop.status
        values = {
            "state": status.phase.name,
            "touch_age_ms": 1e3 * min(status.touch_age_s, _LONG_AGO_S),
            "error_x_mm": 1e3 * status.error_m[0],
            "error_y_mm": 1e3 * status.error_m[1],
            "steps": status.steps,
            "late_steps": status.late_steps,
            "in_another_frame": self._other_states.count + self._other_references.count,
        }
        level = _LEVELS.get(status.phase, OK)
        is_old = status.touch_age_s > self._settings.touch_stale_after_s
        if status.phase in _FEELING and (is_old or status.reference_problem):
            level = WARN
        words = [f"{status.phase.name.lower()}: {status.reason}"]
        left_out = [*filter(None, (self._other_states.newly(), self._other_references.newly()))]
        if left_out:
            level = max(level, WARN)
        return level, "; ".join([*words, *left_out]), values


SETTINGS: dict[str, type] = {"ball_control": BallControlSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    return run_nodes({"ball_control": BallControlNode}, SETTINGS, signals, args)
