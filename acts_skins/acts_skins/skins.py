# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`skins`: run a process `tactile` for every skin of a file, and in simulation also its board; restart those that die.

A failure of one skin does not affect the others. The processes end with this one, even if it is killed.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from acts_core.errors import ActsError, SettingsError
from acts_core.stop_signals import StopSignals
from acts_ros.processes.console import Console
from acts_ros.processes.launcher import Launcher
from acts_sim.shared import FileClaim, default_run_dir
from acts_skins.skin_processes import SkinProcesses
from acts_skins.skins_file import read_skins

# Together less than the 5 s after which a launch sends SIGTERM to this process.
_SIGTERM_AFTER_S = 3.0
_SIGKILL_AFTER_S = 1.5

_TRUTHS = {"true": True, "1": True, "false": False, "0": False}


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the skins until told to stop, and return the exit code."""
    signals = StopSignals() if signals is None else signals
    # The launcher installs its own signal handlers; until then, a signal aborts the start.
    with signals.interrupting():
        words = list(sys.argv if args is None else args)[1:]
        own, ros_words = _split(words)
        options = _parser().parse_args(own)
        skins_file = read_skins(options.skins_file)
        if _TRUTHS[options.merge]:
            # Here as well as in the node that merges: no skin is to start where that one refuses the file.
            skins_file.in_base(options.base_frame)
        plan = SkinProcesses(
            skins_file,
            simulated=_TRUTHS[options.sim],
            run_dir=options.run_dir.absolute(),
            namespace=_namespace(ros_words),
            environment=os.environ,
        ).plan()
        launcher = Launcher(Console(None), _SIGTERM_AFTER_S, _SIGKILL_AFTER_S, name="skins", ends_on_refusal=False)
        if not _TRUTHS[options.sim]:
            return launcher.run(plan)
        # As it was given: one that begins with ~ is refused.
        with _claim(options.run_dir):
            code = launcher.run(plan)
            for skin in skins_file.skins:
                # An empty one would be in the way of a port of its name: that of hand_reflexes.launch.xml is `hand`.
                with contextlib.suppress(OSError):
                    (options.run_dir / skin.name).rmdir()
            return code


def _claim(run_dir: Path) -> contextlib.closing[FileClaim]:
    """Use a folder for simulated boards alone.

    Raises
    ------
    SettingsError
        Another program `skins` uses it: boards would be started in vain again and again.
    """
    try:
        return contextlib.closing(FileClaim(run_dir / "skins"))
    except ActsError as error:
        raise SettingsError(str(error)) from error


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="skins", description="Run a process for every skin of a file (docs/skins.md)."
    )
    parser.add_argument("--skins-file", type=Path, required=True, help="YAML file that describes the skins")
    parser.add_argument("--sim", type=_word, choices=_TRUTHS, default="true", help="whether boards are simulated")
    parser.add_argument("--run-dir", type=Path, default=default_run_dir(), help="folder for files of simulated boards")
    parser.add_argument(
        "--merge", type=_word, choices=_TRUTHS, default="false", help="whether the contacts are merged as well"
    )
    parser.add_argument("--base-frame", default="none", help="frame of the merged contacts; none: that of the file")
    return parser


def _word(text: str) -> str:
    """As the conditions of launch files take a truth."""
    return text.strip().lower()


def _split(words: list[str]) -> tuple[list[str], list[str]]:
    """Our arguments, and those between ``--ros-args`` and ``--``."""
    own: list[str] = []
    ros: list[str] = []
    target = own
    for word in words:
        if word == "--ros-args":
            target = ros
        elif word == "--" and target is ros:
            target = own
        else:
            target.append(word)
    return own, ros


def _namespace(ros_words: list[str]) -> str:
    """The namespace that a launch file has set; empty for none."""
    rules = [word.removeprefix("__ns:=") for word in ros_words if word.startswith("__ns:=")]
    namespace = rules[-1].rstrip("/") if rules else ""
    if namespace and not namespace.startswith("/"):
        raise SettingsError(f"__ns:={rules[-1]}: a namespace begins with /")
    return namespace
