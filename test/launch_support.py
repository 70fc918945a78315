# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the tests of launch files share."""

import re
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
