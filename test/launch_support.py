# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests of launch files share."""

import os
import re
import signal
import time
from pathlib import Path

from ament_index_python.packages import get_package_share_directory

from acts_tools.testing.launch_runner import Launched

PACKAGE = "acts_bringup"
# Numba compiles in the first process that needs a kernel; on a busy machine that takes its time.
START_S = 90.0
LONG_S = 60.0


def pid_of(launched: Launched, name: str) -> int:
    """Process id of a node that was started last, from the launch's own words."""
    found = re.findall(rf"\[{name}(?:-\d+)?\]: process started with pid \[(\d+)\]", launched.output)
    assert found, f"{name} was not started"
    return int(found[-1])


def patient_parameters(folder: Path, touch_stop_after_s: float = 10.0) -> str:
    """The shipped parameters, for a busy machine: late touch or a late robot level the plate but do not end the run."""
    limits = f"{{touch_stop_after_s: {touch_stop_after_s}, robot_stale_after_s: 2.0}}"
    return shipped_parameters_and(folder, "ball_balancing", "/**/ball_control", limits)


def shipped_parameters_and(folder: Path, file: str, node: str, parameters: str) -> str:
    """A params file of ours with more parameters of a node, as YAML in a line; the path of it."""
    path = folder / "patient.yaml"
    shipped = Path(get_package_share_directory("acts_config")) / "params" / f"{file}.yaml"
    path.write_text(f"{shipped.read_text()}\n{node}:\n  ros__parameters: {parameters}\n")
    return str(path)


class Feeling:
    """The process that feels, and the spare one."""

    def __init__(self, launched: Launched) -> None:
        self._launched = launched
        self._ready = 0
        self._name = ""

    def until_a_spare_is_ready(self) -> None:
        """Wait until another process than before says so."""
        self._ready += 1
        self._launched.wait_for(lambda: len(self._spares()) == self._ready, LONG_S, "a spare process")

    def kill(self) -> float:
        """Kill the process that feels; the time of that, as of stamps [s]."""
        names = set(re.findall(r"\[(tactile-\d+)\]: process started", self._launched.output))
        # The first spare is the one that has not felt yet; from then on they take turns.
        name = self._name or names.difference(self._spares()[-1:]).pop()
        self._name = (names - {name} or {name}).pop()
        os.kill(pid_of(self._launched, name), signal.SIGKILL)
        return time.time()

    def _spares(self) -> list[str]:
        return re.findall(r"\[(tactile-\d+)\] ready to take over", self._launched.output)
