# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""List the arguments of a launch file in the format of `ros2 launch --show-args`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from acts_core.errors import LaunchError
from acts_tools.launch import substitutions
from acts_tools.launch.model import AnyAction, DeclareArgument, Group, Include
from acts_tools.launch.parser import parse_file
from acts_tools.launch.substitutions import Scope


def show_arguments(file: Path, environment: Mapping[str, str]) -> str:
    """Describe the arguments of a launch file and of those it includes.

    Parameters
    ----------
    file : Path
        The launch file.
    environment : mapping of str to str
        Environment to find packages of included files in.

    Returns
    -------
    str
        Name, description and default of each; a star marks those that depend on a condition.
    """
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    seen: set[str] = set()
    any_conditional = False
    for argument, conditional in _collect(parse_file(file), Scope({}, dict(environment), file), False, (file,)):
        if argument.name in seen:
            continue
        seen.add(argument.name)
        any_conditional |= conditional
        lines += ["", f"    '{argument.name}':{'*' if conditional else ''}", f"        {argument.description}"]
        if argument.default is not None:
            lines.append(f"        (default: {substitutions.describe(argument.default)})")
    if not seen:
        lines += ["", "  No arguments."]
    if any_conditional:
        lines += ["", "* argument(s) which are only used if specific conditions occur"]
    return "\n".join(lines)


def listed_arguments(file: Path, environment: Mapping[str, str]) -> set[str]:
    """Names of the arguments that `show_arguments` describes; its parameters."""
    return {
        argument.name for argument, _ in _collect(parse_file(file), Scope({}, dict(environment), file), False, (file,))
    }


def _collect(
    actions: tuple[AnyAction, ...], scope: Scope, conditional: bool, within: tuple[Path, ...]
) -> Iterator[tuple[DeclareArgument, bool]]:
    for action in actions:
        under_condition = conditional or action.condition is not None
        if isinstance(action, DeclareArgument):
            yield action, under_condition
        elif isinstance(action, Group):
            yield from _collect(action.actions, scope, under_condition, within)
        elif isinstance(action, Include):
            try:
                included = Path(substitutions.perform(action.file, scope))
            except LaunchError:
                continue  # the file depends on arguments
            if included.is_file() and included not in within:
                inner = Scope({}, scope.environment, included)
                yield from _collect(parse_file(included), inner, under_condition, (*within, included))
