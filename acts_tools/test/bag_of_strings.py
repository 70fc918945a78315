# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A bag whose messages and stamps are known."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from acts_ros.bags.message_types import Definitions
from acts_ros.bags.writing import BagWriter


def make_bag(path: Path, topics: dict[str, str], stamps_ms: list[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """A bag of strings with known stamps; topics in turn."""
    clock = iter(stamp * 10**6 for stamp in stamps_ms)
    bag = BagWriter(path)
    definition, type_hash = Definitions().describe("std_msgs/msg/String")
    handles = [bag.add_topic(topic, kind, definition, type_hash, []) for topic, kind in topics.items()]
    with monkeypatch.context() as patched:
        patched.setattr(time, "time_ns", lambda: next(clock))
        for index in range(len(stamps_ms)):
            text = str(index).encode() + b"\0"
            data = b"\0\1\0\0" + len(text).to_bytes(4, "little") + text
            bag.write(handles[index % len(handles)], data)
    bag.close()
