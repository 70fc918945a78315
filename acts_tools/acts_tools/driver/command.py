# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts driver`: control a running driver, also on machines without the `ros2` command."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from acts_core.errors import BoardError, SettingsError
from acts_core.files import path_of
from acts_core.names import full_name
from acts_core.settings import from_text, is_given
from acts_core.skin import LAYOUTS, layout_path
from acts_tools.running.calls import ANSWER_S, FOUND_S
from acts_tools.running.near_names import did_you_mean

_SERVICES = {"query": "query_board", "calibrate": "calibrate", "tare": "tare"}
# As lifecycle_msgs/msg/Transition numbers them.
_TRANSITIONS = {"configure": 1, "cleanup": 2, "activate": 3, "deactivate": 4}
# Which of them, by the state.
_ALLOWED = {"unconfigured": ("configure",), "inactive": ("activate", "cleanup"), "active": ("deactivate",)}

_EPILOG = """\
examples:
  acts driver query                        which board, firmware and settings
  acts driver calibrate                    leave the skin alone for 3 s before
  acts driver tare                         whatever lies on the skin now reads 0
  acts driver set scheme=tracking m=128    all of them or none
  acts driver -n left_hand query           the driver of another skin
  acts driver deactivate                   it reads the board, but publishes nothing
  acts driver cleanup                      ... and now it has closed the port

docs/driver.md lists the parameters that can be set.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``driver`` to the acts command."""
    parser = subparsers.add_parser(
        "driver",
        help="control a running driver",
        description="Query the board of a running driver, calibrate or tare it, set parameters of the board, or change "
        "the driver's state: configure opens the port, activate publishes, deactivate and cleanup take these back.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("-n", "--namespace", default="plate", help="namespace of the skin (default: plate)")
    parser.add_argument("what", choices=(*_SERVICES, "set", *_TRANSITIONS))
    parser.add_argument("values", nargs="*", default=[], metavar="NAME=VALUE", help="parameters, with set")


def run(arguments: argparse.Namespace) -> int:
    """Call the driver and print its reply; return the exit code.

    Raises
    ------
    BoardError
        The driver refuses, or does not answer.
    SettingsError
        The command line is none that the driver could be asked.
    """
    is_set = arguments.what == "set"
    if bool(arguments.values) != is_set:
        raise SettingsError(
            "`acts driver set` takes parameters, such as m=128; the others take none; -n NAMESPACE says which driver"
        )
    values = parameters_of(arguments.values)
    namespace = arguments.namespace.strip("/")
    node = f"{full_name(namespace, 'namespace', has_names_below=True)}/driver" if namespace else "/driver"
    # Imported here: rclpy takes a second, and an invalid parameter is reported without it.
    from rcl_interfaces.srv import SetParametersAtomically
    from rclpy.parameter import Parameter
    from std_srvs.srv import Trigger

    if arguments.what in _TRANSITIONS:
        succeeded, words = _change_state(node, arguments.what)
    elif is_set:
        request = SetParametersAtomically.Request()
        request.parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        # All nodes have that service: what may be meant is another driver, not the service of another node.
        service = f"{node}/set_parameters_atomically"
        result = _call(SetParametersAtomically, service, request, node_name=node, is_repeatable=True).result
        succeeded, words = result.successful, result.reason or "set: " + ", ".join(arguments.values)
    else:
        name = f"{node}/{_SERVICES[arguments.what]}"
        response = _call(Trigger, name, Trigger.Request(), is_repeatable=arguments.what == "query")
        succeeded, words = response.success, response.message
    # What a query gives is a report, of a board that is not well too.
    if not succeeded and arguments.what != "query":
        raise BoardError(words)
    print(words, file=sys.stdout if succeeded else sys.stderr)
    return 0 if succeeded else 1


def _change_state(node: str, transition: str) -> tuple[bool, str]:
    """Change a driver's state; whether that was done, and the state it is in then."""
    from lifecycle_msgs.srv import ChangeState, GetState

    request = ChangeState.Request()
    request.transition.id = _TRANSITIONS[transition]
    is_done = _call(ChangeState, f"{node}/change_state", request).success
    state = _call(GetState, f"{node}/get_state", GetState.Request(), is_repeatable=True).current_state.label
    if is_done:
        return True, state
    allowed = _ALLOWED.get(state, ())
    if transition in allowed:
        return False, f"{node} did not {transition} and is {state}; its log has the reason"
    return False, f"{node} is {state}: allowed is {' or '.join(allowed) or 'nothing yet, ask again'}, not {transition}"


def parameters_of(words: list[str]) -> dict[str, Any]:
    """Parameters of the board from ``NAME=VALUE``, with their declared types.

    Raises
    ------
    SettingsError
        There is no such parameter, or the value has another type or is out of range.
    ArrayError
        A layout is neither a known name nor a path.
    """
    from acts_driver.board import BOARD_PARAMETERS, BoardParameters

    values: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals or name not in BOARD_PARAMETERS:
            hint = did_you_mean(name, BOARD_PARAMETERS)
            raise SettingsError(f"{word}: needed is NAME=VALUE with one of {', '.join(BOARD_PARAMETERS)}{hint}")
        if name in values:
            raise SettingsError(f"{word}: {name} is given twice; give it once")
        text = _ABSOLUTE[name](text) if name in _ABSOLUTE else text
        # ROS would refuse a number out of range before the driver sees it, without saying what the parameter is.
        values[name] = from_text(BoardParameters, name, text)
    return values


def _absolute_model(path: str) -> str:
    return str(path_of(path, error=SettingsError).absolute()) if is_given(path) else path


def _absolute_layout(name_or_path: str) -> str:
    return name_or_path if name_or_path in ("", *LAYOUTS) else str(layout_path(name_or_path).absolute())


_ABSOLUTE = {"model": _absolute_model, "layout": _absolute_layout}
"""What a driver, which has another working directory, is told of parameters that name a file."""


def _call(kind: Any, name: str, request: Any, node_name: str = "", is_repeatable: bool = False) -> Any:
    from rclpy.executors import SingleThreadedExecutor

    from acts_tools.running.calls import call
    from acts_tools.running.node import command_node

    with command_node("acts_driver_command", SingleThreadedExecutor) as (node, executor):
        options: dict[str, Any] = {"found_s": FOUND_S, "answer_s": ANSWER_S, "node_name": node_name}
        options["is_repeatable"] = is_repeatable
        return call(node, executor, kind, name, request, who="driver", error=BoardError, **options)
