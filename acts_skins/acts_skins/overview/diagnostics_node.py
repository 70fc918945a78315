# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `skin_diagnostics`: aggregates what the nodes of all skins publish on /diagnostics."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from acts_core.settings import setting, validate
from acts_ros.clocks import steady_timer
from acts_ros.parameters import declare, node_options
from acts_ros.publishers import TolerantPublisher
from acts_skins.overview.aggregate import Aggregate, Status
from acts_skins.skins_file import skins_of

_PERIOD_S = 1.0
_DEPTH = 100


@dataclass(frozen=True)
class SkinDiagnosticsSettings:
    """Parameters of the node."""

    skins_file: str = setting("", "YAML file that describes the skins; needed")
    stale_after_s: float = setting(
        3.0, "a node whose last status is older than this is stale [s]", minimum=1.0, maximum=60.0
    )

    def __post_init__(self) -> None:
        validate(self)


class SkinDiagnosticsNode(Node):
    """Subscribes ``/diagnostics``; publishes ``/diagnostics_agg`` and ``/diagnostics_toplevel_state`` once a second."""

    def __init__(self, **options: Any) -> None:
        super().__init__("skin_diagnostics", **node_options(), **options)
        settings = declare(self, SkinDiagnosticsSettings)
        names = [skin.name for skin in skins_of(settings.skins_file).skins]
        namespace = self.get_namespace().strip("/")
        self._aggregate = Aggregate(names, f"{namespace}/" if namespace else "", stale_after_s=settings.stale_after_s)
        self._array_publisher = self.create_publisher(
            DiagnosticArray, "/diagnostics_agg", 10, publisher_class=TolerantPublisher
        )
        self._state_publisher = self.create_publisher(
            DiagnosticStatus, "/diagnostics_toplevel_state", 10, publisher_class=TolerantPublisher
        )
        self.create_subscription(DiagnosticArray, "/diagnostics", self._take, _DEPTH)
        steady_timer(self, _PERIOD_S, self._publish)

    def _take(self, array: DiagnosticArray) -> None:
        now_s = time.monotonic()
        for message in array.status:
            self._aggregate.take(status_of(message), now_s)

    def _publish(self) -> None:
        messages = [_message(status) for status in self._aggregate.step(time.monotonic())]
        array = DiagnosticArray(status=messages)
        array.header.stamp = self.get_clock().now().to_msg()
        self._array_publisher.publish(array)
        whole = messages[0]
        self._state_publisher.publish(
            DiagnosticStatus(name="toplevel_state", level=whole.level, message=whole.message, values=whole.values)
        )


def status_of(message: DiagnosticStatus) -> Status:
    """Convert a status from its message."""
    values = {value.key: value.value for value in message.values}
    return Status(message.name, int.from_bytes(message.level, "little"), message.message, message.hardware_id, values)


def _message(status: Status) -> DiagnosticStatus:
    return DiagnosticStatus(
        name=status.name,
        level=bytes([status.level]),
        message=status.message,
        hardware_id=status.hardware_id,
        values=[KeyValue(key=key, value=value) for key, value in status.values.items()],
    )
