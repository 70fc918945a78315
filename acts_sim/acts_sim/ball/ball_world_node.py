# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `ball_world`: the simulated plate with its ball, from the robot's joints to the board's taxels.

Publishes the ball's true position on ``ball/truth``, for evaluation only: no controller subscribes to it. The service
``~/put_back`` puts a ball that fell off on the plate again.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from std_srvs.srv import Trigger

from acts_core.errors import ActsError, SettingsError
from acts_core.runtime import RealtimeConfig, enter_realtime
from acts_core.settings import setting
from acts_core.stop_signals import StopSignals
from acts_ros import qos
from acts_ros.clocks import keep_system_clock
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import ERROR, OK, WARN, DiagnosticsReporter, Report
from acts_ros.log import log_of
from acts_ros.messages import set_stamp, skin_frame
from acts_ros.parameters import declare, node_options
from acts_ros.publishers import TolerantPublisher
from acts_sim.ball.joint_follower import JointFollower, JointSource
from acts_sim.ball.world import Phase, World, WorldConfig, WorldState
from acts_sim.ball.world_loop import STEP_NS, LoopStatistics, WorldLoop
from acts_sim.shared import COMPILING, FileClaim, TimedRingWriter, default_run_dir, telling_of_compiling

_NS_PER_MS = 1_000_000


@dataclass(frozen=True)
class BallWorldSettings(RealtimeConfig, WorldConfig):
    """Parameters of the node: the world's, and its connections to robot and board."""

    field_ring: str = setting(
        "", "shared file the pressure field is written to; empty: field.ring in the folder /dev/shm/acts-USER"
    )
    joint_ring: str = setting(
        "",
        "shared file the simulated robot writes its joints to; none: no robot, the plate lies still; empty: "
        "joints.ring in the folder /dev/shm/acts-USER",
    )
    frame_id: str = setting("", "frame of the skin; empty or none: the name of the namespace, with _ for /")
    truth_period_s: float = setting(
        0.008, "time between publications of the ball's true position, in steps of 2 ms [s]", minimum=0.002, maximum=1.0
    )

    def __post_init__(self) -> None:
        RealtimeConfig.__post_init__(self)
        if not math.isclose(self.truth_steps, round(self.truth_steps)):
            raise SettingsError(
                f"truth_period_s = {self.truth_period_s:g}: allowed are whole steps of {STEP_NS * 1e-9:g} s, in which "
                "the world is computed"
            )
        if self.field_ring and self.field_ring == self.joint_ring:
            raise SettingsError(
                f"field_ring and joint_ring are both {self.field_ring}: each needs a file of its own; without a robot "
                "joint_ring is none"
            )

    @property
    def truth_steps(self) -> float:
        """Steps of the world between publications of the ball's true position."""
        return self.truth_period_s * 1e9 / STEP_NS


class BallWorld(Node):
    """Connects ROS with the world, which runs in a thread of its own."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__("ball_world", **node_options(), **node_arguments)
        settings = declare(self, BallWorldSettings)
        keep_system_clock(self, "robot, ball and board are simulated as fast as real ones, and share the steady clock")
        self._settings = settings
        self._frame_id = skin_frame(self, settings.frame_id)
        self._truth = self.create_publisher(PointStamped, "ball/truth", qos.STATE, publisher_class=TolerantPublisher)
        self._message = PointStamped()
        self._message.header.frame_id = self._frame_id
        self._steps = 0
        self._refused_reported = 0
        self._reported = (time.monotonic(), LoopStatistics())
        self._field_ring = Path(settings.field_ring or default_run_dir() / "field.ring")
        joint_ring = settings.joint_ring or str(default_run_dir() / "joints.ring")
        self._joint_ring = None if joint_ring == "none" else Path(joint_ring)
        self._joints = JointFollower(self._joint_ring)
        self._undo = ExitStack()
        self._diagnostics = DiagnosticsReporter(self, str(self._field_ring), self._report)
        # Compiles. What others see of the world is made in `begin`: a signal may come in between.
        with self._diagnostics.busy(COMPILING), telling_of_compiling(self._tell):
            self._world = World(settings)

    def begin(self) -> None:
        """Make the ring, and start the world."""
        settings = self._settings
        self._undo.enter_context(closing(FileClaim(self._field_ring)))
        ring = self._undo.enter_context(TimedRingWriter(self._field_ring, settings.rows * settings.cols))
        self._loop = WorldLoop(self._world, self._joints, ring, self._publish, on_running=self._enter_realtime)
        self._undo.callback(self._loop.stop)
        self._loop.start()
        self.create_service(Trigger, "~/put_back", self._on_put_back)
        self.get_logger().info(
            f"ball of {settings.diameter_m * 1000:g} mm, {settings.mass_kg:.3f} kg; field in {self._field_ring}, "
            f"joints from {self._joint_ring or 'none'}"
        )

    def close(self) -> None:
        """Stop the world and remove its ring."""
        self._undo.close()

    def _on_put_back(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        objection = self._world.put_back()
        response.success = not objection
        response.message = objection or "put back once the plate is level and still"
        return response

    def _tell(self, sentence: str) -> None:
        self.get_logger().info(sentence)

    def _enter_realtime(self) -> None:
        enter_realtime(self._settings, "ball_world", log_of(self))

    def _publish(self, time_ns: int, state: WorldState) -> None:
        self._steps += 1
        if state.phase is not Phase.ROLLING or self._steps % round(self._settings.truth_steps):
            return
        if not self._truth.get_subscription_count():
            return
        stamp_ns = self.get_clock().now().nanoseconds + time_ns - time.monotonic_ns()
        message = self._message
        set_stamp(message.header.stamp, stamp_ns)
        message.point.x = state.ball.x_m
        message.point.y = state.ball.y_m
        self._truth.publish(message)

    def _report(self) -> Report:
        if self._loop.failure is not None:
            raise ActsError(f"the world has stopped: {self._loop.failure!r}")
        state, loop, source = self._world.state, self._loop.statistics, self._joints.source
        now_s = time.monotonic()
        before_s, before = self._reported
        self._reported = (now_s, loop)
        refused = state.joints_refused - self._refused_reported
        self._refused_reported = state.joints_refused
        values = {
            "ball": state.phase.value,
            "ball_x_m": state.ball.x_m,
            "ball_y_m": state.ball.y_m,
            "load_n": state.ball.load_n,
            "rate_hz": (loop.steps - before.steps) / max(now_s - before_s, 1e-9),
            "late": loop.late,
            "latest_s": loop.latest_s,
            "skipped": loop.skipped,
            "joints": source.value,
            "joints_refused": state.joints_refused,
            "pushes": state.pushes,
            "falls": state.falls,
        }
        if refused:
            return ERROR, f"{refused} joint states were NaN or impossible; the plate keeps its last pose", values
        if source not in (JointSource.NONE, JointSource.FOLLOWED):
            why = f" ({self._joints.problem})" if self._joints.problem else ""
            return WARN, f"{source.value}{why}; the plate is at rest", values
        if loop.skipped > before.skipped:
            stood_ms = (loop.skipped - before.skipped) * STEP_NS // _NS_PER_MS
            return WARN, f"the world stood still for {stood_ms} ms", values
        if state.phase is Phase.FALLEN:
            back = way_back(self._settings.replace_after_s, state.phase_time_s)
            return WARN, f"the ball has fallen off the plate: {back}", values
        return OK, f"the ball is {state.phase.value}", values


def way_back(replace_after_s: float, fallen_s: float) -> str:
    """How a ball comes back that fell off a while ago [s], in words; `replace_after_s` as of `WorldConfig`."""
    if not replace_after_s:
        return "start ball_world anew to put it back (replace_after_s is 0), or call its service put_back"
    if fallen_s < replace_after_s:
        return f"put back after {replace_after_s:g} s"
    return "put back once the plate is level and still (start_slope, start_turn_rate_rad_s)"


SETTINGS: dict[str, type] = {"ball_world": BallWorldSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node and return the exit code."""
    return run_nodes({"ball_world": BallWorld}, SETTINGS, signals, args)
