# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process with the simulated motors of a hand, and the real `dynamixel_sdk` on their port; for the tests."""

from __future__ import annotations

from pathlib import Path

from dynamixel_sdk import PacketHandler, PortHandler, port_handler
from motor_process import MotorProcess

IDS = list(range(16))


class MotorBus(MotorProcess):
    """The process, and the port as a user opens it."""

    def __init__(self, folder: Path, module: str, *options: str) -> None:
        super().__init__(folder, module, *options)
        self.packets = PacketHandler(2.0)
        self.port = self.open()

    def open(self) -> PortHandler:
        """The port, opened once more."""
        # The library waits for an answer for twice this and 2 ms [ms]; as it comes, or as another test has left it in
        # this process, it is too short for a loaded machine.
        port_handler.LATENCY_TIMER = 200
        port = PortHandler(str(self.link))
        assert port.openPort()
        assert port.setBaudRate(4_000_000)
        return port

    def close(self) -> None:
        """End the process, which succeeds."""
        self.port.closePort()
        super().close()
