# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests of the simulated UR5e share: the simulator and its clients as processes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import waiting
from ur_process import UrProcess

wait_for = partial(waiting.wait_for, timeout_s=15.0)
CLIENTS = Path(__file__).with_name("ur_clients.py")


class Simulator(UrProcess):
    """A simulated controller that clients use in processes of their own."""

    def make_idle(self) -> None:
        """No stop and no program is left from an earlier client."""
        self.hook("clear")
        assert self.ask_dashboard("stop") == "Stopped"

    def client(self, scenario: str, *arguments: str, timeout_s: float = 40.0) -> dict[str, Any]:
        """Run a scenario of `ur_clients` to its end; what it has found out."""
        client = self.start_client(scenario, *arguments)
        try:
            output, errors = client.communicate(timeout=timeout_s)
        except subprocess.TimeoutExpired:
            client.kill()
            output, errors = client.communicate()
            raise AssertionError(f"{scenario} did not end: {output} {errors} {self.text()}") from None
        assert client.returncode == 0, f"{scenario}: {output} {errors} {self.text()}"
        return dict(json.loads(output.splitlines()[-1]))

    def start_client(self, scenario: str, *arguments: str) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, str(CLIENTS), scenario, self.host, *arguments],
            # The modules that tests share, too.
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def start_again(self) -> None:
        self.process = self._start()
