# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts launch`: run a launch file, list its arguments, or show what it would start."""

from __future__ import annotations

import argparse
import importlib.util
import os
import secrets
import shlex
import shutil
import sys
import tempfile
from difflib import get_close_matches
from pathlib import Path

from acts_core.errors import LaunchError

_OWN_VARIABLE = "ACTS_LAUNCH_OWN"
_OURS = "acts_bringup"
_TIMEOUTS = ("sigterm_timeout", "sigkill_timeout")


_EPILOG = """\
examples:
  acts launch acts_bringup tactile.launch.xml                 a simulated skin
  acts launch acts_bringup tactile.launch.xml sim:=false port:=auto
  acts launch acts_bringup tactile.launch.xml --show-args     its arguments
  acts launch my_skins.launch.xml                             a file of your own, by its path

Exit code: 0 when all nodes ended in order, 1 when one died or the launch file is invalid. docs/launch.md explains the
rest.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``launch`` to the acts command."""
    parser = subparsers.add_parser(
        "launch",
        help="start the nodes of a launch file",
        description="Start the nodes of an XML launch file and stop them together (Ctrl-C). "
        "Where `ros2 launch` is installed, it is used.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("package", metavar="PACKAGE", help="package of the launch file, or path of a launch file")
    parser.add_argument(
        "words", nargs="*", default=[], metavar="FILE | NAME:=VALUE", help="launch file, then its arguments"
    )
    what = parser.add_mutually_exclusive_group()
    what.add_argument(
        "-s", "--show-args", "--show-arguments", action="store_true", help="list the arguments of the launch file"
    )
    what.add_argument("-p", "--print", action="store_true", help="print the commands without starting anything")
    parser.add_argument(
        "--own",
        action="store_true",
        help=f"do not use `ros2 launch` where it is installed (also with {_OWN_VARIABLE}=1)",
    )


def run(arguments: argparse.Namespace) -> int:
    """Run ``acts launch`` and return its exit code."""
    own = arguments.own or os.environ.get(_OWN_VARIABLE, "") not in ("", "0")
    if not own and real_launch_installed():
        return _hand_over(arguments)
    file, words = _find_file(arguments.package, list(arguments.words))
    if not file.name.endswith(".xml"):
        raise LaunchError(f"acts launch reads XML launch files (*.launch.xml) only, not '{file.name}'")
    values = parse_arguments(words)
    if arguments.show_args:
        from acts_tools.launch.show import show_arguments

        print(show_arguments(file, os.environ))
        return 0
    return _launch(file, values, only_print=arguments.print)


def real_launch_installed() -> bool:
    """Whether ``ros2 launch`` is installed."""
    return shutil.which("ros2") is not None and all(
        importlib.util.find_spec(module) is not None for module in ("ros2launch", "launch_ros", "launch_xml")
    )


def parse_arguments(words: list[str]) -> dict[str, str]:
    """Launch arguments from ``name:=value`` words; of duplicates the last one wins.

    Raises
    ------
    LaunchError
        A word is not of this form.
    """
    values = {}
    for word in words:
        name, separator, value = word.partition(":=")
        if not separator or not name or not value:
            raise LaunchError(f"malformed launch argument '{word}', expected format '<name>:=<value>'")
        values[name] = value
    return values


def _hand_over(arguments: argparse.Namespace) -> int:
    options = [
        *(["--show-args"] if arguments.show_args else []),
        *(["--print"] if arguments.print else []),
    ]
    sys.stdout.flush()
    os.execvp("ros2", ["ros2", "launch", *options, arguments.package, *arguments.words])


def _is_ours(file: str) -> bool:
    """Whether a word that is no path names one of our launch files: the package before it was left out."""
    from acts_ros.processes import packages

    try:
        packages.launch_file(_OURS, file, os.environ)
    except LaunchError:
        return False
    return "/" not in file


def _find_file(package: str, words: list[str]) -> tuple[Path, list[str]]:
    """The launch file and the remaining words; a path has precedence over a package of the same name."""
    from acts_ros.processes import packages

    if Path(package).is_file():
        return Path(package).absolute(), words
    if "/" in package or package.endswith(".xml"):
        hint = f"; did you mean acts launch {_OURS} {package}?" if _is_ours(package) else ""
        raise LaunchError(f"the launch file '{package}' does not exist{hint}")
    if not words or ":=" in words[0]:
        share = packages.share(package, os.environ)
        there = ", ".join(sorted(path.name for path in share.rglob("*.launch.xml"))) or "none"
        raise LaunchError(f"no launch file named: acts launch {package} FILE (there: {there})")
    return packages.launch_file(package, words[0], os.environ), words[1:]


def _launch(file: Path, values: dict[str, str], only_print: bool) -> int:
    # Imported here, because listing arguments does not need it.
    from acts_ros.processes.console import Console, make_log_folder
    from acts_ros.processes.launcher import Launcher
    from acts_tools.launch.evaluate import evaluate

    timeouts_s = [_seconds(name, values.get(name, "5")) for name in _TIMEOUTS]
    # Made at the first params file: a launcher that is killed leaves it behind. Nobody else can know its name.
    folder = _temporary_folder() / f"acts_launch_{secrets.token_hex(8)}"
    try:
        plan = evaluate(file, values, os.environ, folder)
        _require_declared(set(values) - set(_TIMEOUTS), plan.declared, file)
        if only_print:
            for text in plan.warnings:
                print(f"warning: {text}", file=sys.stderr)
            for text in plan.messages:
                print(text, file=sys.stderr)
            for process in plan.processes:
                print(f"[{process.label}] {shlex.join(process.command)}")
                for path in process.parameter_files:
                    print("".join(f"    {line}\n" for line in (f"{path}:", *path.read_text().splitlines())), end="")
            return 0
        log_folder = make_log_folder()
        console = Console(log_folder)
        try:
            console.say("INFO", "launch", f"All log files can be found below {log_folder}")
            for text in plan.warnings:
                console.say("WARNING", "launch", text)
            for text in plan.messages:
                console.say("INFO", "launch.user", text)
            return Launcher(console, *timeouts_s).run(plan.processes)
        finally:
            console.close()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _temporary_folder() -> Path:
    try:
        return Path(tempfile.gettempdir())
    except FileNotFoundError:
        # The disk is full, and most launch files need none: what moves a robot can be launched all the same.
        return Path("/tmp")


def _require_declared(given: set[str], declared: set[str], file: Path) -> None:
    """Raise for an argument that would silently have no effect: it is misspelt, or its condition does not hold."""
    from acts_tools.launch.show import listed_arguments

    for name in sorted(given - declared):
        if name in listed_arguments(file, os.environ):
            raise LaunchError(
                f"the argument '{name}' has no effect here: it is declared under a condition that does not hold"
            )
        nearest = get_close_matches(name, sorted(declared), n=1)
        hint = f"did you mean '{nearest[0]}'? " if nearest else ""
        known = ", ".join(sorted(declared)) or "none"
        raise LaunchError(f"the launch file declares no argument '{name}'; {hint}declared: {known}")


def _seconds(name: str, text: str) -> float:
    try:
        value_s = float(text)
    except ValueError:
        value_s = float("nan")
    if not 0.0 <= value_s < float("inf"):
        raise LaunchError(f"{name}:={text} is not a time in seconds")
    return value_s
