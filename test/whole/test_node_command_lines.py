# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What launch files write on the command line of a node reaches it, the rest is refused; ROS_DOMAIN_ID 224."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
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
DEADLINE_S = 60.0


# Imports what nodes import, and carries out each command line that it reads in a copy of itself: a program for each of
# them would import all of it again. The programs are all alike, and start in the tests of launch files.
COPIES = """
import importlib, importlib.metadata, json, os, sys, tempfile
for line in sys.stdin:
    package, executable, words = json.loads(line)
    scripts = importlib.metadata.distribution(package).entry_points.select(group="console_scripts", name=executable)
    (program,) = (script.load() for script in scripts)
    importlib.import_module(program._module)
    with tempfile.TemporaryFile() as said:
        child = os.fork()
        if not child:
            os.dup2(said.fileno(), 1)
            os.dup2(said.fileno(), 2)
            sys.argv = [executable, *words]
            sys.exit(program())
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        said.seek(0)
        print(json.dumps([code, said.read().decode()]), flush=True)
"""

Refused = Callable[..., str]


def program(package: str, executable: str) -> Path:
    return Path(get_package_prefix(package)) / "lib" / package / executable


@pytest.fixture(scope="module")
def refused() -> Iterator[Refused]:
    """What a node says that refuses its command line."""
    environment = {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN_ID)}
    with subprocess.Popen(
        [sys.executable, "-c", COPIES], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    ) as process:
        assert process.stdin is not None

        def ask(package: str, executable: str, *words: str) -> str:
            assert process.stdout is not None
            assert program(package, executable).is_file()
            print(json.dumps([package, executable, words]), file=process.stdin, flush=True)
            code, said = json.loads(process.stdout.readline())
            assert code == REFUSED_EXIT_CODE, said
            return str(said)

        yield ask
        process.stdin.close()
        assert process.wait(DEADLINE_S) == 0


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
    refused: Refused, package: str, executable: str, parameter: str
) -> None:
    node, _, name = parameter.partition(".")
    assert f"{name}_" in refused(package, executable, "--set", f"{node}.{name}_=1")
    assert "--frob" in refused(package, executable, "--set", f"{parameter}=1", "--frob")


def test_what_is_set_has_an_effect() -> None:
    finished = subprocess.run(
        [str(program("acts_control", "ball_trajectory")), "--set", "ball_trajectory.trajectory=Q"],
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
        env={**os.environ, "ROS_DOMAIN_ID": str(DOMAIN_ID)},
    )
    assert finished.returncode == REFUSED_EXIT_CODE, finished.stdout + finished.stderr
    assert "'Q' is not one of" in finished.stderr


def test_ball_state_has_a_command_line_as_the_others(refused: Refused) -> None:
    assert "--frob" in refused("acts_control", "ball_state", "--frob")
