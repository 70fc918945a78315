# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process with the simulated motors of a hand, and the real `dynamixel_sdk` on their port; for the tests."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

from dynamixel_sdk import PacketHandler, PortHandler, port_handler

from acts_sim.dynamixel import ControlClient

IDS = list(range(16))


class MotorBus:
    """The process, and the port as a user opens it.

    Parameters
    ----------
    folder : Path
        For the port and the control socket.
    module : str
        The program.
    options : str
        More of its options.
    """

    def __init__(self, folder: Path, module: str, *options: str) -> None:
        self.link, self.control = folder / "hand", folder / "control"
        self.process = subprocess.Popen(
            [
                *(sys.executable, "-m", "acts_ros.executables.program", module),
                *("--link", str(self.link), "--control", str(self.control), *options),
            ],
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        self.ready = json.loads(self.process.stdout.readline())
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

    def command(self, line: str) -> str:
        """The answer to a line for the control socket."""
        with ControlClient(self.control) as client:
            return client.ask(line)

    def close(self) -> None:
        """End the process, which succeeds."""
        self.port.closePort()
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(20.0) == 0
