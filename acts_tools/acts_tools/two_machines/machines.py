# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Run programs on two machines, and change the conditions of their cable."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from acts_core.errors import LaunchError
from acts_tools.running.child import child
from acts_tools.two_machines.conditions import Conditions, Traffic

_TOOLS = {"ip": "iproute2", "mount": "mount", "nsenter": "util-linux", "unshare": "util-linux"}
_STOP_TIMEOUT_S = 20.0


class TwoMachines:
    """Two machines, of which the near one has the board, and their cable.

    Parameters
    ----------
    cable : subprocess.Popen
        The process of `acts_tools.two_machines.cable`.
    pids : sequence of int
        Process ids in the machines' namespaces.
    """

    def __init__(self, cable: subprocess.Popen[str], pids: Sequence[int]) -> None:
        self._cable = cable
        self._conditions = Conditions()
        self.near, self.far = (Machine(pid) for pid in pids)

    def set_conditions(self, conditions: Conditions) -> None:
        """Change the conditions of the cable."""
        self._conditions = conditions
        self._ask()

    def traffic(self) -> tuple[Traffic, Traffic]:
        """Traffic that the near and the far machine have sent so far."""
        return self._ask()

    def _ask(self) -> tuple[Traffic, Traffic]:
        assert self._cable.stdin is not None
        assert self._cable.stdout is not None
        self._cable.stdin.write(json.dumps(asdict(self._conditions)) + "\n")
        self._cable.stdin.flush()
        near, far = json.loads(self._cable.stdout.readline())
        return Traffic(**near), Traffic(**far)


@dataclass(frozen=True)
class Machine:
    """One of the two machines.

    Attributes
    ----------
    pid : int
        Id of a process in its namespaces.
    """

    pid: int

    def command(self, words: Sequence[str]) -> list[str]:
        """The command line that runs a program there by exec, so that the process id is that of the program."""
        user = [] if os.geteuid() == 0 else ["--user", "--preserve-credentials"]
        return ["nsenter", "--target", str(self.pid), *user, "--net", "--mount", "--", *words]

    def environment(self, domain_id: int) -> dict[str, str]:
        """Environment for programs there to find those of the other machine."""
        return {
            **os.environ,
            "ROS_DOMAIN_ID": str(domain_id),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",
            "PYTHONUNBUFFERED": "1",
        }

    @contextmanager
    def running(
        self, words: Sequence[str], domain_id: int, log: Path, variables: Mapping[str, str] = MappingProxyType({})
    ) -> Iterator[subprocess.Popen[bytes]]:
        """Run a program there for the length of a block, with additional environment variables and output to a file."""
        with (
            log.open("wb") as output,
            child(
                self.command(words),
                stop_timeout_s=_STOP_TIMEOUT_S,
                env={"ROS_LOG_DIR": str(log.parent), **self.environment(domain_id), **variables},
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
            ) as process,
        ):
            yield process


@contextmanager
def two_machines() -> Iterator[TwoMachines]:
    """Make two machines for the length of a block.

    Raises
    ------
    LaunchError
        When the system does not allow them; the message says what is needed.
    """
    packages = sorted({package for tool, package in _TOOLS.items() if shutil.which(tool) is None})
    if packages:
        raise LaunchError(f"two machines in namespaces need a tool: sudo apt-get install {' '.join(packages)}")
    command = [sys.executable, "-m", "acts_tools.two_machines.cable"]
    if os.geteuid() != 0:
        command = ["unshare", "--user", "--map-root-user", *command]
    with child(
        command, stop_timeout_s=_STOP_TIMEOUT_S, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as cable:
        assert cable.stdout is not None
        line = cable.stdout.readline()
        start: dict[str, Any] = json.loads(line) if line else {"error": "the process of the cable ended at once"}
        if "error" in start:
            raise LaunchError(
                f"two machines in namespaces are not allowed here ({start['error']}). Run as root; a container needs "
                "`docker run --cap-add NET_ADMIN --cap-add SYS_ADMIN --security-opt apparmor=unconfined "
                "--device /dev/net/tun`"
            )
        yield TwoMachines(cable, start["pids"])
