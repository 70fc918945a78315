# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Evaluate actions and arguments to a plan of processes, without starting them."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import yaml

from acts_core.errors import LaunchError
from acts_core.names import ALLOWED, is_full_name, is_name
from acts_ros.processes import packages
from acts_ros.processes.process import Process
from acts_tools.launch import parameters, substitutions
from acts_tools.launch.model import (
    AnyAction,
    Condition,
    DeclareArgument,
    Executable,
    Group,
    Include,
    Log,
    Node,
    ParameterFile,
    PushNamespace,
    SetEnvironment,
    SetVariable,
)
from acts_tools.launch.parser import parse_file
from acts_tools.launch.place import located
from acts_tools.launch.substitutions import Scope

_MAXIMUM_DEPTH = 30
_NAMESPACE_VARIABLE = "ros_namespace"
_OUTPUTS = ("screen", "log", "both")


@dataclass
class Plan:
    """Result of evaluating a launch file.

    Attributes
    ----------
    processes : list of Process
        In the order in which they are to be started.
    warnings : list of str
        Probable mistakes that the real launch accepts.
    messages : list of str
        What the file logs.
    declared : set of str
        Names of the arguments that the file and those it includes declare.
    """

    processes: list[Process] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)
    declared: set[str] = field(default_factory=set)


def evaluate(file: Path, arguments: Mapping[str, str], environment: Mapping[str, str], parameter_folder: Path) -> Plan:
    """Evaluate a launch file.

    Parameters
    ----------
    file : Path
        The launch file.
    arguments : mapping of str to str
        Values of its arguments; undeclared ones become variables as well, as in the real launch.
    environment : mapping of str to str
        Environment to find packages in, and of the processes, with the file's `set_env` added.
    parameter_folder : Path
        Folder for the params files made from `param name value`; made with the first of them where it does not exist.

    Returns
    -------
    Plan
        The processes to start.

    Raises
    ------
    LaunchError
        For an error in the file or those it includes, with file and line.
    """
    actions = parse_file(file)
    _check_required(actions, given=list(arguments), where=f"{file}: ")
    evaluator = _Evaluator(parameter_folder)
    evaluator.visit(actions, Scope(dict(arguments), dict(environment), file), depth=0)
    return evaluator.plan


def declarations(actions: tuple[AnyAction, ...], conditional: bool = False) -> Iterator[tuple[DeclareArgument, bool]]:
    """The arguments that a file declares itself, each with whether it depends on a condition."""
    for action in actions:
        under_condition = conditional or action.condition is not None
        if isinstance(action, DeclareArgument):
            yield action, under_condition
        elif isinstance(action, Group):
            yield from declarations(action.actions, under_condition)


def _check_required(actions: tuple[AnyAction, ...], given: list[str], where: str) -> None:
    for argument, conditional in declarations(actions):
        if not conditional and argument.default is None and argument.name not in given:
            raise LaunchError(
                f"{where}Included launch description missing required argument '{argument.name}' "
                f"(description: '{argument.description}'), given: [{', '.join(given)}]"
            )


class _Evaluator:
    """Visits actions in order, like the real launch, and collects the processes."""

    def __init__(self, parameter_folder: Path) -> None:
        self.plan = Plan()
        self._parameter_folder = parameter_folder
        self._node_names: dict[str, int] = {}

    def visit(self, actions: tuple[AnyAction, ...], scope: Scope, depth: int) -> None:
        for action in actions:
            with located(action.place):
                if isinstance(action, DeclareArgument):
                    self.plan.declared.add(action.name)
                if _holds(action.condition, scope):
                    self._execute(action, scope, depth)

    def _execute(self, action: AnyAction, scope: Scope, depth: int) -> None:
        if isinstance(action, DeclareArgument):
            _declare(action, scope)
        elif isinstance(action, SetVariable):
            scope.variables[substitutions.perform(action.name, scope)] = substitutions.perform(action.value, scope)
        elif isinstance(action, SetEnvironment):
            scope.environment[substitutions.perform(action.name, scope)] = substitutions.perform(action.value, scope)
        elif isinstance(action, PushNamespace):
            _push_namespace(substitutions.perform(action.namespace, scope), scope)
        elif isinstance(action, Log):
            self.plan.messages.append(substitutions.perform(action.message, scope))
        elif isinstance(action, Group):
            inner = Scope(dict(scope.variables), dict(scope.environment), scope.file) if action.scoped else scope
            self.visit(action.actions, inner, depth)
        elif isinstance(action, Include):
            self._include(action, scope, depth)
        elif isinstance(action, Executable):
            self._executable(action, scope)
        else:
            self._node(action, scope)

    def _include(self, action: Include, scope: Scope, depth: int) -> None:
        if depth >= _MAXIMUM_DEPTH:
            raise LaunchError(f"more than {_MAXIMUM_DEPTH} includes within one another: does a file include itself?")
        file = Path(substitutions.perform(action.file, scope))
        if not file.is_file():
            raise LaunchError(f"the launch file to include does not exist: '{file}'")
        if not file.name.endswith(".xml"):
            raise LaunchError(f"cannot include '{file}': acts launch reads XML launch files only")
        # As in the real launch, included files change the variables of this scope, and their arguments stay set.
        inner = Scope(scope.variables, scope.environment, file.absolute())
        actions = parse_file(inner.file)
        values = [(substitutions.perform(name, inner), value) for name, value in action.arguments]
        _check_required(actions, given=[name for name, _ in values], where="")
        for name, value in values:
            scope.variables[name] = substitutions.perform(value, inner)
        self.visit(actions, inner, depth + 1)

    def _node(self, node: Node, scope: Scope) -> None:
        program = _program(node, scope)
        command = [str(program), *(substitutions.perform(word, scope) for word in node.arguments), "--ros-args"]
        name = None if node.name is None else _node_name(substitutions.perform(node.name, scope))
        if name is not None:
            command += ["-r", f"__node:={name}"]
        namespace = _node_namespace(node, scope)
        if namespace is not None:
            command += ["-r", f"__ns:={namespace}"]
        full_name = None if name is None or namespace is None else f"{namespace.rstrip('/')}/{name}"
        files = []
        for parameter in node.parameters:
            with located(parameter.place):
                if isinstance(parameter, ParameterFile):
                    path = Path(substitutions.perform(parameter.path, scope))
                    if not path.is_file():
                        raise LaunchError(f"Parameter file path is not a file: {path}")
                else:
                    key = substitutions.perform(parameter.name, scope)
                    value = parameters.evaluate(parameter.content, parameter.type_name, scope)
                    path = self._write_parameter(full_name or "/**", key, value)
                    files.append(path)
                command += ["--params-file", str(path)]
        for source, target in node.remaps:
            command += ["-r", f"{substitutions.perform(source, scope)}:={substitutions.perform(target, scope)}"]
        if full_name is not None:
            self._count(full_name)
        self.plan.processes.append(
            Process(
                label=f"{program.name}-{len(self.plan.processes) + 1}",
                command=tuple(command),
                environment=dict(scope.environment),
                output=_output(node, scope),
                respawn=bool(parameters.coerce(substitutions.perform(node.respawn, scope), "bool")),
                respawn_delay_s=node.respawn_delay_s,
                parameter_files=tuple(files),
            )
        )

    def _executable(self, action: Executable, scope: Scope) -> None:
        words = [substitutions.perform(word, scope) for word in action.command]
        environment = dict(scope.environment)
        for variable, value in action.environment:
            environment[substitutions.perform(variable, scope)] = substitutions.perform(value, scope)
        # As the system looks it up, where the process has a PATH of its own.
        program = _on_path(words[0], environment)
        name = program.name if action.name is None else substitutions.perform(action.name, scope)
        self.plan.processes.append(
            Process(
                label=f"{name}-{len(self.plan.processes) + 1}",
                command=(str(program), *words[1:]),
                environment=environment,
                output=_output(action, scope),
                respawn=bool(parameters.coerce(substitutions.perform(action.respawn, scope), "bool")),
                respawn_delay_s=action.respawn_delay_s,
            )
        )

    def _write_parameter(self, node: str, name: str, value: parameters.Scalar | list[parameters.Scalar]) -> Path:
        self._parameter_folder.mkdir(mode=0o700, exist_ok=True)
        number = sum(1 for _ in self._parameter_folder.iterdir())
        path = self._parameter_folder / f"launch_params_{number}.yaml"
        path.write_text(yaml.safe_dump({node: {"ros__parameters": {name: value}}}, default_flow_style=False))
        return path

    def _count(self, name: str) -> None:
        self._node_names[name] = self._node_names.get(name, 0) + 1
        if self._node_names[name] > 1:
            self.plan.warnings.append(
                f"there are now at least {self._node_names[name]} nodes with the name {name} "
                "created within this launch context"
            )


def _holds(condition: Condition | None, scope: Scope) -> bool:
    if condition is None:
        return True
    value = substitutions.perform(condition.expression, scope).strip().lower()
    if value not in ("true", "1", "false", "0"):
        raise LaunchError(
            f"invalid condition expression, expected one of [true, 1, false, 0] but got '{value}', "
            f"expanded from {substitutions.describe(condition.expression)}"
        )
    return (value in ("true", "1")) == condition.wanted


def _declare(argument: DeclareArgument, scope: Scope) -> None:
    if argument.name not in scope.variables:
        if argument.default is None:
            raise LaunchError(f'Required launch argument "{argument.name}" was not provided.')
        scope.variables[argument.name] = substitutions.perform(argument.default, scope)
    value = scope.variables[argument.name]
    if argument.choices and value not in argument.choices:
        raise LaunchError(
            f'Argument "{argument.name}" provided value "{value}" is not valid. '
            f"Valid options are: {list(argument.choices)}"
        )


def _push_namespace(pushed: str, scope: Scope) -> None:
    previous = scope.variables.get(_NAMESPACE_VARIABLE)
    namespace = _absolute(_joined(previous, pushed))
    if not _is_namespace(namespace):
        within = f" within '{previous}'" if previous else ""
        raise LaunchError(f"'{pushed}'{within} is no namespace: allowed are {ALLOWED}, parts with one / between")
    scope.variables[_NAMESPACE_VARIABLE] = namespace


def _node_namespace(node: Node, scope: Scope) -> str | None:
    own = None if node.namespace is None else substitutions.perform(node.namespace, scope)
    pushed = scope.variables.get(_NAMESPACE_VARIABLE)
    if own is None:
        return None if pushed is None else _absolute(pushed)
    namespace = _absolute(_joined(pushed, own))
    if not _is_namespace(namespace):
        raise LaunchError(f"'{namespace}' is no namespace: allowed are {ALLOWED}, parts with one / between")
    return namespace


def _joined(base: str | None, namespace: str) -> str:
    relative = bool(base) and not namespace.startswith("/")
    joined = f"{'' if base == '/' else base}/{namespace}" if relative else namespace
    return joined if joined == "/" else joined.rstrip("/")


def _absolute(namespace: str) -> str:
    return namespace if namespace.startswith("/") else f"/{namespace}"


def _is_namespace(text: str) -> bool:
    return text == "/" or is_full_name(text)


def _node_name(name: str) -> str:
    if not is_name(name):
        raise LaunchError(f"'{name}' is no name of a node: allowed are {ALLOWED}")
    return name


def _program(node: Node, scope: Scope) -> Path:
    name = substitutions.perform(node.executable, scope)
    if node.package is not None:
        return packages.executable(substitutions.perform(node.package, scope), name, scope.environment)
    return _on_path(name, scope.environment)


def _on_path(name: str, environment: Mapping[str, str]) -> Path:
    found = shutil.which(name, path=environment.get("PATH"))
    if found is None:
        raise LaunchError(f"executable '{name}' not found on the PATH")
    return Path(found)


def _output(action: Node | Executable, scope: Scope) -> str:
    output = os.environ.get("OVERRIDE_LAUNCH_PROCESS_OUTPUT") or substitutions.perform(action.output, scope)
    if output not in _OUTPUTS:
        raise LaunchError(f'{output} is not a valid standard output config i.e. "screen", "log" or "both"')
    return output
