# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The text of an executable's ``--help``; ROS is not initialised for it."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Iterator, Mapping

from acts_core.settings import Changeable, SettingInfo, default_of, describe

_INDENT = " " * 8
_WIDEST = 120

_CHANGE = {
    Changeable.AT_START: "",
    Changeable.UNCONFIGURED: "may be set while the node is unconfigured",
    Changeable.RUNNING: "may be set while the node runs",
}


def program_help(program: str, description: str, nodes: Mapping[str, type]) -> str:
    """Text of ``--help``.

    Parameters
    ----------
    program : str
        Name of the executable.
    description : str
        What it does.
    nodes : mapping of str to type
        Settings class of each of its nodes, by the node's name.
    """
    first, *_ = nodes
    example = next(iter(describe(nodes[first])), "name")
    if len(nodes) == 1:
        usage, given = f"{program} [--ros-args -p NAME:=VALUE --params-file FILE -r __ns:=/NAMESPACE ...]", ""
    else:
        usage = f"{program} [--set NODE.PARAMETER=VALUE ...] [--ros-args --params-file FILE -r __ns:=/NAMESPACE ...]"
        given = (
            f"--set {first}.{example}=VALUE sets a parameter of one node; -p after --ros-args goes to all nodes.\n\n"
        )
    sections = [f"parameters of {name}:\n" + "".join(_parameters(kind)) for name, kind in nodes.items()]
    return f"usage: {usage}\n\n{description.strip()}\n\n{given}" + "\n".join(sections)


def _parameters(settings_class: type) -> Iterator[str]:
    width = min(shutil.get_terminal_size().columns, _WIDEST)
    for name, info in describe(settings_class).items():
        yield f"    {name} (default {_default(default_of(settings_class, name))})\n"
        yield textwrap.fill(_told(info), width, initial_indent=_INDENT, subsequent_indent=_INDENT) + "\n"


def _told(info: SettingInfo) -> str:
    return "; ".join(part for part in (info.description, info.allowed, _CHANGE[info.changeable]) if part)


def _default(value: object) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(map(str, value)) + "]"
    return str(value).lower() if isinstance(value, bool) else str(value) or "empty"
