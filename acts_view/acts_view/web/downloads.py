# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files that pages may have, sent in pieces as each page takes them. Knows no ROS."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from http import HTTPStatus
from pathlib import Path

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from acts_core.runtime import LogCallback
from acts_view.web.connections import bound_send_buffer

FILES_PATH = "/recordings/"
MAX_DOWNLOADS = 4
_PIECE_BYTES = 1 << 16
# What a slow line still holds of a file may take this long to arrive.
_LAST_PIECES_S = 60.0


class Downloads:
    """Sends files over sockets; all of it is for one thread, that of the event loop.

    Parameters
    ----------
    find : callable
        Gives the path of a file by its name, or None where pages may not have it.
    send_limit_s : float
        A page that takes nothing for so long gets no more [s].
    log : LogCallback
    """

    def __init__(self, find: Callable[[str], Path | None], send_limit_s: float, log: LogCallback) -> None:
        self._find = find
        self._send_limit_s = send_limit_s
        self._log = log
        self._count = 0

    def refusal(self, path: str) -> tuple[HTTPStatus, str] | None:
        """Why what is asked for is not sent; None where it is.

        Parameters
        ----------
        path : str
            That begins with `FILES_PATH`, without a query.
        """
        if self._file(path) is None:
            return HTTPStatus.NOT_FOUND, "there is no such recording"
        if self._count >= MAX_DOWNLOADS:
            return HTTPStatus.SERVICE_UNAVAILABLE, f"{MAX_DOWNLOADS} files are sent already"
        return None

    async def send(self, connection: ServerConnection, path: str) -> None:
        """Send a file that is not refused; it is whole where the socket is closed normally."""
        file = self._file(path)
        assert file is not None
        bound_send_buffer(connection)
        # Answers to both wait behind what a slow line holds, which may be megabytes, as of a tunnel.
        connection.ping_timeout, connection.close_timeout = None, _LAST_PIECES_S
        self._count += 1
        try:
            with await asyncio.to_thread(file.open, "rb") as stream:
                while piece := await asyncio.to_thread(stream.read, _PIECE_BYTES):
                    await asyncio.wait_for(connection.send(piece), self._send_limit_s)
        except ConnectionClosed:
            pass  # the page was closed, or does not want it any more
        except asyncio.TimeoutError:
            self._log("warning", f"{file} was not sent to its end: a page took nothing for {self._send_limit_s:g} s")
            connection.transport.abort()
        except OSError as error:
            self._log("warning", f"{file} was not sent to its end: {error}")
            connection.transport.abort()
        finally:
            self._count -= 1

    def _file(self, path: str) -> Path | None:
        return self._find(path.removeprefix(FILES_PATH))
