# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Any message out of its bytes, which may be damaged: anybody may have sent or recorded them."""

from __future__ import annotations

from typing import TypeVar

from rclpy.serialization import deserialize_message

from acts_core.errors import PacketError

_Message = TypeVar("_Message")


def message_of(data: bytes, kind: type[_Message]) -> _Message:
    """A message of a type, such as `sensor_msgs.msg.Image`, out of its bytes.

    Raises
    ------
    PacketError
        The bytes are no such message.
    """
    try:
        message = deserialize_message(data, kind)
    # rclpy has no exception of its own for bytes that are no such message.
    except (RuntimeError, ValueError) as error:
        raise PacketError(str(error)) from error
    except TypeError as error:
        # rclpy turns Ctrl-C while the message is made into this.
        if isinstance(error.__cause__, KeyboardInterrupt):
            raise error.__cause__ from None
        raise
    assert isinstance(message, kind)
    return message
