# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Model of a parsed launch file: a list of actions, each with its place in the file and an optional condition."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from acts_tools.launch.parameters import Content
from acts_tools.launch.place import Place
from acts_tools.launch.substitutions import Template


@dataclass(frozen=True)
class Condition:
    """`if` (wanted is True) or `unless` (wanted is False): holds when the expression evaluates to `wanted`."""

    expression: Template
    wanted: bool


@dataclass(frozen=True, kw_only=True)
class Action:
    """Fields of all actions."""

    place: Place
    condition: Condition | None = None


@dataclass(frozen=True, kw_only=True)
class DeclareArgument(Action):
    """`arg`: an argument of the launch file; without a default it is required.

    Attributes
    ----------
    choices : tuple of str
        Allowed values; empty for any value.
    """

    name: str
    default: Template | None
    description: str
    choices: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class SetVariable(Action):
    """`let`: sets a variable from here on, up to the end of the scope."""

    name: Template
    value: Template


@dataclass(frozen=True, kw_only=True)
class SetEnvironment(Action):
    """`set_env`: an environment variable of processes that are started from here on, up to the end of the scope."""

    name: Template
    value: Template


@dataclass(frozen=True, kw_only=True)
class PushNamespace(Action):
    """`push-ros-namespace`: prefix of the namespaces of the nodes from here on, up to the end of the scope."""

    namespace: Template


@dataclass(frozen=True, kw_only=True)
class Log(Action):
    """`log`: a message of the launch file to who launches it."""

    message: Template


@dataclass(frozen=True, kw_only=True)
class Group(Action):
    """`group`: if scoped, variables, environment and namespace are restored after it."""

    scoped: bool
    actions: tuple[AnyAction, ...]


@dataclass(frozen=True, kw_only=True)
class Include(Action):
    """`include`: the actions of another file; the arguments are variables, and stay set after it."""

    file: Template
    arguments: tuple[tuple[Template, Template], ...]


@dataclass(frozen=True)
class ParameterFile:
    """`param from`: a params file, passed on unchanged."""

    place: Place
    path: Template


@dataclass(frozen=True)
class ParameterValue:
    """`param name value`: one parameter.

    Attributes
    ----------
    content : Content
        Value before substitution.
    type_name : str or None
        The `type` attribute; None and "yaml" let YAML decide.
    """

    place: Place
    name: Template
    content: Content
    type_name: str | None


@dataclass(frozen=True, kw_only=True)
class Node(Action):
    """`node`: one process.

    Attributes
    ----------
    package : Template or None
        None when `executable` is a path or a program on the PATH.
    arguments : tuple of Template
        Words of the command line; each stays one word whatever the values of its substitutions.
    respawn_delay_s : float
        From the end of the process to its next start [s].
    """

    package: Template | None
    executable: Template
    name: Template | None
    namespace: Template | None
    output: Template
    arguments: tuple[Template, ...]
    respawn: Template
    respawn_delay_s: float
    parameters: tuple[ParameterFile | ParameterValue, ...]
    remaps: tuple[tuple[Template, Template], ...]


@dataclass(frozen=True, kw_only=True)
class Executable(Action):
    """`executable`: a process that is no ROS node and gets no ROS arguments.

    Attributes
    ----------
    command : tuple of Template
        Program and words of the command line, as `Node.arguments`.
    name : Template or None
        Label of the process; None for the program's name.
    environment : tuple of (Template, Template)
        Names and values of variables that are added to its environment.
    respawn_delay_s : float
        From the end of the process to its next start [s].
    """

    command: tuple[Template, ...]
    name: Template | None
    environment: tuple[tuple[Template, Template], ...]
    output: Template
    respawn: Template
    respawn_delay_s: float


AnyAction: TypeAlias = (
    "DeclareArgument | SetVariable | SetEnvironment | PushNamespace | Log | Group | Include | Node | Executable"
)
