# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process that refuses what it was given, under a launcher that would start it again and again, and otherwise."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from acts_core.errors import REFUSED_EXIT_CODE
from acts_ros.executables.refused import LAUNCHER_VARIABLE, STAY_WORD

DEADLINE_S = 30.0
# Refuses the word that it must be told; with another error it might fare better the next time.
NODE = """
import sys
from acts_core import errors

def main(signals):
    try:
        assert sys.argv[1:] == ["--set", "driver.scheme=trackin"], sys.argv
        raise errors.{error}("scheme = 'trackin': allowed is tracking")
    finally:
        # As the executor leaves it: signals are ignored.
        signals.ended()
"""


def started(folder: Path, error: str, *words: str, **environment: str) -> subprocess.Popen[str]:
    (folder / "refusing_node.py").write_text(NODE.format(error=error))
    inherited = {name: value for name, value in os.environ.items() if name != LAUNCHER_VARIABLE}
    path = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
    command = [
        sys.executable,
        "-m",
        "acts_ros.executables.program",
        "refusing_node",
        *words,
        "--set",
        "driver.scheme=trackin",
    ]
    return subprocess.Popen(
        command, env={**inherited, "PYTHONPATH": path, **environment}, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_what_would_be_started_again_stays_and_says_so_until_it_is_told_to_end(
    tmp_path: Path, number: signal.Signals
) -> None:
    with started(tmp_path, "SettingsError", STAY_WORD) as process:
        try:
            assert process.stderr is not None
            assert "scheme = 'trackin'" in process.stderr.readline()
            assert "does nothing" in process.stderr.readline()
            assert process.poll() is None
            process.send_signal(number)
            assert process.wait(DEADLINE_S) == REFUSED_EXIT_CODE
        finally:
            process.kill()


def test_what_stays_under_nohup_goes_on_ignoring_the_end_of_the_terminal(tmp_path: Path) -> None:
    handler = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        process = started(tmp_path, "SettingsError", STAY_WORD)
    finally:
        signal.signal(signal.SIGHUP, handler)
    with process:
        try:
            assert process.stderr is not None
            assert "scheme = 'trackin'" in process.stderr.readline()
            assert "does nothing" in process.stderr.readline()
            masks = dict(line.split(":") for line in Path(f"/proc/{process.pid}/status").read_text().splitlines())
            assert int(masks["SigIgn"], 16) >> (signal.SIGHUP - 1) & 1
        finally:
            process.kill()


PARSING_NODE = """
import argparse, sys

def main(signals):
    parser = argparse.ArgumentParser(prog="a_node")
    parser.add_argument("--sim", choices=["true", "false"])
    try:
        parser.parse_args(sys.argv[1:])
    finally:
        signals.ended()
"""
NEEDY_NODE = "import {module}\n"


def run_to_refusal(folder: Path, node: str, *words: str) -> tuple[str, int]:
    """What a node says under a launcher that would start it again, until it stays, and its exit code after SIGTERM."""
    (folder / "such_a_node.py").write_text(node)
    # A package that is too old, or not there, whatever is installed.
    for name in ("rosbags", "websockets"):
        (folder / name).mkdir()
        (folder / name / "__init__.py").touch()
    inherited = {name: value for name, value in os.environ.items() if name != LAUNCHER_VARIABLE}
    path = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
    command = [sys.executable, "-m", "acts_ros.executables.program", "such_a_node", STAY_WORD, *words]
    with subprocess.Popen(command, env={**inherited, "PYTHONPATH": path}, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        said = ""
        try:
            for line in process.stderr:
                said += line
                if "does nothing" in line:
                    process.terminate()
            return said, process.wait(DEADLINE_S)
        finally:
            process.kill()


def test_a_command_line_that_is_refused_stays(tmp_path: Path) -> None:
    """It ended, and ros2 launch started it again and again."""
    said, code = run_to_refusal(tmp_path, PARSING_NODE, "--sim", "perhaps")
    assert "invalid choice: 'perhaps'" in said
    assert "does nothing" in said
    assert code == REFUSED_EXIT_CODE


@pytest.mark.parametrize("module", ["rosbags.highlevel", "websockets.asyncio.server"])
def test_a_package_that_rosdep_does_not_know_is_named_with_what_to_do(tmp_path: Path, module: str) -> None:
    said, code = run_to_refusal(tmp_path, NEEDY_NODE.format(module=module))
    assert "Traceback" not in said
    assert said.startswith(
        f"error: {module.rpartition('.server')[0] or module} is not installed, or too old: pip install"
    )
    assert "does nothing" in said
    assert code == REFUSED_EXIT_CODE


@pytest.mark.parametrize("module", ["rosbags", "websockets"])
def test_a_package_that_lacks_a_name_is_too_old(tmp_path: Path, module: str) -> None:
    said, code = run_to_refusal(tmp_path, f"from {module} import a_name\n")
    assert "Traceback" not in said
    assert said.startswith(f"error: {module} is not installed, or too old: pip install -r requirements-ros.txt")
    assert code == REFUSED_EXIT_CODE


def test_a_middleware_that_is_not_installed_is_named_with_those_that_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It ended while it was imported, and was started again for ever."""
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_none_cpp")
    said, code = run_to_refusal(tmp_path, "import rclpy\n")
    assert said.startswith("error: RMW_IMPLEMENTATION=rmw_none_cpp: that is not installed here, but rmw_")
    assert "rmw_implementation" not in said
    assert code == REFUSED_EXIT_CODE


@pytest.mark.parametrize(
    ("error", "words", "environment", "code"),
    [
        ("SettingsError", [], {}, REFUSED_EXIT_CODE),
        ("SettingsError", [STAY_WORD], {LAUNCHER_VARIABLE: "1"}, REFUSED_EXIT_CODE),
        ("PortError", [STAY_WORD], {}, 1),
    ],
    ids=["by hand", "acts launch", "an error that may pass"],
)
def test_otherwise_it_ends(
    tmp_path: Path, error: str, words: list[str], environment: dict[str, str], code: int
) -> None:
    with started(tmp_path, error, *words, **environment) as process:
        try:
            assert process.wait(DEADLINE_S) == code
        finally:
            process.kill()
