# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A program whose output nobody wants. No node is made, so no ROS_DOMAIN_ID is used."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0
NODE = """
import os, sys
import rclpy
from acts_ros.executor import make_executor

def main(signals):
    rclpy.init()
    make_executor()
    print("told")
    print("told", file=sys.stderr, flush=True)
    with open("told.txt", "w") as file:
        print(file.fileno(), [os.readlink(f"/proc/self/fd/{number}") for number in (1, 2)], file=file)
    return 0
"""


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-", "<&- >&- 2>&-"])
def test_a_program_works_where_nobody_listens(closed: str, tmp_path: Path) -> None:
    (tmp_path / "silent_node.py").write_text(NODE)
    command = shlex.join([sys.executable, "-m", "acts_ros.executables.program", "silent_node"])
    path = os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")])
    environment = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run(
        ["sh", "-c", f"{command} {closed}"], cwd=tmp_path, env=environment, capture_output=True, timeout=DEADLINE_S
    )
    assert done.returncode == 0, done.stderr.decode()
    number, _, streams = (tmp_path / "told.txt").read_text().partition(" ")
    # Nothing that is opened later stands in their place.
    assert int(number) > 2
    assert streams.count("/dev/null") == closed.replace("<&-", "").count("&-")
