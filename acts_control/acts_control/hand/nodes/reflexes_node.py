# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `hand_reflexes`: what the hand's skin feels in, the motors' bus out; it opens, grasps, holds and avoids.

Topics: regions in; joint_states, hand/status and hand/timing out. Services: ~/grasp, ~/release, ~/stop; ~/enable and
~/disable for the torque.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from std_srvs.srv import Trigger

from acts_control.hand.control import (
    HandPhase,
    HandSupervisor,
    SupervisorConfig,
    SupervisorStatus,
    no_touch,
)
from acts_control.hand.description import HandKinematics, hand_description
from acts_control.hand.motors import MOTORS, HandReading, with_motors
from acts_control.hand.nodes.cycle_times import CycleTimes
from acts_control.hand.nodes.motor_node import MotorNode, MotorSettings
from acts_control.hand.nodes.torque_services import answered
from acts_control.hand.reflexes import REFLEXES, HandState, make_reflexes, with_reflexes
from acts_control.loop_rate import steady_s
from acts_core.errors import PacketError
from acts_core.settings import setting
from acts_core.stop_signals import StopSignals
from acts_msgs.msg import HandStatus, HandTiming, RegionContacts
from acts_ros.clocks import steady_timer
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import OK, WARN, Report
from acts_ros.log import STEADY, LoggedChanges
from acts_ros.messages import RegionsFields, read_regions, set_stamp
from acts_ros.parameters import declare, node_options
from acts_ros.polled import PolledSubscription
from acts_ros.publishers import TolerantPublisher
from acts_ros.qos import STATE, STREAM

_LONG_AGO_S = 1e6
# Touch that has come since the last cycle: the newest that can be used counts, the others are dropped.
_TOUCH_DEPTH = 64
# So many of the newest are tried: more would hold the loop up.
_TOUCH_TRIES = 16
# Of so many patches as a layout may have, each with names as long as they may be.
_TOUCH_BYTES_MAX = 16384
_TIMING_PERIOD_S = 1.0


@dataclass(frozen=True)
class _OwnSettings(SupervisorConfig, MotorSettings):
    """Parameters of the node."""

    rate_hz: float = setting(250.0, "how often the hand is read and moved [Hz]", minimum=10.0, maximum=500.0)
    max_speed_rad_s: float = setting(12.0, "fastest that a joint's goal moves [rad/s]", minimum=0.01, maximum=30.0)
    reflexes: str = setting(
        "sharp slip sphere",
        f"which act, with blanks between: {', '.join(REFLEXES)}; none: the hand grasps and holds, no more",
    )
    status_rate_hz: float = setting(50.0, "how often the status is published [Hz]", minimum=1.0, maximum=500.0)

    def __post_init__(self) -> None:
        MotorSettings.__post_init__(self)
        SupervisorConfig.__post_init__(self)
        if self.interface in MOTORS:
            config: Any = MOTORS[self.interface].config
            config.check_grip_current(self, self.max_grip_current_ma)


def settings_class() -> type:
    """The node's own parameters, those of every make of motors, and those of every reflex there is."""
    return with_reflexes(with_motors(_OwnSettings))


HandReflexesSettings = settings_class()


def regions_in(data: bytes) -> RegionsFields:
    """The regions of a message.

    Raises
    ------
    PacketError
        When it is none, or longer than one of a hand can be: reading it would hold the hand up.
    """
    if len(data) > _TOUCH_BYTES_MAX:
        raise PacketError(f"regions of {len(data)} bytes: at most {_TOUCH_BYTES_MAX} are read")
    return read_regions(data)


class TouchedHand:
    """A supervisor that takes the newest touch at each cycle of the hand's loop, from the loop's own thread.

    Attributes
    ----------
    times : CycleTimes
    """

    def __init__(
        self,
        supervisor: HandSupervisor,
        regions: PolledSubscription[bytes],
        now_ns: Callable[[], int],
        on_change: Callable[[], None],
    ) -> None:
        self.times = CycleTimes()
        self._supervisor = supervisor
        self._regions = regions
        self._now_ns = now_ns
        self._on_change = on_change
        self._touched_ns: int | None = None

    def restart(self, *, recovered: bool) -> None:
        """See `acts_control.hand.control.Behaviour`."""
        self._supervisor.restart(recovered=recovered)

    def step(self, reading: HandReading, goal_rad: Sequence[float], now_s: float, dt_s: float) -> Sequence[float]:
        """See `acts_control.hand.control.Behaviour`."""
        self._take(now_s)
        before = self._supervisor.status
        goals = [float(angle) for angle in self._supervisor.step(reading, goal_rad, now_s, dt_s)]
        status = self._supervisor.status
        if (status.state, status.events) != (before.state, before.events):
            self._on_change()
        return goals

    def waited(self, seconds: float) -> None:
        """See `acts_control.hand.control.Behaviour`."""
        self._supervisor.waited(seconds)

    def watch(self, now_s: float) -> None:
        """Take touch while the torque is off, so that it is known how old it is; from the loop's own thread."""
        self._take(now_s)
        self._supervisor.watch(now_s)

    def _take(self, now_s: float) -> None:
        """Hand the newest touch that can be used to the supervisor."""
        taken = self._regions.take_all()[-_TOUCH_TRIES:]
        self._touched_ns = None
        while taken and not self._feel(taken.pop()[0], now_s):
            pass

    def _feel(self, data: bytes, now_s: float) -> bool:
        """Whether the supervisor can use a message."""
        try:
            touch = regions_in(data)
        except PacketError as error:
            return self._supervisor.refuse(str(error))
        stamp_s = now_s - 1e-9 * (self._now_ns() - touch.stamp_ns)
        can_be_used = self._supervisor.touch(touch.regions, stamp_s, now_s)
        self._touched_ns = touch.stamp_ns if can_be_used else None
        return can_be_used

    def sent(self, began_s: float, sent_s: float) -> None:
        """See `acts_control.hand.control.Behaviour`."""
        latency_s = None if self._touched_ns is None else 1e-9 * (self._now_ns() - self._touched_ns)
        self.times.add(sent_s - began_s, latency_s)


class HandReflexesNode(MotorNode):
    """Hands touch to the supervisor in the hand's loop, and publishes what it does."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__("hand_reflexes", **node_options(), **node_arguments)
        settings: Any = declare(self, HandReflexesSettings)
        reflexes = make_reflexes(settings.reflexes, settings)
        hand = hand_description(settings.hand)
        self._supervisor = HandSupervisor(HandKinematics(hand), reflexes, settings)
        self._status_lock = threading.Lock()
        self._status = HandStatus()
        self._status.header.frame_id = settings.frame_of(hand)
        self._status_publisher = self.create_publisher(
            HandStatus, "hand/status", STATE, publisher_class=TolerantPublisher
        )
        self._timing = HandTiming()
        self._timing.header.frame_id = settings.frame_of(hand)
        self._timing_publisher = self.create_publisher(
            HandTiming, "hand/timing", STATE, publisher_class=TolerantPublisher
        )
        regions = self.create_raw_polled_subscription(RegionContacts, "regions", STREAM, depth=_TOUCH_DEPTH)
        clock = self.get_clock()
        self._touched = TouchedHand(self._supervisor, regions, lambda: clock.now().nanoseconds, self._publish_status)
        self._times, self._timed_s = self._touched.times, time.monotonic()
        self._told = SupervisorStatus()
        self._changes = LoggedChanges(self._told.state, self._told.reason)
        self._unfelt_changes = LoggedChanges("unfelt", "")
        self._reported_refused = 0
        self.start_with(settings, self._touched, "disable", "regions")
        self._supervisor.stood_still = self.stalls.since
        self.create_service(Trigger, "~/grasp", self._on_grasp)
        self.create_service(Trigger, "~/release", self._on_release)
        self.create_service(Trigger, "~/stop", self._on_stop)
        steady_timer(self, 1.0 / settings.status_rate_hz, self._publish_status)
        steady_timer(self, _TIMING_PERIOD_S, self._publish_timing)

    def report(self) -> Report:
        """What the diagnostics say: of the motors, and of what the hand does."""
        level, words, values = super().report()
        status = self._present()
        hand = {
            "hand": status.state.name,
            "hand_reason": status.reason,
            "touch_age_ms": 1e3 * min(status.touch_age_s, _LONG_AGO_S),
            "refused": status.refused,
            **{f"{name}_events": count for name, count in status.events.items()},
        }
        refused, self._reported_refused = status.refused - self._reported_refused, status.refused
        if level == OK and status.is_stale:
            level, words = WARN, f"{no_touch(status.touch_age_s, status.touch_comes_old_s)}; {words}"
        if status.unfelt:
            level, words = max(level, WARN), f"{_says_nothing(status.unfelt)}; {words}"
        if refused:
            level, words = max(level, WARN), f"messages left out: {refused}, the last: {status.refusal}; {words}"
        return level, words, {**values, **hand}

    def _on_reading(self, reading: HandReading) -> None:
        super()._on_reading(reading)
        if self.loop.status.phase is not HandPhase.ENABLED:
            self._touched.watch(steady_s())

    def _on_grasp(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.torque_services.serve()  # what was asked for before this
        objection = self.stalls.objection() or self._why_not() or self._supervisor.grasp()
        return answered(response, objection, self._begun("the hand closes until it grips something"))

    def _on_release(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.torque_services.serve()
        return answered(response, self._why_not() or self._supervisor.release(), self._begun("the hand opens"))

    def _on_stop(self, _request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        # Who stops a hand whose torque is about to come on does not expect that it comes on afterwards.
        self.torque_services.serve()
        if self.loop.cancel_enable():
            return answered(response, "", "the torque stays off")
        objection = self._why_not(to_move=False) or self._supervisor.stop()
        return answered(response, objection, self._begun("the hand stands still, its torque on"))

    def _why_not(self, *, to_move: bool = True) -> str:
        """Why nothing can be asked of the hand; while a motor is started anew, what is asked for is done after that."""
        return "" if self._is_recovering() else self.why_still(to_move=to_move)

    def _begun(self, what: str) -> str:
        return f"{what}, once its motors are started anew" if self._is_recovering() else what

    def _is_recovering(self) -> bool:
        return self.loop.status.phase is HandPhase.RECOVERING

    def _present(self) -> SupervisorStatus:
        """What the hand is about: without torque nothing, whatever it was about when it had some."""
        status, loop = self._supervisor.status, self.loop.status
        if loop.phase is HandPhase.ENABLED:
            return status
        reason = f"the hand is {loop.phase.words}: {loop.reason}"
        return replace(status, state=HandState.STOPPED, reason=reason, active=())

    def _publish_status(self) -> None:
        # By the timer, and at once by the hand's loop where a reflex has been set off or the state has changed.
        with self._status_lock:
            self._send_status()

    def _send_status(self) -> None:
        status, loop, message = self._present(), self.loop.status, self._status
        if self._changes.is_due(status.state, status.reason):
            self.get_logger().info(f"{status.state.name.lower()}: {status.reason}")
        if status.refused > self._told.refused:
            self.get_logger().warning(
                f"left out: {status.refusal}", throttle_duration_sec=5.0, throttle_time_source_type=STEADY
            )
        unfelt = _says_nothing(status.unfelt) if status.unfelt else ""
        if self._unfelt_changes.is_due("unfelt", unfelt) and unfelt:
            self.get_logger().warning(unfelt)
        self._told = status
        set_stamp(message.header.stamp, self.get_clock().now().nanoseconds)
        message.state = int(status.state)
        message.reason = status.reason
        message.active = list(status.active)
        message.reflexes = list(status.events)
        message.events = list(status.events.values())
        message.touch_age = min(status.touch_age_s, _LONG_AGO_S)
        message.goals = list(loop.goal_rad)
        message.steps = status.steps
        message.late_steps = loop.late
        self._status_publisher.publish(message)

    def _publish_timing(self) -> None:
        message = self._timing
        before_s, self._timed_s = self._timed_s, time.monotonic()
        message.durations, message.latencies = self._times.take()
        if not message.durations:
            return
        set_stamp(message.header.stamp, self.get_clock().now().nanoseconds)
        message.interval = self._timed_s - before_s
        message.cycles = self._times.cycles
        self._timing_publisher.publish(message)


def _says_nothing(unfelt: Sequence[str]) -> str:
    return (
        f"touch says nothing of {', '.join(unfelt)}: the hand feels nothing there; does the layout name these patches, "
        "and has each of them a taxel that is not dead?"
    )


SETTINGS: dict[str, type] = {"hand_reflexes": HandReflexesSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    return run_nodes({"hand_reflexes": HandReflexesNode}, SETTINGS, signals, args)
