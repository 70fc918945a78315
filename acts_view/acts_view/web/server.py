# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page and its socket, by the library websockets, on a thread of its own. Knows no ROS."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from http import HTTPStatus
from pathlib import Path
from typing import Any

from websockets.asyncio.server import Server, ServerConnection, broadcast, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from acts_core.errors import ActsError, SettingsError, ViewRequestError
from acts_core.runtime import LogCallback
from acts_view.skin.snapshot import Frame, Sample, SkinShape
from acts_view.web.access import is_local_host, new_token, refusal
from acts_view.web.codec import encode
from acts_view.web.connections import FailureLog, LimitedConnection, bound_send_buffer
from acts_view.web.display import Display, Reader
from acts_view.web.downloads import FILES_PATH, Downloads
from acts_view.web.page_files import read_page, version_of
from acts_view.web.requests import STOPS, RequestHandler, read_request

STREAM_PATH = "/stream"
MAX_UNANSWERED = 4
READ_ONLY = "this page only shows; started with `acts view --control` it can also do that"
MAX_CLIENTS = 32
_LARGEST_REQUEST_BYTES = 1024
# A browser on a slow network sends its request within this.
_HANDSHAKE_S = 5.0
_METHODS = ("GET", "HEAD")
_HEADERS = {
    "Cache-Control": "no-cache",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    # Everything on the page is ours: nothing is loaded from elsewhere, and no other page may put it into a frame.
    "Content-Security-Policy": "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'; form-action 'none'",
}


@dataclass(frozen=True)
class Address:
    """Where the page is.

    Attributes
    ----------
    host : str
        Bound to.
    port : int
    token : str
        That the address must carry; empty on loopback.
    """

    host: str
    port: int
    token: str

    @property
    def url(self) -> str:
        """To be opened in a browser; where all addresses are bound to, with this machine's name."""
        host = socket.gethostname() if self.host in ("0.0.0.0", "::") else self.host
        query = f"?token={self.token}" if self.token else ""
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}/{query}"


@dataclass(eq=False)
class _Client:
    """A page.

    `stalled_s`: since when it has taken nothing of what it was sent; `waiting_bytes`: what it had still to take at
    the last look; `unanswered`: requests that are, without `STOPS`.
    """

    connection: ServerConnection
    reader: Reader
    stalled_s: float | None = None
    waiting_bytes: int = 0
    unanswered: int = 0


class ViewServer:
    """Serves the page and streams to it what is on a `Display`; begins with the constructor.

    Parameters
    ----------
    host, port : str, int
        To bind to; port 0: any that is free. Other hosts than this machine's own get a token.
    send_limit_s : float
        A client that takes nothing for so long is dropped [s].
    on_clients : callable
        Called with the number of clients whenever it changes, on the server's thread.
    log : LogCallback
    on_request : RequestHandler, optional
        Acts on what pages ask for; None: they are refused.
    find_file : callable, optional
        None: pages may have no files. See `acts_view.web.downloads.Downloads`; called on the server's thread.

    Raises
    ------
    SettingsError
        When the address cannot be bound to.
    """

    def __init__(
        self,
        host: str,
        port: int,
        *,
        send_limit_s: float = 5.0,
        on_clients: Callable[[int], None],
        log: LogCallback,
        on_request: RequestHandler | None = None,
        find_file: Callable[[str], Path | None] | None = None,
    ) -> None:
        self._display = Display()
        self._send_limit_s = send_limit_s
        self._on_clients = on_clients
        self._log = log
        self._on_request = on_request
        self._downloads = Downloads(find_file or (lambda _name: None), send_limit_s, log)
        self._files = read_page()
        self._version = version_of(self._files)
        self._clients: set[_Client] = set()
        self._token = "" if is_local_host(host) else new_token()
        self._failures = FailureLog(log)
        self._present: set[LimitedConnection] = set()
        self._loop = asyncio.new_event_loop()
        self._loop.set_exception_handler(self._failures.on_loop_failure)
        self._thread = threading.Thread(target=self._loop.run_forever, name="acts_view_server", daemon=True)
        self._thread.start()
        try:
            self._server = asyncio.run_coroutine_threadsafe(self._begin(host, port), self._loop).result()
        # UnicodeError: of a host that cannot be a name at all, such as "a..b".
        except (OSError, UnicodeError) as error:
            self._end_loop()
            reason = getattr(error, "strerror", None) or error
            raise SettingsError(
                f"cannot listen on {host} port {port}: {reason}; give another --port or --host, or "
                "view_port:=NUMBER to a launch"
            ) from error
        bound_port = next(iter(self._server.sockets)).getsockname()[1]
        self.address = Address(host, bound_port, self._token)

    def show_frame(self, name: str, frame: Frame, samples: Sequence[Sample]) -> None:
        """As `Display.show_frame`, from any thread."""
        self._show(self._display.show_frame, name, frame, samples)

    def forget(self, name: str) -> None:
        """As `Display.forget`, from any thread."""
        self._show(self._display.forget, name)

    def show_shape(self, name: str, shape: SkinShape, *, is_begun_anew: bool = False) -> None:
        """As `Display.show_shape`, from any thread."""
        self._show(partial(self._display.show_shape, is_begun_anew=is_begun_anew), name, shape)

    def show_status(self, status: dict[str, Any]) -> None:
        """As `Display.show_status`, from any thread."""
        self._show(self._display.show_status, {"version": self._version, **status})

    def every(self, period_s: float, call: Callable[[], float | None]) -> None:
        """Call something on the server's thread again and again, from now until the end; an error in it is logged.

        Parameters
        ----------
        period_s : float
            From one call to the next [s]; calls that are late are not made up for.
        call : callable
            Must not take long. What it shows reaches the clients without waking another thread. It may return by how
            much later the next call is due [s].
        """

        def again(due_s: float) -> None:
            next_s = due_s + period_s
            try:
                next_s += call() or 0.0
            finally:
                next_s = max(next_s, self._loop.time())
                self._loop.call_at(next_s, again, next_s)

        self._loop.call_soon_threadsafe(again, self._loop.time())

    def close(self) -> None:
        """Take leave of all clients and end."""
        asyncio.run_coroutine_threadsafe(self._end(), self._loop).result()
        self._end_loop()

    async def _begin(self, host: str, port: int) -> Server:
        # Compression costs four times the CPU, and the keep-alive would wait behind a stalled client's buffer.
        return await serve(
            self._serve,
            host,
            port,
            process_request=self._answer,
            compression=None,
            max_size=_LARGEST_REQUEST_BYTES,
            server_header=None,
            open_timeout=_HANDSHAKE_S,
            logger=self._failures.logger(),
            create_connection=partial(LimitedConnection, present=self._present),  # type: ignore[arg-type]
        )

    async def _end(self) -> None:
        self._server.close()
        try:
            await asyncio.wait_for(self._server.wait_closed(), 1.0)
        except asyncio.TimeoutError:
            # Not the library's `connections`: those that take leave already are none of them.
            for connection in list(self._present):
                connection.transport.abort()
            # Their tasks end by that, or the loop would complain of them.
            with suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._server.wait_closed(), 1.0)
        await self._loop.shutdown_default_executor()

    def _end_loop(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request; None for the socket, which the library goes on with."""
        # Before version 16 the library itself takes no other method than GET.
        method = getattr(request, "method", "GET")
        answer = self._find(connection, request) if method in _METHODS else None
        if method == "GET":
            return answer
        if answer is None:
            answer = connection.respond(HTTPStatus.METHOD_NOT_ALLOWED, f"only {' and '.join(_METHODS)} are answered\n")
            answer.headers["Allow"] = ", ".join(_METHODS)
        return answer if method not in _METHODS else replace(answer, body=b"")

    def _find(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request by GET; None for the socket."""
        path = request.path.partition("?")[0]
        if path == STREAM_PATH or path.startswith(FILES_PATH):
            reason = refusal(_one(request, "Host"), _one(request, "Origin"), request.path, self._token)
            if reason:
                return connection.respond(HTTPStatus.FORBIDDEN, f"{reason}\n")
            if path.startswith(FILES_PATH):
                refused = self._downloads.refusal(path)
                return connection.respond(refused[0], f"{refused[1]}\n") if refused else None
            if len(self._clients) >= MAX_CLIENTS:
                return connection.respond(HTTPStatus.SERVICE_UNAVAILABLE, f"{MAX_CLIENTS} pages are open already\n")
            return None
        file = self._files.get(path)
        if file is None:
            return connection.respond(HTTPStatus.NOT_FOUND, "there is no such page\n")
        headers = {"Content-Type": file.content_type, "Content-Length": str(len(file.body)), "Connection": "close"}
        return Response(HTTPStatus.OK, "OK", Headers({**_HEADERS, **headers}), file.body)

    async def _serve(self, connection: ServerConnection) -> None:
        path = (connection.request.path if connection.request else "").partition("?")[0]
        if path.startswith(FILES_PATH):
            await self._downloads.send(connection, path)
        else:
            await self._stream(connection)

    async def _stream(self, connection: ServerConnection) -> None:
        bound_send_buffer(connection)
        client = _Client(connection, self._display.reader())
        self._clients.add(client)
        self._on_clients(len(self._clients))
        self._send_to(client)
        try:
            async for data in connection:
                self._ask(client, data)
        except ConnectionClosed:
            pass  # the page was closed without a word, or dropped
        finally:
            self._clients.discard(client)
            self._on_clients(len(self._clients))

    def _ask(self, client: _Client, data: str | bytes) -> None:
        """Hand on what a page asks for."""
        try:
            request = read_request(data)
        except ViewRequestError as error:
            self._answer_to(client, None, False, str(error))
            return
        if self._on_request is None:
            self._answer_to(client, request.number, False, READ_ONLY)
            return
        if lateness := request.lateness(time.monotonic()):
            self._answer_to(client, request.number, False, lateness)
            return
        counted = 0 if request.do in STOPS else 1
        if counted and client.unanswered >= MAX_UNANSWERED:
            self._answer_to(client, request.number, False, f"{MAX_UNANSWERED} requests wait for their answers already")
            return
        client.unanswered += counted

        def answer(is_done: bool, sentence: str) -> None:
            self._loop.call_soon_threadsafe(answer_here, is_done, sentence)

        def answer_here(is_done: bool, sentence: str) -> None:
            client.unanswered -= counted
            self._answer_to(client, request.number, is_done, sentence)

        try:
            self._on_request(request, answer)
        except ActsError as error:
            answer_here(False, str(error))

    def _answer_to(self, client: _Client, number: int | None, is_done: bool, sentence: str) -> None:
        broadcast([client.connection], encode({"type": "answer", "id": number, "done": is_done, "text": sentence}))

    def _show(self, show: Callable[..., None], *what: Any) -> None:
        """Put something on the display, and send it to all; from any thread."""

        def change() -> None:
            show(*what)
            for client in list(self._clients):
                self._send_to(client)

        if threading.get_ident() == self._thread.ident:
            change()
        else:
            self._loop.call_soon_threadsafe(change)

    def _send_to(self, client: _Client) -> None:
        """Send what is new, where the client has taken what came before; if not, it gets then what is newest."""
        transport = client.connection.transport
        waiting_bytes = transport.get_write_buffer_size()
        if waiting_bytes < client.waiting_bytes:
            client.stalled_s = None  # slow, but it takes something
        client.waiting_bytes = waiting_bytes
        if not waiting_bytes:
            client.stalled_s = None
            for message in client.reader.news():
                # To await `send` costs a task for each; whether the client takes it is seen the next time.
                broadcast([client.connection], message)
            return
        now_s = time.monotonic()
        client.stalled_s = client.stalled_s or now_s
        if now_s - client.stalled_s > self._send_limit_s and not transport.is_closing():
            self._log("warning", f"a page took nothing for {self._send_limit_s:g} s and was dropped; it will reconnect")
            # No handshake: it would wait behind what the client does not take.
            transport.abort()


def _one(request: Request, name: str) -> str | None:
    """A header that must not come twice."""
    values = request.headers.get_all(name)
    return values[0] if len(values) == 1 else None
