# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process with the simulated motors of a hand, and the real `dynamixel_sdk` on their port; for the tests."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from dynamixel_sdk import PacketHandler, PortHandler, port_handler
from motor_process import MotorProcess

IDS = list(range(16))

# The library waits for an answer for twice as long, and 2 ms.
_PATIENT_MS, _BRIEF_MS = 5000, 200


class MotorBus(MotorProcess):
    """The process, and the port as a user opens it."""

    def __init__(self, folder: Path, module: str, *options: str) -> None:
        super().__init__(folder, module, *options)
        self.packets = PacketHandler(2.0)
        self.port = self.open()

    def open(self) -> PortHandler:
        """The port, opened once more."""
        # As it comes, or as another test has left it in this process, it is too short for a machine that stands still.
        port_handler.LATENCY_TIMER = _PATIENT_MS
        port = PortHandler(str(self.link))
        assert port.openPort()
        assert port.setBaudRate(4_000_000)
        return port

    @contextmanager
    def without_answers(self) -> Iterator[None]:
        """Within it, no answer is expected: each is waited for 0.4 s only."""
        port_handler.LATENCY_TIMER = _BRIEF_MS
        try:
            yield
        finally:
            port_handler.LATENCY_TIMER = _PATIENT_MS

    def close(self) -> None:
        """End the process, which succeeds."""
        self.port.closePort()
        super().close()
