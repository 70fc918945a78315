# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Line-based protocol of dashboard, test hooks and control sockets: one line of reply to each line."""

from __future__ import annotations

from collections.abc import Callable

MAX_LINE_BYTES = 4096


class LineSession:
    """One client of a line-based port.

    Parameters
    ----------
    answer : callable
        Function from a line without its end to the line of reply.
    greeting : str
        Line sent to a new client; none when empty.
    """

    streaming = False

    def __init__(self, answer: Callable[[str], str], greeting: str = "") -> None:
        self.greeting = greeting.encode() + b"\n" if greeting else b""
        self._answer = answer
        self._buffer = b""

    def receive(self, data: bytes) -> bytes:
        """Replies to the lines that `data` completes. A line that is too long is dropped."""
        *lines, rest = (self._buffer + data).split(b"\n")
        self._buffer = rest if len(rest) <= MAX_LINE_BYTES else b""
        answers = []
        for line in lines:
            text = line[:MAX_LINE_BYTES].decode("ascii", errors="replace").strip()
            answers.append(self._answer(text).encode("ascii", errors="replace") + b"\n")
        return b"".join(answers)

    def tick(self) -> bytes:
        """Nothing to send without a request."""
        return b""

    def close(self) -> None:
        """Nothing to release."""
