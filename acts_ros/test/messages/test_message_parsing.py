# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages of any type out of bytes, good and damaged ones."""

import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

from acts_core.errors import PacketError
from acts_ros.messages import message_of

MESSAGE = JointState(name=["thumb", "index"], position=[0.1, 0.2])
DATA = serialize_message(MESSAGE)


def test_a_message_comes_back() -> None:
    assert message_of(DATA, JointState) == MESSAGE


def test_ctrl_c_while_a_message_is_made_is_one(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(_message: JointState) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(JointState, "__init__", interrupted)
    with pytest.raises(KeyboardInterrupt):
        message_of(DATA, JointState)


@pytest.mark.parametrize("data", [b"", DATA[:3], DATA[:40], b"\xff" * 60], ids=["nothing", "header", "part", "garbage"])
def test_bytes_that_are_no_such_message_are_refused(data: bytes) -> None:
    with pytest.raises(PacketError):
        message_of(data, JointState)
