# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The board in ROS: topic `board`, service `~/query_board`."""

from __future__ import annotations

from collections.abc import Callable

from rclpy.lifecycle import LifecycleNode
from std_srvs.srv import Trigger

from acts_core.errors import ActsError
from acts_core.settings import describe
from acts_core.wire import BoardSettings
from acts_core.words import counted
from acts_driver.board import BoardSession, BoardStatus, settings_in_words, version_in_words
from acts_msgs.msg import BoardState
from acts_ros.publishers import published
from acts_ros.qos import LATCHED


class BoardInterface:
    """Publishes what is known of the board whenever it changes, and asks it on request.

    Parameters
    ----------
    node : LifecycleNode
        The driver.
    frame_id : str
        Of the header.
    frames : callable
        Says whether usable frames come, and in words what comes; for the answer to a question.
    """

    def __init__(self, node: LifecycleNode, frame_id: str, frames: Callable[[], tuple[bool, str]]) -> None:
        self._node = node
        self._frame_id = frame_id
        self._frames = frames
        self._publisher = node.create_publisher(BoardState, "board", **published(LATCHED))
        node.create_service(Trigger, "~/query_board", self._on_query)
        self.session: BoardSession | None = None

    def publish(self, status: BoardStatus) -> None:
        """Publish what has changed; from any thread."""
        message = board_message(status)
        message.header.frame_id = self._frame_id
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._publisher.publish(message)

    def _on_query(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        session = self.session
        has_frames, frames = self._frames()
        if session is None:
            response.message = f"no board is asked: there is none that takes commands; {frames}"
            return response
        try:
            state = session.ask()
        except ActsError as error:
            response.message = f"{error}; {frames}"
            return response
        # A board that replies but sends no usable frames is no success.
        response.success = has_frames and not session.status.problem
        response.message = (
            f"board {state.board_id}, firmware {version_in_words(state)}, up {state.uptime_us * 1e-6:.1f} s: "
            f"{settings_in_words(state.settings)}; model {state.model.kind.name.lower()}, "
            f"{counted(state.overruns, 'overrun')}, {counted(state.bad_commands, 'bad command')}"
            + (f"; {session.status.problem}" if session.status.problem else "")
            + f"; {frames}"
        )
        return response


def board_message(status: BoardStatus) -> BoardState:
    """The message of a status, without header."""
    message = BoardState(answers=status.state is not None, problem=status.problem)
    state = status.state
    if state is None:
        return message
    settings, model = state.settings, state.model
    message.board_id = state.board_id
    message.firmware_version = version_in_words(state)
    # A new scheme's own settings have no field of the message unless somebody gives them one.
    for name in describe(BoardSettings).keys() & message.get_fields_and_field_types().keys():
        setattr(message, name, getattr(settings, name))
    message.samples_only = state.samples_only
    message.model = model.kind.name.lower()
    message.model_rows = model.rows
    message.model_columns = model.columns
    message.model_crc32 = model.crc32
    message.model_capacity_bytes = state.model_capacity_bytes
    return message
