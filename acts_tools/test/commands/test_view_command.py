# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts view` as a person starts it; ROS_DOMAIN_ID 221."""

from __future__ import annotations

import argparse
import http.client
import itertools
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from waiting import text_of
from websockets import Origin
from websockets.sync.client import ClientConnection, connect

from acts_core.errors import REFUSED_EXIT_CODE
from acts_driver.replay import ReplayOptions, open_recording
from acts_ros.bags.reading import open_bag
from acts_tools import view
from acts_tools.bench.rigs.processes import Board, virtual_board

pytestmark = pytest.mark.slow

DEADLINE_S = 60.0


def start(*words: str, folder: Path | None = None) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "acts_tools", "view", *words],
        cwd=folder,
        env={**os.environ, "ROS_DOMAIN_ID": "221"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def test_it_prints_where_the_page_is_and_ends_in_order() -> None:
    with start("plate", "--port", "0") as process:
        try:
            assert process.stdout is not None
            found = next(
                found for line in process.stdout if (found := re.search(r"open http://127\.0\.0\.1:(\d+)/", line))
            )
            connection = http.client.HTTPConnection("127.0.0.1", int(found[1]), timeout=DEADLINE_S)
            connection.request("GET", "/")
            assert connection.getresponse().status == 200
            # Taken meanwhile: said in a line.
            second = subprocess.run(
                [sys.executable, "-m", "acts_tools", "view", "--port", found[1]],
                env={**os.environ, "ROS_DOMAIN_ID": "221"},
                capture_output=True,
                text=True,
                timeout=DEADLINE_S,
            )
            assert second.returncode == REFUSED_EXIT_CODE
            assert f"error: cannot listen on 127.0.0.1 port {found[1]}" in second.stderr
            process.send_signal(signal.SIGINT)
            assert process.wait(DEADLINE_S) == 0
        finally:
            process.kill()


def address_of(process: subprocess.Popen[str]) -> Origin:
    """Where the page is, as soon as the program says so."""
    assert process.stdout is not None
    found = (re.search(r"open (http://127\.0\.0\.1:\d+)", line) for line in process.stdout)
    return next(Origin(one[1]) for one in found if one)


def next_header(page: ClientConnection) -> dict[str, Any]:
    """What the next message to a page says of itself."""
    message = bytes(page.recv(DEADLINE_S))  # type: ignore[arg-type]
    header: dict[str, Any] = json.loads(message[4 : 4 + int.from_bytes(message[:4], "little")])
    return header


def test_a_board_is_shown_without_any_graph(tmp_path: Path) -> None:
    with virtual_board(tmp_path) as board, start("--board", str(board.link), "--port", "0") as process:
        try:
            address = address_of(process)
            with connect(f"ws{address[4:]}/stream", origin=address, compression=None) as page:  # type: ignore[arg-type]
                page.send('{"id":1,"do":"tare"}')
                # Frame after frame, with an image; the answer to what was asked for among them.
                image, answer = b'["image","uint16",[32,32]]', b'"type":"answer","id":1,"done":'
                told = b""
                deadline_s = time.monotonic() + DEADLINE_S
                while told.count(image) <= 10 or answer not in told:
                    assert time.monotonic() < deadline_s, (told.count(image), answer in told)
                    told += bytes(page.recv(DEADLINE_S))  # type: ignore[arg-type]
            process.send_signal(signal.SIGINT)
            assert process.wait(DEADLINE_S) == 0
        finally:
            process.kill()


def overruns_by(board: Board, sequence: int) -> int:
    """Frames that a board has skipped until it had made the one of this number, as it says."""
    assert board.process.stdout is not None
    for status in map(json.loads, board.process.stdout):
        if status.get("frames", 0) + status.get("overruns", 0) > sequence:
            return int(status["overruns"])
    raise AssertionError("the board has ended")


def test_a_board_without_a_graph_is_recorded_by_its_page(tmp_path: Path) -> None:
    words = ("--board", str(tmp_path / "board"), "--port", "0", "--control")
    # A board at full rate drops frames where a loaded machine reads it too late; here none may be missing, unless the
    # board's own process stood still and says so.
    options = ("--rate-hz", "100", "--status-period-s", "0.1")
    with virtual_board(tmp_path, *options) as board, start(*words, folder=tmp_path) as process:
        try:
            assert board.link == tmp_path / "board"
            address = address_of(process)
            place = f"ws{address[4:]}"
            with connect(f"{place}/stream", origin=address, compression=None) as page:

                def until(condition: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
                    deadline_s = time.monotonic() + DEADLINE_S
                    while time.monotonic() < deadline_s:
                        header = next_header(page)
                        if condition(header):
                            return header
                    raise AssertionError(f"it was not told: {text_of(condition)}")

                page.send('{"id":1,"do":"record"}')
                assert until(lambda header: header.get("id") == 1)["done"]
                until(lambda header: header.get("recording", {}).get("messages", 0) > 150)
                page.send('{"id":2,"do":"tare"}')
                assert until(lambda header: header.get("id") == 2)["done"]
                page.send('{"id":3,"do":"stop_recording"}')
                assert until(lambda header: header.get("id") == 3)["done"]
                ((name, size),) = until(lambda header: header.get("recording", {}).get("files"))["recording"]["files"]
            with connect(f"{place}/recordings/{name}", origin=address, compression=None) as file:
                data = b"".join(bytes(piece) for piece in file)  # type: ignore[arg-type]
            process.send_signal(signal.SIGINT)
            assert process.wait(DEADLINE_S) == 0
            (bag,) = (tmp_path / "recordings").iterdir()
            frames = list(open_recording(ReplayOptions(bag)).frames())
            skipped = overruns_by(board, frames[-1].sequence)
        finally:
            process.kill()
    assert (bag / name).read_bytes() == data
    assert len(data) == size
    with open_bag(bag) as recorded:
        kinds = {topic for topic, _, _ in recorded.messages(["/board/samples", "/board/baseline"])}
        assert kinds == {"/board/samples", "/board/baseline"}
    steps = np.diff([frame.sequence for frame in frames])
    assert steps.min() == 1
    assert (steps - 1).sum() <= skipped
    assert len(frames) > 100


def test_a_board_that_says_nothing_more_is_not_tared(tmp_path: Path) -> None:
    with virtual_board(tmp_path) as board, start("--board", str(board.link), "--port", "0") as process:
        try:
            address = address_of(process)
            with connect(f"ws{address[4:]}/stream", origin=address, compression=None) as page:  # type: ignore[arg-type]

                def tare(number: int) -> dict[str, Any]:
                    page.send(json.dumps({"id": number, "do": "tare"}))
                    while True:
                        header = next_header(page)
                        if header.get("id") == number:
                            return header

                def until(condition: Callable[[dict[str, Any]], bool], first: int) -> None:
                    deadline_s = time.monotonic() + DEADLINE_S
                    for number in itertools.count(first):
                        answer = tare(number)
                        if condition(answer):
                            return
                        assert time.monotonic() < deadline_s, (text_of(condition), answer)

                until(lambda answer: answer["done"], 1)
                board.process.send_signal(signal.SIGSTOP)
                until(lambda answer: not answer["done"] and answer["text"].startswith("no frames for"), 1_000_000)
                board.process.send_signal(signal.SIGCONT)
                until(lambda answer: answer["done"], 2_000_000)
            process.send_signal(signal.SIGINT)
            assert process.wait(DEADLINE_S) == 0
        finally:
            board.process.send_signal(signal.SIGCONT)
            process.kill()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--protocol", "rastr"), "protocol = 'rastr': allowed is one of binary, raster_ascii"),
        (("--baud", "7"), "baud = 7: allowed is"),
    ],
)
def test_protocol_and_speed_of_a_board_are_those_of_the_driver(words: tuple[str, ...], told: str) -> None:
    with start("--board", "/dev/null", "--port", "0", *words) as process:
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode != 0
    assert told in output
    assert "Traceback" not in output


@pytest.mark.parametrize("source", ["--board", "--npz"])
def test_a_port_that_cannot_be_is_refused_without_a_graph_too(source: str, tmp_path: Path) -> None:
    np.savez(tmp_path / "frames.npz", frames=np.zeros((9, 32, 32), np.uint16), rate_hz=100.0)
    shown = "/dev/null" if source == "--board" else str(tmp_path / "frames.npz")
    with start(source, shown, "--port", "99999") as process:
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 1
    assert output.startswith("error: port = 99999: allowed is 0 to 65535"), output
    assert output.count("\n") == 1


def test_a_port_without_a_name_is_refused() -> None:
    """As of a variable of a shell that is not set: skins of the graph are not what was asked for."""
    with start("--board", "", "--port", "0") as process:
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 1
    assert output.startswith("error: port = '': allowed are a path such as /dev/ttyACM0, auto, or serial:"), output


def test_a_board_gets_no_name_that_its_topics_could_not_have() -> None:
    with start("--board", "nowhere", "a b", "--port", "0") as process:
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 1
    assert output.startswith("error: 'a b' is no namespace: allowed are"), output
    assert output.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "name"), [((), "/board"), (("plate",), "/plate"), (("/arm/left/",), "/arm/left"), (("/",), "")]
)
def test_a_board_is_named_as_its_topics_are(words: tuple[str, ...], name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    named: list[str] = []
    monkeypatch.setattr("acts_view.local.sources.BoardSource", lambda given, *_, **__: named.append(given))

    def show(_source: object, given: str, **_: object) -> int:
        named.append(given)
        return 0

    monkeypatch.setattr("acts_view.local.show.show", show)
    parser = argparse.ArgumentParser()
    view.add_parser(parser.add_subparsers())
    arguments = parser.parse_args(["view", *words, "--board", "nowhere"])
    signals = SimpleNamespace(interrupting=nullcontext)
    assert view._show_local(arguments, signals) == 0  # type: ignore[arg-type]
    assert named == [name, name]


def test_a_host_that_no_name_can_be_is_refused() -> None:
    with start("--host", "lab..local", "--port", "0") as process:
        output, _ = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == REFUSED_EXIT_CODE
    assert "error: cannot listen on lab..local port 0: " in output
    assert "Traceback" not in output
