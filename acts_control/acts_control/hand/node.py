"""The node `hand`: joint angles in, the motors' bus out, and what the joints do.

Topics: ~/command in; joint_states out, and cmd_leap where the hand is moved by that. Services: ~/enable, ~/release.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger

from acts_control.hand.bus import HandBus, HandError, HandReading
from acts_control.hand.cmd_leap import CmdLeapBus
from acts_control.hand.description import LEAP_RIGHT
from acts_control.hand.dynamixel import DynamixelConfig, DynamixelHand
from acts_control.hand.loop import HandLoop, HandLoopConfig, HandPhase
from acts_core.realtime import RealtimeConfig, enter_realtime
from acts_core.settings import setting
from acts_core.stop_signals import StopSignals
from acts_ros.clocks import keep_system_clock
from acts_ros.composition import parameters_from
from acts_ros.diagnostics import ERROR, OK, WARN, DiagnosticsReporter, Report
from acts_ros.executor import run
from acts_ros.log import log_of
from acts_ros.parameters import declare, node_options
from acts_ros.qos import STATE

_LEVELS = {HandPhase.CONNECTING: WARN, HandPhase.RECOVERING: WARN, HandPhase.GIVEN_UP: ERROR}


@dataclass(frozen=True)
class HandSettings(RealtimeConfig, HandLoopConfig, DynamixelConfig):
    """Parameters of the node."""

    interface: str = setting(
        "dynamixel",
        "how the hand is moved: its motors' bus at port, or the topic cmd_leap of the LEAP team's own node",
        choices=("dynamixel", "cmd_leap"),
    )
    frame_id: str = setting("palm_lower", "frame of the joint states")

    def __post_init__(self) -> None:
        DynamixelConfig.__post_init__(self)
        RealtimeConfig.__post_init__(self)


class HandNode(Node):
    """Hands messages to the hand's loop and publishes what it reads."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__("hand", **node_options(), **node_arguments)
        settings = declare(self, HandSettings)
        keep_system_clock(self, "it moves a hand, which knows nothing of simulated time")
        self._settings = settings
        self._states = JointState()
        self._states.header.frame_id = settings.frame_id
        self._states.name = LEAP_RIGHT.names
        self._publisher = self.create_publisher(JointState, "joint_states", STATE)
        self._loop = HandLoop(LEAP_RIGHT, self._make_bus(settings), settings, log_of(self), self._on_reading)
        self.create_subscription(JointState, "~/command", self._on_command, STATE)
        self.create_service(Trigger, "~/enable", self._on_enable)
        self.create_service(Trigger, "~/release", self._on_release)
        self._diagnostics = DiagnosticsReporter(self, settings.port, self._report)

    def begin(self) -> None:
        """Start the loop, and with `autostart` the motors."""
        enter_realtime(self._settings, "hand", log_of(self))
        self._loop.launch()

    def close(self) -> None:
        """Release the hand in order."""
        self._loop.close()

    def _make_bus(self, settings: HandSettings) -> HandBus:
        if settings.interface == "dynamixel":
            return DynamixelHand(LEAP_RIGHT, settings)
        publisher = self.create_publisher(JointState, "cmd_leap", STATE)
        return CmdLeapBus(LEAP_RIGHT, lambda angles_rad: publisher.publish(JointState(position=angles_rad)))

    def _on_reading(self, reading: HandReading) -> None:
        # From the loop's thread.
        message = self._states
        message.header.stamp = self.get_clock().now().to_msg()
        message.position = list(reading.q_rad)
        message.velocity = list(reading.qd_rad_s)
        message.effort = list(reading.current_ma)
        self._publisher.publish(message)

    def _on_command(self, message: JointState) -> None:
        if len(message.name) != len(message.position):
            self._refuse(f"{len(message.name)} names with {len(message.position)} positions")
            return
        try:
            self._loop.command(dict(zip(message.name, message.position, strict=True)))
        except HandError as error:
            self._refuse(str(error))

    def _refuse(self, why: str) -> None:
        self.get_logger().error(f"a command was left out: {why}", throttle_duration_sec=1.0)

    def _on_enable(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.message = self._loop.enable()
        response.success = not response.message
        return response

    def _on_release(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._loop.release()
        response.success = True
        response.message = "releasing"
        return response

    def _report(self) -> Report:
        status = self._loop.status
        values: dict[str, object] = {
            "state": status.phase.name,
            "cycles": status.cycles,
            "late_cycles": status.late,
            "unanswered": status.unanswered,
            "recovered": status.recovered,
        }
        if status.reading is not None:
            values["hottest_c"] = max(status.reading.temperature_c)
            values["largest_current_ma"] = max(map(abs, status.reading.current_ma))
        return _LEVELS.get(status.phase, OK), f"{status.phase.name.lower()}: {status.reason}", values


SETTINGS: dict[str, type] = {"hand": HandSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    words = list(sys.argv if args is None else args)
    given = parameters_from(words, SETTINGS)
    return run([lambda: HandNode(parameter_overrides=given["hand"])], words, signals)
