# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `hand`: joint angles in, the motors' bus out, and what the joints do.

Topics: ~/command in; joint_states out, and cmd_leap where the hand is moved by that. Services: ~/enable, ~/release.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sensor_msgs.msg import JointState

from acts_control.hand.motors import HandError, with_motors
from acts_control.hand.nodes.motor_node import MotorNode, MotorSettings
from acts_core.errors import PacketError
from acts_core.stop_signals import StopSignals
from acts_ros.clocks import Stalls
from acts_ros.composition import run_nodes
from acts_ros.diagnostics import WARN, Report
from acts_ros.log import STEADY
from acts_ros.messages import message_of
from acts_ros.parameters import declare, node_options
from acts_ros.qos import STATE

# Far more than the names and angles of any hand; reading more would hold the hand's loop up.
_COMMAND_BYTES_MAX = 65536

# A shorter pause of the executor may be a long callback.
_SHORTEST_STALL_S = 0.5

HandSettings = with_motors(MotorSettings)
"""Parameters of the node."""


class HandNode(MotorNode):
    """Hands messages to the hand's loop and publishes what it reads."""

    def __init__(self, **node_arguments: Any) -> None:
        super().__init__("hand", **node_options(), **node_arguments)
        self._refused = self._reported_refused = 0
        self._refusal = ""
        settings: Any = declare(self, HandSettings)
        self.start_with(settings, None, "release", "~/command")
        # The loop notices a standstill, too, but not one in the middle of something that takes long.
        self._command_stalls = Stalls(self, max(settings.command_stale_after_s, _SHORTEST_STALL_S))
        self.create_subscription(JointState, "~/command", self._on_command, STATE, raw=True)

    def begin(self) -> None:
        """Start the loop, and with `autostart` the motors."""
        self._command_stalls.begin()
        super().begin()

    def report(self) -> Report:
        """What the diagnostics say: of the motors, and of commands that were left out."""
        level, words, values = super().report()
        refused, self._reported_refused = self._refused - self._reported_refused, self._refused
        if refused:
            level, words = max(level, WARN), f"commands left out: {refused}, the last: {self._refusal}; {words}"
        return level, words, {**values, "refused": self._refused}

    def _on_command(self, data: bytes) -> None:
        if len(data) > _COMMAND_BYTES_MAX:
            self._refuse(f"{len(data)} bytes; at most {_COMMAND_BYTES_MAX} are read")
            return
        try:
            message = message_of(data, JointState)
        except PacketError as error:
            self._refuse(f"it cannot be read: {error}")
            return
        if len(message.name) != len(message.position):
            self._refuse(f"{len(message.name)} names with {len(message.position)} positions")
            return
        angles_rad = dict(zip(message.name, message.position, strict=True))
        if len(angles_rad) < len(message.name):
            twice = next(name for name in message.name if message.name.count(name) > 1)
            self._refuse(f"it names {twice[:64]!r} more than once")
            return
        stood_still = self._command_stalls.objection()
        if stood_still and not self.why_still():
            self._refuse(stood_still)
            return
        try:
            self.loop.command(angles_rad)
        except HandError as error:
            self._refuse(str(error))
            return
        objection = self.why_still()
        if objection:
            self._refuse(objection)

    def _refuse(self, why: str) -> None:
        self._refused += 1
        self._refusal = why
        self.get_logger().error(
            f"a command was left out: {why}", throttle_duration_sec=1.0, throttle_time_source_type=STEADY
        )


SETTINGS: dict[str, type] = {"hand": HandSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    return run_nodes({"hand": HandNode}, SETTINGS, signals, args)
