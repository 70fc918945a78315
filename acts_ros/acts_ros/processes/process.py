# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Description of one process to start."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Process:
    """One process to start.

    Attributes
    ----------
    label : str
        Name for people: the executable and a running number, such as ``driver-2``.
    command : tuple of str
        Program and arguments.
    environment : dict of str to str
        All of its environment.
    output : str
        "screen", "log" (standard error still goes to the screen) or "both".
    respawn : bool
        Start it again whenever it ends.
    respawn_delay_s : float
        Wait before that [s]; longer where it ends again and again (`acts_ros.processes.respawn`).
    parameter_files : tuple of Path
        Temporary params files among its arguments.
    """

    label: str
    command: tuple[str, ...]
    environment: dict[str, str]
    output: str
    respawn: bool
    respawn_delay_s: float
    parameter_files: tuple[Path, ...] = ()
