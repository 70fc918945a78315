# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What launch files write on the command line of a node reaches it, the rest is refused; ROS_DOMAIN_ID 224."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix, get_package_share_directory
from launch_support import PACKAGE

from acts_core.errors import REFUSED_EXIT_CODE

pytestmark = pytest.mark.slow

FILES = sorted((Path(get_package_share_directory(PACKAGE)) / "launch").glob("*.launch.xml"))
NODE = re.compile(r'pkg="(\w+)"\s+exec="(\w+)"[^>]*?args="([^"]*)"', re.DOTALL)
# Every node that a launch file starts with `--set`, with the first parameter that it sets there.
SET = sorted(
    {
        (package, executable, found[1])
        for file in FILES
        for package, executable, words in NODE.findall(file.read_text())
        if (found := re.search(r"--set (\w+\.\w+)=", words))
    }
)
DOMAIN_ID = 224


def refused(package: str, executable: str, *words: str) -> str:
    """What a node says that refuses its command line."""
    finished = subprocess.run(
        [str(Path(get_package_prefix(package)) / "lib" / package / executable), *words],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "ROS_DOMAIN_ID": str(DOMAIN_ID)},
    )
    assert finished.returncode == REFUSED_EXIT_CODE, finished.stdout + finished.stderr
    return finished.stderr


def test_the_launch_files_set_parameters_of_these_nodes() -> None:
    assert {executable for _, executable, _ in SET} >= {
        "ball_balancing",
        "ball_control",
        "ball_trajectory",
        "ball_world",
        "driver",
        "hand_reflexes",
        "reconstruction",
        "skin_contacts",
        "skin_overview",
        "tactile",
        "view",
    }


@pytest.mark.parametrize(("package", "executable", "parameter"), SET, ids=[executable for _, executable, _ in SET])
def test_a_node_reads_what_a_launch_file_sets_and_refuses_what_it_does_not_know(
    package: str, executable: str, parameter: str
) -> None:
    node, _, name = parameter.partition(".")
    assert f"{name}_" in refused(package, executable, "--set", f"{node}.{name}_=1")
    assert "--frob" in refused(package, executable, "--set", f"{parameter}=1", "--frob")


def test_what_is_set_has_an_effect() -> None:
    assert "'Q' is not one of" in refused("acts_control", "ball_trajectory", "--set", "ball_trajectory.trajectory=Q")


def test_ball_state_has_a_command_line_as_the_others() -> None:
    assert "--frob" in refused("acts_control", "ball_state", "--frob")
