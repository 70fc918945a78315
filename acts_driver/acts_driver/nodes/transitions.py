# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Transitions of a lifecycle node that there are not from its state, or that rclpy does not complete."""

from __future__ import annotations

from collections.abc import Callable

from lifecycle_msgs.srv import ChangeState
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn

from acts_core.errors import ActsError
from acts_ros.middleware import reason_of

_BETWEEN_STATES = ("configuring", "cleaningup", "shuttingdown", "activating", "deactivating", "errorprocessing")


class TransitionError(ActsError):
    """A node is between two of its states and cannot leave there; its launch file starts it anew."""


def attempt(node: LifecycleNode, trigger: Callable[[], TransitionCallbackReturn]) -> TransitionCallbackReturn:
    """Change a node's state by one of its `trigger_...` methods.

    Raises
    ------
    TransitionError
        The node is left between two states.
    """
    try:
        result = trigger()
    except rclpy_implementation.RCLError as error:  # from rclpy of Humble and Jazzy; newer ones log it
        node.get_logger().error(reason_of(error))
        result = TransitionCallbackReturn.ERROR
    _require_state(node)
    return result


def answer_any(node: LifecycleNode) -> None:
    """Let the service `change_state` of a node refuse a transition that there is not from the present state.

    With rclpy of Humble and Jazzy it ends the node, whoever asks.
    """
    service = node._service_change_state
    change: Callable[[ChangeState.Request, ChangeState.Response], ChangeState.Response] = service.callback

    def on_request(request: ChangeState.Request, response: ChangeState.Response) -> ChangeState.Response:
        try:
            answer = change(request, response)
        except rclpy_implementation.RCLError as error:
            node.get_logger().error(reason_of(error))
            response.success = False
            answer = response
        _require_state(node)
        return answer

    service.callback = on_request


def _require_state(node: LifecycleNode) -> None:
    """Where the middleware did not take the message that tells of a transition, rclpy leaves the node in it."""
    _, label = node._state_machine.current_state
    if label in _BETWEEN_STATES:
        raise TransitionError(
            f"{node.get_fully_qualified_name()} is left between two states ({label}): the middleware did not take the "
            "message that tells of it; it has to be started anew"
        )
