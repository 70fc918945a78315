# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Connections: how many there are and what waits for each is bounded; those that break off are told in one line now and
then. Knows no ROS.
"""

from __future__ import annotations

import asyncio
import logging
import socket
import time
from typing import Any

from websockets.asyncio.server import ServerConnection

from acts_core.runtime import LogCallback

MAX_CONNECTIONS = 256
"""Open at once, pages and downloads among them; each takes one of the process's file descriptors."""

# Enough for two pictures of 64 x 64: what waits in the system's buffers is old when it arrives.
_SEND_BUFFER_BYTES = 65536
_TOLD_EVERY_S = 10.0
_LONGEST = 200


class LimitedConnection(ServerConnection):
    """One that is closed at once where there are too many; those that ask for nothing would use up all descriptors.

    Parameters
    ----------
    present : set of LimitedConnection
        Those of the same server.
    """

    def __init__(self, *arguments: Any, present: set[LimitedConnection], **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._present = present

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """See `asyncio.Protocol`."""
        super().connection_made(transport)
        if len(self._present) >= MAX_CONNECTIONS:
            self.transport.abort()
        else:
            self._present.add(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """See `asyncio.Protocol`."""
        self._present.discard(self)
        super().connection_lost(exc)


class FailureLog(logging.Handler):
    """Takes what websockets and asyncio log of connections that fail: a traceback for each, at the will of any client.

    Parameters
    ----------
    log : LogCallback
    """

    def __init__(self, log: LogCallback) -> None:
        super().__init__(logging.WARNING)
        self._log = log
        self._told_s: float | None = None
        self._untold = 0

    def logger(self) -> logging.Logger:
        """A logger that hands everything to this."""
        logger = logging.Logger("page", logging.WARNING)
        logger.addHandler(self)
        return logger

    def emit(self, record: logging.LogRecord) -> None:
        """See `logging.Handler`."""
        self.tell(record.getMessage(), record.exc_info[1] if record.exc_info else None)

    def on_loop_failure(self, _loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Handle what nobody awaits; see `asyncio.loop.set_exception_handler`."""
        self.tell(context["message"], context.get("exception"))

    def tell(self, what: str, error: BaseException | None) -> None:
        """Log one line, unless there was one a short while ago."""
        now_s = time.monotonic()
        if self._told_s is not None and now_s - self._told_s < _TOLD_EVERY_S:
            self._untold += 1
            return
        # What the library found is in the cause: its own words are that a handshake failed.
        cause = error.__cause__ or error if error is not None else None
        why = "" if cause is None else f": {type(cause).__name__} {cause}"[:_LONGEST].rstrip()
        more = f"; {self._untold} more were not told" if self._untold else ""
        self._told_s, self._untold = now_s, 0
        self._log("warning", f"a connection to the page failed: {what}{why}{more}")


def bound_send_buffer(connection: ServerConnection) -> None:
    """Let the system keep little of what is sent: so it is soon seen what the client takes."""
    own = connection.transport.get_extra_info("socket")
    own.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER_BYTES)
