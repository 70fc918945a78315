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
        # The present line is already too long: what comes of it up to its end is dropped.
        self._too_long = False

    def receive(self, data: bytes) -> bytes:
        """Replies to the lines that `data` completes. A line that is too long is not carried out: an error is told."""
        *lines, rest = (self._buffer + data).split(b"\n")
        answers = []
        for line in lines:
            if self._too_long or len(line) > MAX_LINE_BYTES:
                answer = f"error: the line is longer than {MAX_LINE_BYTES} bytes; nothing was done"
            else:
                answer = self._answer(line.decode("ascii", errors="replace").strip())
            answers.append(answer.encode("ascii", errors="replace") + b"\n")
            self._too_long = False
        self._too_long = self._too_long or len(rest) > MAX_LINE_BYTES
        self._buffer = b"" if self._too_long else rest
        return b"".join(answers)

    def tick(self) -> bytes:
        """Nothing to send without a request."""
        return b""

    def close(self) -> None:
        """Nothing to release."""
