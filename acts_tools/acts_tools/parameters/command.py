# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts param`: show and set parameters of a running node, also on machines without the `ros2` command."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from acts_core.errors import SettingsError
from acts_core.names import full_name
from acts_tools.running.calls import FOUND_S
from acts_tools.running.near_names import did_you_mean

if TYPE_CHECKING:
    from rcl_interfaces.msg import ParameterDescriptor, ParameterValue

_EPILOG = """\
examples:
  acts param /plate/ball_control               all parameters, with value and meaning
  acts param /plate/ball_control kp ki         some of them
  acts param /plate/ball_control kp=16 ki=10   set them: all of them or none

docs/reference.md says which can be set while the node runs.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``param`` to the acts command."""
    parser = subparsers.add_parser(
        "param",
        help="show and set parameters of a running node",
        description="Show parameters of a running node, or set them.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("node", metavar="NODE", help="its full name, such as /plate/reconstruction")
    parser.add_argument(
        "parameters", nargs="*", default=[], metavar="NAME[=VALUE]", help="names, or names with new values"
    )


def run(arguments: argparse.Namespace) -> int:
    """Show or set, and return the exit code.

    Raises
    ------
    SettingsError
        There is no such node or parameter, a value has another type, or the node refuses it.
    """
    node_name = full_name(arguments.node, "name of a node", has_names_below=True)
    pairs = [word.partition("=") for word in arguments.parameters]
    for name, equals, text in pairs:
        if not name:
            raise SettingsError(f"'{equals}{text}': needed is NAME to show a parameter, or NAME=VALUE to set it")
    if len({bool(equals) for _, equals, _ in pairs}) > 1:
        raise SettingsError("either names alone, to show them, or all with =VALUE, to set them")
    # Imported here: rclpy takes a second.
    from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParametersAtomically
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.parameter import Parameter

    from acts_tools.running.calls import call
    from acts_tools.running.node import command_node

    with command_node("acts_param_command", SingleThreadedExecutor) as (node, executor):

        def ask(kind: Any, service: str, **fields: Any) -> Any:
            name = f"{node_name}/{service}"
            request = kind.Request(**fields)
            options: dict[str, Any] = {"who": "node", "error": SettingsError, "found_s": FOUND_S}
            # To set is repeatable too: the same values again change nothing.
            return call(node, executor, kind, name, request, **options, node_name=node_name, is_repeatable=True)

        names: list[str] = ask(ListParameters, "list_parameters").result.names
        wanted = [name for name, _, _ in pairs] or sorted(
            name for name in names if not name.startswith("qos_overrides")
        )
        _require(node_name, wanted, names)
        descriptors = ask(DescribeParameters, "describe_parameters", names=wanted).descriptors
        if not pairs or not pairs[0][1]:
            values = ask(GetParameters, "get_parameters", names=wanted).values
            for descriptor, value in zip(descriptors, values, strict=True):
                print(_line(descriptor, value))
            return 0
        given = [
            Parameter(name, value=_typed(descriptor, text)).to_parameter_msg()
            for (name, _, text), descriptor in zip(pairs, descriptors, strict=True)
        ]
        result = ask(SetParametersAtomically, "set_parameters_atomically", parameters=given).result
    if not result.successful:
        raise SettingsError(result.reason or f"{node_name} refuses that, without a reason")
    print(f"set: {', '.join(arguments.parameters)}")
    return 0


def _require(node: str, wanted: Sequence[str], names: Sequence[str]) -> None:
    unknown = [name for name in wanted if name not in names]
    if unknown:
        hint = did_you_mean(unknown[0], names) if len(unknown) == 1 else ""
        raise SettingsError(
            f"{node} has no parameter {', '.join(unknown)}; `acts param {node}` lists those it has{hint}"
        )
    if len(set(wanted)) < len(wanted):
        raise SettingsError("a parameter is given twice; give it once")


def _line(descriptor: ParameterDescriptor, value: ParameterValue) -> str:
    """Such as ``kp: 18.0    # of the ball's position [1/s^2]; 0 to 100``."""
    from rclpy.parameter import parameter_value_to_python

    ranges = [*descriptor.floating_point_range, *descriptor.integer_range]
    notes = [descriptor.description] if descriptor.description else []
    notes += [f"{one.from_value:g} to {one.to_value:g}" for one in ranges]
    words = f"{descriptor.name}: {parameter_value_to_python(value)!r}"
    return f"{words}    # {'; '.join(notes)}" if notes else words


def _typed(descriptor: ParameterDescriptor, text: str) -> bool | int | float | str:
    """The value that a text means to a parameter of this type."""
    from rcl_interfaces.msg import ParameterType

    kind = descriptor.type
    if kind == ParameterType.PARAMETER_STRING:
        return _utf8(descriptor.name, text)
    try:
        if kind == ParameterType.PARAMETER_BOOL:
            return {"true": True, "false": False}[text.lower()]
        if kind == ParameterType.PARAMETER_INTEGER:
            return _integer(text)
        if kind == ParameterType.PARAMETER_DOUBLE:
            return float(text)
    except (KeyError, ValueError) as error:
        kinds = {
            ParameterType.PARAMETER_BOOL: "true or false",
            ParameterType.PARAMETER_INTEGER: "a whole number of 64 bits",
        }
        needed = kinds.get(kind, "a number")
        raise SettingsError(f"{descriptor.name} = '{text}': needed is {needed}") from error
    raise SettingsError(f"{descriptor.name} is neither a number, text, nor true or false: set it in a params file")


def _utf8(name: str, text: str) -> str:
    """The text, if a message can hold it: bytes of the command line that are no UTF-8 cannot be sent."""
    try:
        text.encode()
    except UnicodeEncodeError as error:
        raise SettingsError(f"{name} = {text!r}: needed is text in UTF-8") from error
    return text


def _integer(text: str) -> int:
    value = int(text)
    if not -(2**63) <= value < 2**63:
        raise ValueError(text)
    return value
