# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The server over real sockets, without ROS: files, refusals, and clients that are slow, stalled or gone."""

from __future__ import annotations

import errno
import gc
import http.client
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from importlib.metadata import version
from itertools import count
from pathlib import Path
from queue import Queue
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from view_messages import decode
from view_slow_line import SlowLine, over_a_slow_line
from waiting import wait_for
from websockets.exceptions import ConnectionClosed, InvalidMessage, InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from acts_core.errors import SettingsError
from acts_view.skin.snapshot import Frame, Sample, SkinShape
from acts_view.web import connections
from acts_view.web import server as view_server
from acts_view.web.connections import LimitedConnection
from acts_view.web.server import ViewServer

DEADLINE_S = 30.0
SEND_LIMIT_S = 0.3
# Before, the library closes a connection that asks for anything but a GET; the newest for Python 3.10 is 16.1.
LIBRARY_KNOWS_METHODS = int(version("websockets").partition(".")[0]) >= 17


class Bench:
    def __init__(self) -> None:
        self.pages: list[int] = []
        self.log: list[str] = []
        self.server = ViewServer(
            "127.0.0.1",
            0,
            send_limit_s=SEND_LIMIT_S,
            on_clients=self.pages.append,
            log=lambda _level, sentence: self.log.append(sentence),
        )
        self.url = f"ws://127.0.0.1:{self.server.address.port}/stream"
        self.origin = self.server.address.url.rstrip("/")
        self._numbers = count()
        self._is_closed = False

    def close(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            self.server.close()

    def connect(self, **options: Any) -> ClientConnection:
        given: dict[str, Any] = {"origin": self.origin, "compression": None, **options}
        return connect(self.url, **given)

    def show(self, value: int) -> None:
        number = next(self._numbers)
        image = np.full((64, 64), value, np.uint16)
        sample = Sample(1000.0 + 0.004 * number, float(value), 0.5, 0)
        self.server.show_frame("/plate", Frame(stamp_s=sample.stamp_s, image=image), [sample])

    def until(self, condition: Callable[[], bool], meanwhile: Callable[[], object] = lambda: None) -> None:
        def turn() -> None:
            meanwhile()
            time.sleep(0.001)

        wait_for(condition, timeout_s=DEADLINE_S, meanwhile=turn)


@pytest.fixture
def bench() -> Iterator[Bench]:
    made = Bench()
    yield made
    made.close()


def test_files_are_served_and_nothing_else(bench: Bench) -> None:
    def get(path: str) -> http.client.HTTPResponse:
        connection = http.client.HTTPConnection("127.0.0.1", bench.server.address.port, timeout=DEADLINE_S)
        connection.request("GET", path)
        return connection.getresponse()

    page = get("/")
    assert (page.status, page.headers["Content-Type"]) == (200, "text/html; charset=utf-8")
    assert "default-src 'self'" in page.headers["Content-Security-Policy"]
    assert b"<title>ACTS" in page.read()
    assert get("/main.js?x=1").headers["Content-Type"] == "text/javascript; charset=utf-8"
    for path in ("/../setup.py", "/%2e%2e/setup.py", "/vendor", "/nothing"):
        assert get(path).status == 404


@pytest.mark.parametrize("path", ["/", "/stream", "/no/such/page"])
@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "PROPFIND"])
def test_nothing_is_answered_but_what_only_reads(method: str, path: str, bench: Bench) -> None:
    connection = http.client.HTTPConnection("127.0.0.1", bench.server.address.port, timeout=DEADLINE_S)
    connection.request(method, path)
    if not LIBRARY_KNOWS_METHODS:
        with pytest.raises(http.client.RemoteDisconnected):
            connection.getresponse()
        return
    answer = connection.getresponse()
    assert (answer.status, answer.headers["Allow"]) == (405, "GET, HEAD")


@pytest.mark.skipif(not LIBRARY_KNOWS_METHODS, reason="websockets 16 closes a connection that asks for a HEAD")
@pytest.mark.parametrize(("path", "status"), [("/", 200), ("/style.css", 200), ("/nothing", 404), ("/stream", 403)])
def test_a_head_is_a_page_without_its_body(path: str, status: int, bench: Bench) -> None:
    with socket.create_connection(("127.0.0.1", bench.server.address.port), DEADLINE_S) as client:
        client.sendall(f"HEAD {path} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n".encode())
        answer = b""
        while piece := client.recv(65536):
            answer += piece
    head, _, body = answer.partition(b"\r\n\r\n")
    assert head.startswith(f"HTTP/1.1 {status} ".encode())
    assert body == b""


def test_a_skin_that_nobody_describes_is_of_the_size_of_its_image(bench: Bench) -> None:
    def described() -> tuple[int, int]:
        with bench.connect() as client:
            header, _ = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
        return header["rows"], header["cols"]

    bench.show(3)
    assert described() == (64, 64)
    # What is told counts, whatever comes then.
    bench.server.show_shape("/plate", SkinShape(rows=32, cols=16))
    bench.show(4)
    assert described() == (32, 16)


def test_a_page_gets_what_the_skin_is_like_and_what_is_newest(bench: Bench) -> None:
    bench.server.show_shape("/plate", SkinShape(rows=64, cols=64))
    for value in range(5):
        bench.show(value)
    with bench.connect() as client:
        described, _ = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
        assert (described["type"], described["rows"]) == ("skin", 64)
        frame, arrays = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
        assert frame["type"] == "frame"
        assert (arrays["image"] == 4).all()
        assert len(arrays["history"]) == 2
        bench.show(9)
        _, arrays = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
        assert (arrays["image"] == 9).all()
    bench.until(lambda: bench.pages == [1, 0])


@pytest.mark.parametrize("origin", ["http://example.org", None])
def test_a_foreign_page_is_refused(bench: Bench, origin: str | None) -> None:
    with pytest.raises(InvalidStatus) as refused:
        bench.connect(origin=origin)
    assert refused.value.response.status_code == 403


def test_a_stalled_client_holds_nobody_up_and_is_dropped(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    # At each look at a client that takes nothing it is 10 ms later, however long this machine takes for a message.
    looks = count(100)
    monkeypatch.setattr(view_server, "time", SimpleNamespace(monotonic=lambda: 0.01 * next(looks)))
    buffer = socket.socket()
    buffer.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    buffer.connect(("127.0.0.1", bench.server.address.port))
    # It reads one message and then no more.
    with bench.connect() as healthy, bench.connect(sock=buffer, max_queue=1) as stalled:
        bench.until(lambda: bench.pages == [1, 2])
        value, got = count(), 0

        def show_and_read() -> None:
            nonlocal got
            bench.show(next(value) % 1000)
            healthy.recv(DEADLINE_S)
            got += 1

        bench.until(lambda: bool(bench.log), show_and_read)
        assert got > 20
        bench.until(lambda: bench.pages == [1, 2, 1])
        show_and_read()
        stalled.close_socket()
    assert f"took nothing for {SEND_LIMIT_S:g} s" in bench.log[0]


def slow_line(bench: Bench, path: str) -> SlowLine:
    return SlowLine(bench.server.address.port, bench.origin, path)


def test_a_page_on_a_slow_line_is_not_dropped_while_it_takes_something(bench: Bench) -> None:
    large = Frame(stamp_s=999.0, image=np.zeros((1000, 1000), np.uint16))

    def read(line: SlowLine) -> bool:
        bench.until(lambda: bench.pages[-1:] == [1])
        bench.server.show_frame("/large", large, [])
        line.begin()
        # All the while there is something that waits.
        if line.read_slowly(1_500_000, lambda: bench.show(1)):
            assert line.passed_s > 3 * SEND_LIMIT_S
            return True
        bench.until(lambda: bench.pages[-1] == 0)
        return False

    over_a_slow_line(lambda: slow_line(bench, "/stream"), read, SEND_LIMIT_S, bench.log)
    assert bench.log == []


def test_a_server_ends_quietly_beside_a_page_that_takes_nothing(
    bench: Bench, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    own = slow_line(bench, "/stream").own
    bench.until(lambda: bench.pages == [1])
    bench.server.show_frame("/large", Frame(stamp_s=999.0, image=np.zeros((1000, 1000), np.uint16)), [])
    bench.until(lambda: all(one.connection.transport.get_write_buffer_size() > 0 for one in bench.server._clients))
    bench.close()
    gc.collect()
    own.close()
    assert bench.pages == [1, 0]
    assert [record.getMessage() for record in caplog.records] == []
    assert capfd.readouterr().err == ""


def test_a_recording_is_sent_over_a_slow_line(bench: Bench, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    size = 12_000_000
    file = tmp_path / "x.mcap"
    file.write_bytes(bytes(size))
    monkeypatch.setattr(bench.server._downloads, "_find", lambda _name: file)

    def read(line: SlowLine) -> bool:
        # More than the system would keep by itself.
        if not line.read_slowly(2_000_000):
            return False
        assert line.passed_s > 3 * SEND_LIMIT_S
        while line.got < size:
            if not line.read(65536):
                return False
        return True

    over_a_slow_line(lambda: slow_line(bench, "/recordings/x.mcap"), read, SEND_LIMIT_S, bench.log)
    assert bench.log == []


def test_a_recording_is_whole_where_the_line_holds_more_than_an_answer_is_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Impatient(LimitedConnection):
        def __init__(self, *arguments: Any, **options: Any) -> None:
            soon = dict.fromkeys(["ping_interval", "ping_timeout", "close_timeout"], 0.02)
            super().__init__(*arguments, **{**options, **soon})

    size = 1_500_000
    file = tmp_path / "x.mcap"
    file.write_bytes(bytes(size))
    monkeypatch.setattr(view_server, "LimitedConnection", Impatient)
    bench = Bench()
    monkeypatch.setattr(bench.server._downloads, "_find", lambda _name: file)
    try:
        # It answers nothing.
        make = partial(slow_line, bench, "/recordings/x.mcap")
        over_a_slow_line(make, lambda line: line.read_slowly(size), SEND_LIMIT_S, bench.log)
    finally:
        bench.close()


def test_an_address_that_is_taken_is_told(bench: Bench) -> None:
    with pytest.raises(SettingsError, match=f"port {bench.server.address.port}.*--port"):
        ViewServer("127.0.0.1", bench.server.address.port, on_clients=print, log=print)


def test_another_host_gets_a_token() -> None:
    server = ViewServer("0.0.0.0", 0, on_clients=print, log=print)
    try:
        port, token = server.address.port, server.address.token
        assert server.address.url.endswith(f":{port}/?token={token}")
        origin = Origin(f"http://127.0.0.1:{port}")
        with pytest.raises(InvalidStatus), connect(f"ws://127.0.0.1:{port}/stream", origin=origin):
            pass
        with connect(f"ws://127.0.0.1:{port}/stream?token={token}", origin=origin):
            pass
    finally:
        server.close()


def test_connections_that_fail_are_told_in_one_line_and_without_a_traceback(capfd: pytest.CaptureFixture[str]) -> None:
    def find_file(name: str) -> Path | None:
        raise OSError(errno.EMFILE, "Too many open files")

    log: list[str] = []
    server = ViewServer(
        "127.0.0.1", 0, on_clients=print, log=lambda _level, sentence: log.append(sentence), find_file=find_file
    )
    url = f"ws://127.0.0.1:{server.address.port}/recordings/x.mcap"
    try:
        for _ in range(3):
            with pytest.raises(InvalidStatus), connect(url, origin=Origin(server.address.url.rstrip("/"))):
                pass
        # What asyncio finds where no connection can be accepted.
        server._loop.call_exception_handler({"message": "socket.accept() out of system resource"})
    finally:
        server.close()
    what = "process_request failed" if LIBRARY_KNOWS_METHODS else "opening handshake failed"
    assert log == [f"a connection to the page failed: {what}: OSError [Errno 24] Too many open files"]
    assert capfd.readouterr().err == ""


def test_what_was_not_told_of_failed_connections_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    log: list[str] = []
    failures = connections.FailureLog(lambda _level, sentence: log.append(sentence))
    for _ in range(4):
        failures.tell("no handshake", ValueError("x" * 10_000))
    monkeypatch.setattr(connections, "_TOLD_EVERY_S", 0.0)
    failures.tell("no handshake", None)
    assert len(log[0]) < 300
    assert log[1:] == ["a connection to the page failed: no handshake; 3 more were not told"]


def test_connections_that_ask_for_nothing_are_bounded(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(connections, "MAX_CONNECTIONS", 3)
    address = ("127.0.0.1", bench.server.address.port)
    silent = [socket.create_connection(address, DEADLINE_S) for _ in range(3)]
    bench.until(lambda: len(bench.server._present) == 3)
    with pytest.raises((ConnectionError, InvalidMessage, ConnectionClosed)):
        bench.connect()
    for own in silent:
        own.close()

    def is_served() -> bool:
        with suppress(ConnectionError, InvalidMessage, ConnectionClosed), bench.connect():
            return True
        return False

    bench.until(is_served)


def test_what_is_called_again_and_again_shows_on_the_servers_thread_and_outlives_an_error(bench: Bench) -> None:
    threads: set[str] = set()
    values = count(1)

    def show() -> None:
        threads.add(threading.current_thread().name)
        value = next(values)
        if value == 2:
            raise ValueError("only once")
        bench.show(value)

    shown: list[int] = []
    with bench.connect() as client:
        bench.server.every(0.001, show)
        while len(shown) < 3:
            header, arrays = decode(client.recv(DEADLINE_S))  # type: ignore[arg-type]
            if header["type"] == "frame":
                shown.append(int(arrays["image"][0, 0]))
    assert 2 not in shown
    assert shown == sorted(set(shown))
    assert threads == {"acts_view_server"}
    assert [line.rpartition(": ")[2] for line in bench.log] == ["ValueError only once"]


def test_what_is_shown_on_the_servers_thread_is_there_before_the_call_returns(bench: Bench) -> None:
    """Through the loop's queue it would wait for the next turn, and wake a thread that is awake."""
    found: Queue[bool] = Queue()

    def show() -> None:
        if found.empty():
            bench.show(7)
            found.put(bool(bench.server._display._skins))

    bench.server.every(0.001, show)
    assert found.get(timeout=DEADLINE_S)


def test_calls_that_are_late_are_not_made_up_for(bench: Bench) -> None:
    called_s: Queue[float] = Queue()
    numbers = count()

    def call() -> None:
        called_s.put(time.monotonic())
        if next(numbers) == 0:
            threading.Event().wait(20 * period_s)  # it takes so long

    period_s = 0.05
    bench.server.every(period_s, call)
    times_s = [called_s.get(timeout=DEADLINE_S) for _ in range(4)]
    assert times_s[1] - times_s[0] >= 20 * period_s
    # Two may follow at once; of the twenty that were due the others are left out.
    assert times_s[3] - times_s[1] >= 0.9 * period_s
