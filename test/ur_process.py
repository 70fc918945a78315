# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated UR5e as a process."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
from typing import Any

from child_process import Process
from waiting import wait_for

HOOK_PORT, DASHBOARD_PORT = 30100, 29999


def hook(host: str, line: str) -> str:
    """Do what a person at the robot could do."""
    with socket.create_connection((host, HOOK_PORT), timeout=10.0) as connection:
        connection.sendall(line.encode() + b"\n")
        return connection.makefile("r").readline().strip()


class UrProcess(Process):
    """A simulated UR5e that listens at an address of its own.

    Parameters
    ----------
    host : str
    options : str
        More of the program's options.
    """

    def __init__(self, host: str, *options: str) -> None:
        self.host = host
        program = (sys.executable, "-m", "acts_ros.executables.program", "acts_sim.ur.main")
        super().__init__(*program, "--host", host, "--hook-port", str(HOOK_PORT), *options)

    def _start(self) -> subprocess.Popen[str]:
        # What an earlier run has written does not count.
        self.output.seek(0)
        self.output.truncate()
        self.process = super()._start()
        try:
            wait_for(lambda: self._is_ready() or self.process.poll() is not None, "the simulated robot")
            assert self._is_ready()
            assert self.process.poll() is None
        except AssertionError as error:
            self.stop(signal.SIGKILL)
            raise AssertionError(f"{error}: {self.text()!r}") from error
        return self.process

    def _is_ready(self) -> bool:
        return "ready" in self.text().splitlines()

    def hook(self, line: str) -> str:
        """Do what a person at the robot could do."""
        return hook(self.host, line)

    def ask_dashboard(self, line: str) -> str:
        """Do what a person does at the robot's panel; what it answers."""
        with socket.create_connection((self.host, DASHBOARD_PORT), timeout=10.0) as connection:
            lines = connection.makefile("rw")
            assert lines.readline().startswith("Connected")
            lines.write(line + "\n")
            lines.flush()
            return lines.readline().strip()

    def state(self) -> dict[str, Any]:
        """Joint angles, program, safety."""
        return dict(json.loads(self.hook("state")))

    def orders(self) -> list[tuple[float, str, str]]:
        """What clients have told it to do: the robot's time [s], the port, and what."""
        return [tuple(order) for order in json.loads(self.hook("orders"))]
