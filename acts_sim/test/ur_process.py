# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests of the simulated UR5e share: the simulator as a process, and its hooks."""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

HOOK_PORT = 30100
DASHBOARD_PORT = 29999
CLIENTS = Path(__file__).with_name("ur_clients.py")
START_TIMEOUT_S = 20.0


class Simulator:
    """A simulated controller in a process of its own."""

    def __init__(self, host: str, *arguments: str) -> None:
        self.host = host
        self.arguments = arguments
        # A file, not a pipe: nobody reads it while the process runs. Closed in `stop`.
        self.errors = tempfile.TemporaryFile()  # noqa: SIM115
        self.process = self._start()

    def _start(self) -> subprocess.Popen[str]:
        command = [
            sys.executable,
            "-m",
            "acts_ros.executables.program",
            "acts_sim.ur.main",
            "--host",
            self.host,
            "--hook-port",
            str(HOOK_PORT),
        ]
        process = subprocess.Popen(
            [*command, *self.arguments], stdout=subprocess.PIPE, stderr=self.errors, text=True, env=dict(os.environ)
        )
        assert process.stdout is not None
        readable, _, _ = select.select([process.stdout], [], [], START_TIMEOUT_S)
        line = process.stdout.readline() if readable else ""
        if line != "ready\n":
            process.kill()
            process.wait()
            raise AssertionError(f"the simulator did not start: {line!r}, {self.error_text()}")
        return process

    def error_text(self) -> str:
        # Without a seek: that would move the place where the process goes on to write.
        file = self.errors.fileno()
        return os.pread(file, os.fstat(file).st_size, 0).decode()

    def hook(self, line: str) -> str:
        with socket.create_connection((self.host, HOOK_PORT), timeout=10.0) as connection:
            connection.sendall(line.encode() + b"\n")
            return connection.makefile("r").readline().strip()

    def make_idle(self) -> None:
        """No stop and no program is left from an earlier client."""
        self.hook("clear")
        with socket.create_connection((self.host, DASHBOARD_PORT), timeout=10.0) as connection:
            connection.sendall(b"stop\n")
            answers = connection.makefile("r")
            assert answers.readline().startswith("Connected")
            assert answers.readline() == "Stopped\n"

    def state(self) -> dict[str, Any]:
        return dict(json.loads(self.hook("state")))

    def client(self, scenario: str, *arguments: str, timeout_s: float = 40.0) -> dict[str, Any]:
        """Run a scenario of `ur_clients` to its end; what it has found out."""
        client = self.start_client(scenario, *arguments)
        try:
            output, errors = client.communicate(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            client.kill()
            output, errors = client.communicate()
            raise AssertionError(f"{scenario} did not end: {output} {errors} {self.error_text()}") from None
        assert client.returncode == 0, f"{scenario}: {output} {errors} {self.error_text()}"
        return dict(json.loads(output.splitlines()[-1]))

    def start_client(self, scenario: str, *arguments: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, str(CLIENTS), scenario, self.host, *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def start_again(self) -> None:
        assert self.process.stdout is not None
        self.process.stdout.close()
        self.process = self._start()

    def stop(self, number: signal.Signals = signal.SIGTERM) -> int:
        self.process.send_signal(number)
        try:
            return self.process.wait(timeout=10.0)
        finally:
            if self.process.poll() is None:
                self.process.kill()
                self.process.wait()
            assert self.process.stdout is not None
            self.process.stdout.close()
            self.errors.close()

    def __enter__(self) -> Simulator:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stop()


def wait_for(condition: Callable[[], bool], what: str, timeout_s: float = 15.0) -> None:
    """Poll until a condition holds."""
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {timeout_s} s in vain for: {what}")
        time.sleep(0.005)
