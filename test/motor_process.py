# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process with the simulated motors of a hand."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

from acts_sim.dynamixel import ControlClient


class MotorProcess:
    """The process, its port and its control socket.

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

    def command(self, line: str) -> str:
        """The answer to a line for the control socket."""
        with ControlClient(self.control) as client:
            return client.ask(line)

    def close(self) -> None:
        """End the process, which succeeds."""
        self.process.send_signal(signal.SIGINT)
        assert self.process.wait(20.0) == 0
