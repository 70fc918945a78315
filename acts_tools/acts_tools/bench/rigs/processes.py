# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The measured processes: the virtual board, and programs that read it."""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path

from acts_core.errors import LaunchError
from acts_ros.processes.packages import executable
from acts_tools.running.child import child

NAMESPACE = "/plate"
M = 55
START_TIMEOUT_S = 30.0
_STOP_TIMEOUT_S = 10.0


@dataclass(frozen=True)
class Board:
    """A running virtual board.

    Attributes
    ----------
    link : Path
        The port to open.
    process : subprocess.Popen
        Its process.
    epoch_monotonic_ns : int
        The host's clock at board time 0.
    """

    link: Path
    process: subprocess.Popen[bytes]
    epoch_monotonic_ns: int


Running = AbstractContextManager[subprocess.Popen[bytes]]
"""A program that runs for the length of a block."""


@contextmanager
def command_line(folder: Path, name: str, command: Sequence[str]) -> Iterator[subprocess.Popen[bytes]]:
    """Run any program, with a pipe for its standard output; its errors go to ``folder/NAME.log``."""
    with (
        (folder / f"{name}.log").open("wb") as log,
        child(command, stop_timeout_s=_STOP_TIMEOUT_S, stdout=subprocess.PIPE, stderr=log) as process,
    ):
        yield process


@contextmanager
def virtual_board(folder: Path, *options: str) -> Iterator[Board]:
    """Run a virtual board, by default with M = 55 at 1 kHz.

    Parameters
    ----------
    folder : Path
        Folder for its link and log.
    *options : str
        As in ``docs/virtual_board.md``.

    Raises
    ------
    LaunchError
        When it does not start.
    """
    link = folder / "board"
    words = ["--link", str(link), "--print-status", "--m", str(M), *options]
    command = [str(executable("acts_firmware", "virtual_board", os.environ)), *words]
    with command_line(folder, "virtual_board", command) as process:
        assert process.stdout is not None
        ready, _, _ = select.select([process.stdout], [], [], START_TIMEOUT_S)
        line = process.stdout.readline() if ready else b""
        if not line:
            raise LaunchError(f"the virtual board does not start: {_log_end(folder / 'virtual_board.log')}")
        yield Board(link, process, json.loads(line)["epoch_monotonic_ns"])


def driver(folder: Path, link: Path, *parameters: str) -> Running:
    """Run the driver node on a port, in `NAMESPACE`; its log goes to ``folder/driver.log``.

    Parameters
    ----------
    folder : Path
        Folder for its log.
    link : Path
        The port.
    *parameters : str
        More parameters, as ``name:=value``.
    """
    command = [str(executable("acts_driver", "driver", os.environ)), "--ros-args", "-r", f"__ns:={NAMESPACE}"]
    command += [word for parameter in (f"port:={link}", *parameters) for word in ("-p", parameter)]
    return command_line(folder, "driver", command)


def python_module(folder: Path, module: str, arguments: Sequence[str]) -> Running:
    """Run a Python module; its errors go to ``folder/MODULE.log``."""
    return command_line(folder, module, [sys.executable, "-m", module, *arguments])


def tactile(folder: Path, link: Path, namespace: str, *options: str) -> Running:
    """Run driver and reconstruction of one skin in one process; its log goes to ``folder/tactile.log``."""
    command = [str(executable("acts_skins", "tactile", os.environ)), "--set", f"driver.port={link}", *options]
    return command_line(folder, "tactile", [*command, "--ros-args", "-r", f"__ns:={namespace}"])


def check_alive(process: subprocess.Popen[bytes], log: Path, name: str = "") -> None:
    """Raise `LaunchError` if a process has ended, with its name, or that of its log, and the end of its log."""
    if process.poll() is not None:
        raise LaunchError(f"{name or log.stem} ended early with code {process.returncode}: {_log_end(log)}")


def _log_end(path: Path) -> str:
    return " / ".join(path.read_text(errors="replace").splitlines()[-3:]) or "it said nothing"
