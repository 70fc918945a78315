# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `gait`: contacts of two insoles in, steps and gait out.

Topics: LEFT/contact and RIGHT/contact in; steps and gait out.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from acts_core.errors import PacketError, SettingsError
from acts_core.names import ALLOWED, is_full_name
from acts_core.runtime import NS_PER_S
from acts_core.settings import setting
from acts_core.stop_signals import StopSignals
from acts_core.words import counted
from acts_msgs.msg import Contact, FootStep
from acts_msgs.msg import Gait as GaitMessage
from acts_recon.gait import FEET, Gait, GaitConfig, GaitTracker, Step
from acts_ros import qos
from acts_ros.clocks import steady_timer
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import OK, WARN, DiagnosticsReporter, Report
from acts_ros.messages import ContactFields, read_contact, set_stamp
from acts_ros.parameters import declare, node_options
from acts_ros.polled import PollingNode
from acts_ros.publishers import published

_PERIOD_S = 0.02
# At 1 kHz: how long the node may be held up before contacts are lost [ms].
_CONTACTS = 256


@dataclass(frozen=True)
class GaitSettings(GaitConfig):
    """Parameters of the node."""

    left: str = setting("left_sole", "namespace of the left insole; empty: none")
    right: str = setting("right_sole", "namespace of the right insole; empty: none")

    def __post_init__(self) -> None:
        super().__post_init__()
        # In the root namespace `sole` is `/sole`.
        if self.left.removeprefix("/") == self.right.removeprefix("/"):
            raise SettingsError(
                f"left = {self.left!r}, right = {self.right!r}: needed are the namespaces of two insoles, or of one"
            )
        for name in filter(None, (self.left, self.right)):
            if not is_full_name(f"/{name.removeprefix('/')}"):
                raise SettingsError(
                    f"left, right: {name!r} is no namespace: allowed are {ALLOWED}, parts with / between"
                )


class GaitNode(PollingNode):
    """Connects topics with `GaitTracker`.

    Reads contacts fifty times a second, and publishes ``steps`` (acts_msgs/FootStep) and ``gait`` (acts_msgs/Gait) when
    a step is over.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("gait", **node_options(), **options)
        settings = declare(self, GaitSettings)
        self._tracker = GaitTracker(settings)
        self._contacts = {
            foot: self.create_raw_polled_subscription(Contact, f"{name}/contact", qos.STREAM, depth=_CONTACTS)
            for foot, name in enumerate((settings.left, settings.right))
            if name
        }
        self._steps_publisher = self.create_publisher(FootStep, "steps", **published(qos.STATE))
        self._gait_publisher = self.create_publisher(GaitMessage, "gait", **published(qos.STATE))
        # Seconds since the first stamp: times of a step are differences of small numbers.
        self._first_ns: int | None = None
        self._received = dict.fromkeys(self._contacts, 0)
        self._reported = dict(self._received)
        self._steps = [0, 0]
        self._refused = 0
        steady_timer(self, _PERIOD_S, self.update)
        topics = [contacts.topic_name for contacts in self._contacts.values()]
        self._diagnostics = DiagnosticsReporter(self, ", ".join(topics), self._report, only_publishers=topics)

    def update(self) -> None:
        """Take in the contacts that have arrived, and publish the steps that are over."""
        for foot, contacts in self._contacts.items():
            for data, _ in contacts.take_all():
                try:
                    contact = read_contact(data)
                except PacketError:
                    self._refused += 1
                else:
                    self._take(foot, contact)

    def _take(self, foot: int, contact: ContactFields) -> None:
        self._received[foot] += 1
        if self._first_ns is None:
            self._first_ns = contact.stamp_ns
        time_s = (contact.stamp_ns - self._first_ns) / NS_PER_S
        for step in self._tracker.step(foot, time_s, contact.force_n, contact.x_m, contact.y_m):
            self._steps[foot] += 1
            self._steps_publisher.publish(self._step_message(foot, contact, step))
            self._gait_publisher.publish(_gait_message(contact.stamp_ns, self._tracker.gait()))

    def _step_message(self, foot: int, contact: ContactFields, step: Step) -> FootStep:
        first_ns = self._first_ns or 0
        message = FootStep(foot=foot)
        message.header.frame_id = contact.frame_id
        set_stamp(message.header.stamp, contact.stamp_ns)
        set_stamp(message.strike, first_ns + round(step.strike_s * NS_PER_S))
        set_stamp(message.toe_off, first_ns + round(step.toe_off_s * NS_PER_S))
        message.strike_sigma, message.toe_off_sigma = step.strike_sd_s, step.toe_off_sd_s
        message.stance, message.swing = step.stance_s, step.swing_s or 0.0
        message.peak_force = step.peak_force
        message.time = array("f", step.time_s - step.strike_s)
        message.force, message.path_x, message.path_y = (array("f", v) for v in (step.force, step.x_m, step.y_m))
        return message

    def _report(self) -> Report:
        values: dict[str, object] = {"refused": self._refused}
        silent = []
        for foot, received in self._received.items():
            values[f"{FEET[foot]}.contacts"] = received
            values[f"{FEET[foot]}.steps"] = self._steps[foot]
            loads = self._tracker.loads[foot]
            values[f"{FEET[foot]}.load"] = loads.span if loads is not None else "not learnt"
            if received == self._reported[foot]:
                silent.append(self._contacts[foot].topic_name)
        self._reported = dict(self._received)
        if silent:
            return WARN, f"no contacts on {', '.join(silent)}", values
        return OK, counted(sum(self._steps), "step"), values


def _gait_message(stamp_ns: int, gait: Gait) -> GaitMessage:
    message = GaitMessage()
    set_stamp(message.header.stamp, stamp_ns)
    message.cadence, message.double_support = gait.cadence_per_min or 0.0, gait.double_support or 0.0
    message.steps = [foot.steps for foot in gait.feet]
    message.stride = [foot.stride_s or 0.0 for foot in gait.feet]
    message.stance = [foot.stance_s or 0.0 for foot in gait.feet]
    message.swing = [foot.swing_s or 0.0 for foot in gait.feet]
    message.peak_force = [foot.peak_force or 0.0 for foot in gait.feet]
    message.progress = [foot.progress_m or 0.0 for foot in gait.feet]
    message.stance_asymmetry = gait.asymmetry("stance_s") or 0.0
    message.swing_asymmetry = gait.asymmetry("swing_s") or 0.0
    message.peak_force_asymmetry = gait.asymmetry("peak_force") or 0.0
    return message


SETTINGS: dict[str, type] = {"gait": GaitSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    return run_nodes({"gait": GaitNode}, SETTINGS, signals, args)
