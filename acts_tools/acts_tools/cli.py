# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The `acts` command. Each subcommand is one module; only the module of the given subcommand is imported."""

from __future__ import annotations

import argparse
import errno
import importlib
import os
import sys
from collections.abc import Sequence
from types import ModuleType
from typing import Any

from acts_core.errors import ActsError
from acts_ros.executables.missing_packages import advice_about
from acts_ros.executables.shared_memory import check_shared_memory
from acts_tools import INTERRUPTED, __version__

COMMANDS = {
    "launch": ("acts_tools.launch.command", "start the nodes of a launch file"),
    "record": ("acts_tools.bags.record", "record topics to a bag"),
    "play": ("acts_tools.bags.play", "publish a bag's messages again"),
    "info": ("acts_tools.bags.info", "print what a bag holds"),
    "export": ("acts_tools.export.command", "write touch of a bag as csv, npz, parquet or LeRobot dataset"),
    "view": ("acts_tools.view", "show touch on a page in the browser"),
    "echo": ("acts_tools.echo.command", "print the messages of a topic"),
    "pub": ("acts_tools.pub.command", "publish a message again and again"),
    "listen": ("acts_tools.listen.command", "measure loss and delay of a topic on this machine"),
    "driver": ("acts_tools.driver.command", "control a running driver: query, calibrate, tare, set"),
    "param": ("acts_tools.parameters.command", "show and set parameters of a running node"),
    "call": ("acts_tools.services.command", "call a service of a running node, such as grasp or stop"),
    "diagnostics": ("acts_tools.diagnostics.command", "print the diagnostics of the running nodes"),
    "selftest": ("acts_tools.selftest.command", "test a board, its wiring and its skin"),
    "doctor": ("acts_tools.doctor.command", "check this machine, and say how to correct what is wrong"),
    "train": ("acts_tools.training.command", "train a dictionary for the reconstruction"),
    "library": ("acts_tools.library", "write a library of known objects for the classification"),
    "bench": ("acts_tools.bench.command", "measure throughput, CPU and latency"),
    "evaluate": ("acts_tools.evaluate.command", "score what is made of touch, recorded or simulated"),
    "figures": ("acts_tools.figures.command", "draw the paper's figures beside ours"),
    "demo": ("acts_tools.demo.command", "run a demonstration with everything simulated"),
}
"""Module and summary of every subcommand; the module has ``add_parser(subparsers)`` and ``run(arguments) -> int``."""

_OF_NAMES = (errno.EACCES, errno.ELOOP, errno.ENAMETOOLONG, errno.EROFS)
"""What is wrong with a path that somebody gave, not with the command."""

_EPILOG = """\
examples:
  acts demo ball_balancing                                          see the whole chain at work, no hardware needed
  acts launch acts_bringup tactile.launch.xml --show-args           list the arguments of a launch file
  acts launch acts_bringup tactile.launch.xml sim:=false port:=auto
  acts record -o touch /plate/samples /plate/contact                Ctrl-C ends it
  acts play touch

`acts COMMAND --help` explains a command. `./acts run COMMAND ...` runs any program in the ACTS environment.
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run the acts command.

    Parameters
    ----------
    argv : sequence of str or None
        Words after ``acts``; None for those of the process.

    Returns
    -------
    int
        Exit code: that of the subcommand, 1 after an `ActsError`, 2 for an invalid command line, 130 after Ctrl-C.
    """
    words = list(sys.argv[1:] if argv is None else argv)
    # The first word that is not an option is the subcommand, because acts has no option with a value.
    selected = next((word for word in words if not word.startswith("-")), None)
    if selected == "launch":
        # argparse takes no words behind an option, such as name:=value behind --print; no option of launch has a value.
        words.sort(key=lambda word: word.startswith("-"))
    try:
        check_shared_memory()
        parser, module = _build_parser(selected)
        arguments = parser.parse_args(words)
        if module is None:
            parser.print_help()
            return 0
        return int(module.run(arguments))
    except ActsError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except ImportError as error:
        advice = advice_about(error)
        if not advice:
            raise
        print(f"error: {advice}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return INTERRUPTED
    except BrokenPipeError:
        # The reader of our output has ended (`acts ... | head`); without this Python prints another error at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except OSError as error:
        # Any file may be the one that fills the disk, or that has a name that cannot be; where a command does not say
        # which, neither can this.
        is_full = error.errno in (errno.ENOSPC, errno.EDQUOT) or _is_without_temporary_folder(error)
        if not is_full and error.errno not in _OF_NAMES:
            raise
        about = f"{error.filename}: " if error.filename else ""
        print(f"error: {about}{error.strerror}{': make room and try again' if is_full else ''}", file=sys.stderr)
        return 1


def _is_without_temporary_folder(error: OSError) -> bool:
    """Whether it is that of `tempfile` where it can write nowhere."""
    return isinstance(error, FileNotFoundError) and error.filename is None and "temporary directory" in str(error)


class Parser(argparse.ArgumentParser):
    """Options are given by their whole names, in subcommands too: ``--seed`` must not mean ``--seeds``."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**{"allow_abbrev": False, **options})
        # For `acts_tools.arguments.refuse_unused`.
        self.set_defaults(default_of=self.get_default)

    def parse_known_args(  # type: ignore[override]
        self, args: Sequence[str] | None = None, namespace: Any = None
    ) -> tuple[Any, list[str]]:
        """Refuse unknown words here, with the usage of this command: argparse leaves that to ``acts`` as a whole."""
        parsed, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}")
        return parsed, unknown


def _build_parser(selected: str | None) -> tuple[argparse.ArgumentParser, ModuleType | None]:
    parser = Parser(
        prog="acts",
        description="ACTS: robot touch at 1 kHz, from the board's bytes to the robot's joints.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"acts {__version__}")
    subparsers = parser.add_subparsers(title="commands", metavar="COMMAND")
    module = None
    for name, (module_name, summary) in COMMANDS.items():
        if name == selected:
            module = importlib.import_module(module_name)
            module.add_parser(subparsers)
        else:
            subparsers.add_parser(name, help=summary)
    return parser, module
