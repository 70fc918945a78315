# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the nodes of a hand share: its description, its motors' loop, joint states, torque on and off, diagnostics."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import JointState

from acts_control.hand.control import Behaviour, HandLoop, HandLoopConfig, HandPhase, PendingAnswer
from acts_control.hand.description import HandDescription, hand_description
from acts_control.hand.motors import MOTORS, BusConfig, HandBus, HandError, HandReading, make_motors
from acts_control.hand.nodes.cmd_leap import TORQUE_STAYS, CmdLeapBus
from acts_control.hand.nodes.torque_services import TorqueServices
from acts_core.runtime import RealtimeConfig, enter_realtime
from acts_core.settings import setting
from acts_ros.clocks import Stalls, keep_system_clock
from acts_ros.diagnostics import ERROR, OK, WARN, DiagnosticsReporter, Report
from acts_ros.log import log_of
from acts_ros.messages import check_frame_id
from acts_ros.middleware import reason_of
from acts_ros.polled import PollingNode
from acts_ros.publishers import TolerantPublisher
from acts_ros.qos import STATE

_BASE = "none"
# An interface, and the topic of that name.
_CMD_LEAP = "cmd_leap"
_LEVELS = {HandPhase.CONNECTING: WARN, HandPhase.RECOVERING: WARN, HandPhase.GIVEN_UP: ERROR}


@dataclass(frozen=True)
class MotorSettings(RealtimeConfig, HandLoopConfig, BusConfig):
    """Parameters of a node that moves a hand; those of motors come with `acts_control.hand.motors.with_motors`."""

    hand: str = setting("leap_right", "the hand: leap_right, or the path of a .yaml file (docs/hand.md)")
    interface: str = setting(
        "dynamixel",
        "how the hand is moved: by motors of this make at port, or by the topic cmd_leap of the LEAP team's own node",
        choices=(*MOTORS, _CMD_LEAP),
    )
    frame_id: str = setting(_BASE, "frame of joint states and status; none: the base of the hand")

    def __post_init__(self) -> None:
        RealtimeConfig.__post_init__(self)
        HandLoopConfig.__post_init__(self)
        if self.interface in MOTORS:
            config: Any = MOTORS[self.interface].config
            config.__post_init__(self)
            config.check_rate(self, self.rate_hz)
        check_frame_id(self.frame_id, "none is the base of the hand")

    def frame_of(self, hand: HandDescription) -> str:
        """Frame of the messages of a hand."""
        return hand.base if self.frame_id == _BASE else self.frame_id


def make_bus(node: Node, hand: HandDescription, settings: MotorSettings) -> HandBus:
    """The motors that the settings name."""
    if settings.interface != _CMD_LEAP:
        return make_motors(settings.interface, hand, settings)
    # Not a tolerant one: the loop has to know which goals were sent.
    publisher = node.create_publisher(JointState, _CMD_LEAP, STATE, publisher_class=Publisher)

    def send(angles_rad: list[float]) -> None:
        try:
            publisher.publish(JointState(position=angles_rad))
        except rclpy_implementation.RCLError as error:
            raise HandError(f"{publisher.topic_name}: {reason_of(error)}") from error

    return CmdLeapBus(hand, send)


class MotorNode(PollingNode):
    """A node that moves a hand; `start_with` is to be called once, after the parameters are declared."""

    def start_with(self, settings: MotorSettings, behaviour: Behaviour | None, torque_off: str, moved_by: str) -> None:
        """Make the loop and everything that shows it.

        Parameters
        ----------
        settings : MotorSettings
        behaviour : Behaviour or None
            Says where the joints go; None: `HandLoop.command` does.
        torque_off : str
            Name of the service that switches the torque off.
        moved_by : str
            Topic by which the hand is moved, which one node is meant to publish.
        """
        keep_system_clock(self, "it moves a hand, which knows nothing of simulated time")
        self.settings = settings
        self.hand = hand_description(settings.hand)
        self._states = JointState()
        self._states.header.frame_id = settings.frame_of(self.hand)
        self._states.name = self.hand.names
        self._publisher = self.create_publisher(JointState, "joint_states", STATE, publisher_class=TolerantPublisher)
        bus = make_bus(self, self.hand, settings)
        # The first angles that a new node sends open the hand, and what it holds then falls: that has to be asked for.
        config = replace(settings, autostart=False) if settings.interface == _CMD_LEAP else settings
        self.loop = HandLoop(self.hand, bus, config, log_of(self), self._on_reading, behaviour)
        self.stalls = Stalls(self)
        asks = {"~/enable": self._ask_enable, f"~/{torque_off}": self._ask_release}
        self.torque_services = TorqueServices(self, asks)
        # Nothing else keeps a second program from the motors there.
        only = [moved_by, _CMD_LEAP] if settings.interface == _CMD_LEAP else [moved_by]
        self.diagnostics = DiagnosticsReporter(self, settings.port, self.report, only_publishers=only)

    def begin(self) -> None:
        """Start the loop, and with `autostart` the motors."""
        enter_realtime(self.settings, self.get_name(), log_of(self))
        self.stalls.begin()
        self.loop.launch()

    def close(self) -> None:
        """Release the hand in order."""
        self.loop.close()
        self.torque_services.serve()  # who still waits for an answer

    def report(self) -> Report:
        """What the diagnostics say of the motors."""
        status = self.loop.status
        values: dict[str, object] = {
            "state": status.phase.name,
            "cycles": status.cycles,
            "late_cycles": status.late,
            "unanswered": status.unanswered,
            "recovered": status.recovered,
        }
        level, words = _LEVELS.get(status.phase, OK), f"{status.phase.words}: {status.reason}"
        if self.settings.interface == _CMD_LEAP:
            # What is told as read is what was sent: no heat, no current, and no torque that were off.
            if status.phase in (HandPhase.RELEASED, HandPhase.GIVEN_UP):
                words = f"{words}; {TORQUE_STAYS}"
            # ROS counts for a name as it is given, without what a launch file remaps.
            topic = self.resolve_topic_name(_CMD_LEAP)
            if not self.count_subscribers(topic):
                level = max(level, WARN)
                words = f"nobody takes {topic}: start the LEAP team's node; {words}"
        elif status.reading is not None:
            values["hottest_c"] = max(status.reading.temperature_c)
            values["largest_current_ma"] = max(map(abs, status.reading.current_ma))
        return level, words, values

    def why_still(self, *, to_move: bool = True) -> str:
        """Why the hand cannot move now, and, if it is meant `to_move`, what to do; empty where it can."""
        status = self.loop.status
        if status.phase is HandPhase.ENABLED:
            goes_off = to_move and not self.loop.is_torque_wanted
            return "the torque is about to go off, as was asked for before; call enable" if goes_off else ""
        state = "not connected" if status.phase is HandPhase.CONNECTING else status.phase.words
        advice = "; call enable" if to_move and status.phase is HandPhase.RELEASED else ""
        if self.loop.is_torque_wanted:
            advice = "; as soon as it can, its torque comes on and its joints stand still, unless that is switched off"
        return f"the hand is {state}: {status.reason}{advice}"

    def _on_reading(self, reading: HandReading) -> None:
        # From the loop's thread.
        message = self._states
        message.header.stamp = self.get_clock().now().to_msg()
        message.position = list(reading.q_rad)
        message.velocity = list(reading.qd_rad_s)
        message.effort = list(reading.current_ma)
        self._publisher.publish(message)

    def _ask_enable(self) -> PendingAnswer:
        objection = self.stalls.objection()
        return PendingAnswer.known(objection) if objection else self.loop.ask_enable()

    def _ask_release(self) -> PendingAnswer:
        pending = self.loop.ask_release()
        return pending.told_as(TORQUE_STAYS) if self.settings.interface == _CMD_LEAP else pending
