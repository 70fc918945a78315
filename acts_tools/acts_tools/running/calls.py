# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Call a service of a running node, for a command."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from acts_core.errors import ActsError
from acts_tools.running.near_names import did_you_mean

if TYPE_CHECKING:
    from rclpy.client import Client
    from rclpy.executors import Executor
    from rclpy.node import Node

FOUND_S = 10.0
"""How long a service may take to be found [s]."""

ANSWER_S = 30.0
"""How long its answer may take [s]."""

_LOOK_S = 0.5

_AGAIN_S = 3.0
"""After how long a question is asked again whose answer may be lost [s]."""


def call(
    node: Node,
    executor: Executor,
    kind: Any,
    name: str,
    request: Any,
    *,
    who: str,
    error: type[ActsError],
    found_s: float = FOUND_S,
    answer_s: float = ANSWER_S,
    node_name: str = "",
    is_repeatable: bool = False,
) -> Any:
    """What a service answers.

    An answer can be lost: DDS finds a client and its service independently of each other, and Fast DDS drops what a
    service answers to a client that it has not found 0.1 s later (https://github.com/ros2/rmw_fastrtps/issues/842).

    Parameters
    ----------
    node, executor
        As of `acts_tools.running.node.command_node`, with a `SingleThreadedExecutor`.
    kind, name, request
        Type of the service, its full name, and what it is asked.
    who : str
        Who offers it, in one word, for errors.
    error : type
        What to raise.
    found_s, answer_s : float
        Limits of time [s].
    node_name : str
        That with which `name` begins, where a user gives it and not the service.
    is_repeatable : bool
        Whether it does no harm to ask again, as for a parameter: then it is, while there is no answer.

    Raises
    ------
    error
        Nobody offers it, the middleware does not take the question, its node ends, or it does not answer.
    """
    # Imported here: the command line is read without ROS.
    from acts_ros.middleware import NotAskedError, ask

    client: Client[Any, Any] = node.create_client(kind, name)
    if not client.wait_for_service(timeout_sec=found_s):
        names = (one for one, _ in node.get_service_names_and_types())
        service = name.removeprefix(node_name) if node_name else ""
        hint = did_you_mean(node_name or name, (one.removesuffix(service) for one in names if one.endswith(service)))
        raise error(
            f"no {who} offers {name}: is it launched (a first start takes up to a minute), in this namespace and with "
            f"this ROS_DOMAIN_ID{hint or '?'}"
        )
    begin_s = time.monotonic()
    try:
        futures = [ask(client, request)]
        while True:
            executor.spin_until_future_complete(futures[-1], timeout_sec=_LOOK_S)
            for future in futures:
                if future.done():
                    return future.result()
            if not client.service_is_ready():
                raise error(f"{name} is gone and has not answered: the {who} has ended, see its output")
            waited_s = time.monotonic() - begin_s
            if waited_s > answer_s:
                raise error(
                    f"{name} has not answered within {answer_s:g} s: the {who} was killed or hangs, or its answer was "
                    "lost, see its output"
                )
            if is_repeatable and waited_s > _AGAIN_S * len(futures):
                futures.append(ask(client, request))
    except NotAskedError as refusal:
        raise error(str(refusal)) from refusal
