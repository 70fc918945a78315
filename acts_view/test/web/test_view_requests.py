# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Requests of a page: whatever comes is one, or is refused."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from view_messages import decode
from websockets.sync.client import connect
from websockets.typing import Origin

from acts_core.errors import ViewRequestError
from acts_view.web.requests import LATE_S, STOPS, Answer, Request, read_request
from acts_view.web.server import MAX_UNANSWERED, ViewServer

DEADLINE_S = 30.0


TEXT = st.text(max_size=8)
NUMBERS = st.integers(-9, 9) | st.floats(-1e9, 1e9)
WISHES = st.fixed_dictionaries(
    {"id": st.integers(0, 9), "do": TEXT},
    optional={"skin": TEXT, "name": TEXT, "value": st.none() | NUMBERS | TEXT, "asked_s": NUMBERS},
)
ANY_OBJECT = st.dictionaries(st.text(), st.integers() | st.text())
# In some of them one value is another, or a key that no request has.
KEYS = st.sampled_from(["id", "do", "skin", "name", "value", "asked_s", "more"])
CHANGES = st.dictionaries(KEYS, st.none() | st.booleans() | st.integers() | st.floats() | st.text(), max_size=1)


@given(
    st.text()
    | st.binary()
    | st.builds(json.dumps, ANY_OBJECT)
    | st.builds(lambda wish, change: json.dumps({**wish, **change}), WISHES, CHANGES)
)
def test_anything_is_a_request_or_refused(data: str | bytes) -> None:
    try:
        request = read_request(data)
    except ViewRequestError:
        return
    assert request.number >= 0


def test_a_request_is_read_as_it_is_and_an_odd_one_refused() -> None:
    assert read_request('{"id":3,"do":"seek","value":1.5}') == Request(3, "seek", value=1.5)
    for text in (
        '{"id":1,"do":"seek","value":NaN}',
        '{"id":1,"do":"seek","value":1e999}',
        '{"id":1,"do":"seek","value":[1]}',
        '{"id":1,"do":"seek","more":1}',
        '{"id":1,"do":"grasp","asked_s":"now"}',
        '{"id":1,"do":"grasp","asked_s":NaN}',
        '{"id":true,"do":"seek"}',
        '{"do":"seek"}',
        "[" * 900,
        json.dumps({"id": 1, "do": "x" * 201}),
    ):
        with pytest.raises(ViewRequestError):
            read_request(text)


def test_what_stops_something_is_handed_on_though_other_requests_wait() -> None:
    waiting: list[tuple[Request, Answer]] = []
    server = ViewServer(
        "127.0.0.1",
        0,
        on_clients=lambda _: None,
        log=print,
        on_request=lambda request, answer: waiting.append((request, answer)),
    )
    origin = server.address.url.rstrip("/")
    try:
        with connect(f"{origin.replace('http', 'ws')}/stream", origin=Origin(origin), compression=None) as page:
            asked = ["tare"] * MAX_UNANSWERED + sorted(STOPS) + ["calibrate"]
            for number, do in enumerate(asked):
                page.send(json.dumps({"id": number, "do": do}))
            # Only the last is refused, which comes behind all others.
            refused, _ = decode(page.recv(DEADLINE_S))  # type: ignore[arg-type]
            assert (refused["id"], refused["done"]) == (len(asked) - 1, False)
            assert [request.do for request, _ in waiting] == asked[:-1]
            # The answer to a stop is none that was waited for by the others.
            waiting[-1][1](True, "stopped")
            answered, _ = decode(page.recv(DEADLINE_S))  # type: ignore[arg-type]
            assert answered["text"] == "stopped"
            page.send('{"id":90,"do":"calibrate"}')
            refused, _ = decode(page.recv(DEADLINE_S))  # type: ignore[arg-type]
            assert (refused["id"], refused["done"]) == (90, False)
    finally:
        server.close()


def test_what_was_asked_for_long_ago_is_not_done_unless_it_stops_something() -> None:
    done: list[str] = []

    def do(request: Request, answer: Answer) -> None:
        done.append(request.do)
        answer(True, "done")

    server = ViewServer("127.0.0.1", 0, on_clients=lambda _: None, log=print, on_request=do)
    origin = server.address.url.rstrip("/")
    try:
        server.show_status({"skins": []})
        with connect(f"{origin.replace('http', 'ws')}/stream", origin=Origin(origin), compression=None) as page:
            status, _ = decode(page.recv(DEADLINE_S))  # type: ignore[arg-type]
            long_ago_s = status["clock_s"] - LATE_S
            for number, (what, asked_s) in enumerate(
                [("grasp", long_ago_s), ("stop_grasp", long_ago_s), ("tare", None)]
            ):
                page.send(json.dumps({"id": number, "do": what, "asked_s": asked_s}))
            answers = [decode(page.recv(DEADLINE_S))[0] for _ in range(3)]  # type: ignore[arg-type]
    finally:
        server.close()
    assert [answer["done"] for answer in answers] == [False, True, True]
    assert "s after it was asked for" in answers[0]["text"]
    assert done == ["stop_grasp", "tare"]


def test_a_stop_does_not_wait_for_a_file_that_a_disk_is_slow_to_open(tmp_path: Path) -> None:
    file = tmp_path / "x.mcap"
    # It is not opened before somebody writes to it.
    os.mkfifo(file)
    server = ViewServer(
        "127.0.0.1",
        0,
        on_clients=lambda _: None,
        log=print,
        on_request=lambda _, answer: answer(True, "stopped"),
        find_file=lambda _: file,
    )
    origin = server.address.url.rstrip("/")
    begin = partial(connect, origin=Origin(origin), compression=None)
    stream = origin.replace("http", "ws")
    try:
        with begin(f"{stream}/stream") as page, begin(f"{stream}/recordings/x.mcap") as download:
            page.send('{"id":1,"do":"stop_grasp"}')
            answer, _ = decode(page.recv(DEADLINE_S))  # type: ignore[arg-type]
            assert answer["text"] == "stopped"
            file.write_bytes(b"touch")
            assert download.recv(DEADLINE_S) == b"touch"
    finally:
        # Whatever has failed: the server waits for the file, too.
        with suppress(OSError):
            os.close(os.open(file, os.O_WRONLY | os.O_NONBLOCK))
        server.close()
