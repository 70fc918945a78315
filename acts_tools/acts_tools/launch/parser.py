# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parse XML launch files to actions. Unsupported features are refused by name, with the messages of the real launch."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from pathlib import Path

from acts_core.errors import LaunchError
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
    ParameterValue,
    PushNamespace,
    SetEnvironment,
    SetVariable,
)
from acts_tools.launch.place import located
from acts_tools.launch.substitutions import Template, Text, unescape
from acts_tools.launch.xml_tree import Element, read_xml


def parse_file(path: Path) -> tuple[AnyAction, ...]:
    """Parse a launch file.

    Parameters
    ----------
    path : Path
        An XML launch file.

    Returns
    -------
    tuple of actions
        In the order of the file.

    Raises
    ------
    LaunchError
        It cannot be read, is not valid, or uses an unsupported feature; with file and line.
    """
    root = read_xml(path)
    if root.tag != "launch":
        raise root.error("Expected 'launch' as root tag")
    root.finish()
    return _actions(root.children)


def _actions(elements: list[Element]) -> tuple[AnyAction, ...]:
    return tuple(_action(element) for element in elements)


def _action(element: Element) -> AnyAction:
    parse = _TAGS.get(element.tag)
    if parse is None:
        raise element.error(
            f"Unrecognized entity of the type: {element.tag} (acts launch supports: {', '.join(sorted(_TAGS))})"
        )
    with located(element.place):
        action = parse(element, _condition(element))
    element.finish()
    return action


def _condition(element: Element) -> Condition | None:
    wanted, unwanted = element.get("if"), element.get("unless")
    if wanted is not None and unwanted is not None:
        raise element.error("if and unless conditions can't be used simultaneously")
    if wanted is not None:
        return Condition(substitutions.parse(wanted), True)
    if unwanted is not None:
        return Condition(substitutions.parse(unwanted), False)
    return None


def _required(element: Element, name: str) -> Template:
    return substitutions.parse(element.require(name))


def _optional(element: Element, name: str) -> Template | None:
    value = element.get(name)
    return None if value is None else substitutions.parse(value)


def _pair(element: Element, first: str, second: str) -> tuple[Template, Template]:
    """The two attributes of a child that has nothing else, such as `remap`."""
    element.take()
    with located(element.place):
        pair = _required(element, first), _required(element, second)
    element.finish()
    return pair


def _declare(element: Element, condition: Condition | None) -> DeclareArgument:
    choices = tuple(_choice(child) for child in element.take("choice"))
    return DeclareArgument(
        place=element.place,
        condition=condition,
        name=unescape(element.require("name")),
        default=_optional(element, "default"),
        description=_description(element.get("description"), choices),
        choices=choices,
    )


def _choice(element: Element) -> str:
    element.take()
    value = unescape(element.require("value"))
    element.finish()
    return value


def _description(text: str | None, choices: tuple[str, ...]) -> str:
    if text is None:
        return f"One of: {list(choices)}" if choices else "no description given"
    described = unescape(text)
    if not choices:
        return described
    return f"{described}{'' if described.endswith('.') else '.'} Valid choices are: {list(choices)}"


def _let(element: Element, condition: Condition | None) -> SetVariable:
    element.take()
    return SetVariable(
        place=element.place,
        condition=condition,
        name=_required(element, "name"),
        value=_required(element, "value"),
    )


def _set_env(element: Element, condition: Condition | None) -> SetEnvironment:
    element.take()
    return SetEnvironment(
        place=element.place,
        condition=condition,
        name=_required(element, "name"),
        value=_required(element, "value"),
    )


def _push_namespace(element: Element, condition: Condition | None) -> PushNamespace:
    element.take()
    return PushNamespace(place=element.place, condition=condition, namespace=_required(element, "namespace"))


def _log(element: Element, condition: Condition | None) -> Log:
    element.take()
    return Log(place=element.place, condition=condition, message=_required(element, "message"))


def _group(element: Element, condition: Condition | None) -> Group:
    scoped = element.get("scoped")
    return Group(
        place=element.place,
        condition=condition,
        scoped=True if scoped is None else bool(parameters.coerce(scoped, "bool")),
        actions=_actions(element.children),
    )


def _include(element: Element, condition: Condition | None) -> Include:
    arguments = tuple(_pair(child, "name", "value") for child in element.take("arg"))
    return Include(
        place=element.place,
        condition=condition,
        file=_required(element, "file"),
        arguments=arguments,
    )


def _node(element: Element, condition: Condition | None) -> Node:
    children = element.take("param", "remap")
    return Node(
        place=element.place,
        condition=condition,
        package=_optional(element, "pkg"),
        executable=_required(element, "exec"),
        name=_optional(element, "name"),
        namespace=_optional(element, "namespace"),
        output=_optional(element, "output") or (Text("log"),),
        arguments=_command_line(element.get("args")),
        respawn=_optional(element, "respawn") or (Text("false"),),
        respawn_delay_s=_delay(element),
        parameters=tuple(_parameter(child) for child in children if child.tag == "param"),
        remaps=tuple(_pair(child, "from", "to") for child in children if child.tag == "remap"),
    )


def _executable(element: Element, condition: Condition | None) -> Executable:
    variables = tuple(_pair(child, "name", "value") for child in element.take("env"))
    command = _command_line(element.require("cmd"))
    if not command:
        raise element.error("cmd is empty: needed is a program and its arguments")
    return Executable(
        place=element.place,
        condition=condition,
        command=command,
        name=_optional(element, "name"),
        environment=variables,
        output=_optional(element, "output") or (Text("log"),),
        respawn=_optional(element, "respawn") or (Text("false"),),
        respawn_delay_s=_delay(element),
    )


def _delay(element: Element) -> float:
    text = element.get("respawn_delay")
    if text is None:
        return 0.0
    try:
        delay_s = float(text)
    except ValueError:
        delay_s = float("nan")
    if not 0.0 <= delay_s < float("inf"):
        raise element.error(
            f"Attribute respawn_delay of Entity {element.tag} expected to be a non-negative value but got `{text}`"
        )
    return delay_s


def _parameter(element: Element) -> ParameterFile | ParameterValue:
    element.take()
    with located(element.place):
        path, name, value, type_name = (
            _optional(element, "from"),
            _optional(element, "name"),
            element.get("value"),
            element.get("type"),
        )
        if path is not None and name is not None:
            raise LaunchError("name and from attributes are mutually exclusive")
        if path is not None:
            if value is not None or type_name is not None:
                raise LaunchError("Unexpected attribute(s) found in `param`: value and type do not go with from")
            parsed: ParameterFile | ParameterValue = ParameterFile(element.place, path)
        elif name is None:
            raise LaunchError("param Entity should have name or from attribute")
        elif value is None:
            raise LaunchError("either a value attribute or nested params are needed (nested ones are not supported)")
        elif type_name is not None and type_name not in parameters.TYPE_NAMES:
            raise LaunchError(f"Got invalid type identifier '{type_name}' (known: {', '.join(parameters.TYPE_NAMES)})")
        else:
            parsed = ParameterValue(element.place, name, parameters.read(value, type_name), type_name)
    element.finish()
    return parsed


def _command_line(text: str | None) -> tuple[Template, ...]:
    """Words of `args`: text is split like in a shell, but values of substitutions are not split."""
    if text is None:
        return ()
    words: list[Template] = []
    word: list[Text | substitutions.Substitution] = []

    def finish_word() -> None:
        words.append(tuple(word))
        word.clear()

    for piece in substitutions.parse(text):
        if not isinstance(piece, Text):
            word.append(piece)
            continue
        tokens = _split(piece.text)
        if not tokens:
            finish_word()
            continue
        if piece.text[0].isspace() and word:
            finish_word()
        word.append(Text(tokens[0]))
        for token in tokens[1:]:
            finish_word()
            word.append(Text(token))
        if piece.text[-1].isspace():
            finish_word()
    if word:
        finish_word()
    return tuple(words)


def _split(text: str) -> list[str]:
    try:
        return shlex.split(text)
    except ValueError as error:
        raise LaunchError(f"cannot split args into words: {error} in `{text}`") from error


_TAGS: dict[str, Callable[[Element, Condition | None], AnyAction]] = {
    "arg": _declare,
    "let": _let,
    "set_env": _set_env,
    "push-ros-namespace": _push_namespace,
    "push_ros_namespace": _push_namespace,
    "log": _log,
    "group": _group,
    "include": _include,
    "node": _node,
    "executable": _executable,
}
