# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts call`: ask a running node to do something, also on machines without the `ros2` command."""

from __future__ import annotations

import argparse
import sys
import time
from typing import TYPE_CHECKING

from acts_core.errors import ActsError, SettingsError
from acts_core.names import full_name
from acts_tools.running.calls import FOUND_S

if TYPE_CHECKING:
    from rclpy.executors import Executor
    from rclpy.node import Node

_LIST_S, _LOOK_S = 2.0, 0.1
_TRIGGER = "std_srvs/srv/Trigger"

_EPILOG = """\
examples:
  acts call                               the services that running nodes offer
  acts call /hand/hand_reflexes/grasp     close the hand
  acts call /plate/ball_control/stop      stop the robot

Services of the type std_srvs/srv/Trigger are meant, which take nothing but the call.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``call`` to the acts command."""
    parser = subparsers.add_parser(
        "call",
        help="call a service of a running node, such as grasp or stop",
        description="Call a service of a running node and print its answer; without a name, list those there are.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "service", nargs="?", metavar="SERVICE", help="its full name, such as /hand/hand_reflexes/grasp"
    )


def run(arguments: argparse.Namespace) -> int:
    """Call or list, and return the exit code.

    Raises
    ------
    SettingsError
        There is no such service, or it is of another type.
    ActsError
        The node refuses, or does not answer.
    """
    name = "" if arguments.service is None else full_name(arguments.service, "name of a service")
    # Imported here: rclpy takes a second.
    from rclpy.executors import SingleThreadedExecutor
    from std_srvs.srv import Trigger

    from acts_tools.running.calls import call
    from acts_tools.running.node import command_node

    with command_node("acts_call_command", SingleThreadedExecutor) as (node, executor):
        if not name:
            return _list(node, executor)
        _require_trigger(node, executor, name)
        answer = call(node, executor, Trigger, name, Trigger.Request(), who="node", error=ActsError)
    if not answer.success:
        raise ActsError(answer.message or f"{name} has refused, without a reason")
    print(answer.message or "done")
    return 0


def _list(node: Node, executor: Executor) -> int:
    """Print the services that can be called; the exit code."""
    from acts_ros.executor import spin_for

    spin_for(executor, _LIST_S)
    names = sorted(name for name, types in node.get_service_names_and_types() if _TRIGGER in types)
    if not names:
        print(f"nobody offers a {_TRIGGER}: is something launched, with this ROS_DOMAIN_ID?", file=sys.stderr)
        return 1
    print("\n".join(names))
    return 0


def _require_trigger(node: Node, executor: Executor, name: str) -> None:
    """Wait for a service, and refuse one that takes more than a call."""
    from acts_ros.executor import spin_for
    from acts_tools.running.near_names import did_you_mean

    deadline_s = time.monotonic() + FOUND_S
    while (types := dict(node.get_service_names_and_types()).get(name)) is None:
        if time.monotonic() > deadline_s:
            triggers = (one for one, types in node.get_service_names_and_types() if _TRIGGER in types)
            raise SettingsError(
                f"no node offers {name}: is it launched (a first start takes up to a minute), with this ROS_DOMAIN_ID? "
                "`acts call` lists those there are" + did_you_mean(name, triggers)
            )
        spin_for(executor, _LOOK_S)
    if _TRIGGER not in types:
        raise SettingsError(f"{name} is of the type {', '.join(types)}; allowed is {_TRIGGER}")
