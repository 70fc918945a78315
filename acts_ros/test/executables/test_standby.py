# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Of equal processes one works; when it dies, the spare takes over."""

from __future__ import annotations

import os
import queue
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from acts_core.errors import ActsError
from acts_ros.executables.standby import STANDBY_WORD, Standby, take_standby_word

DEADLINE_S = 30.0
NODE = """
import sys, threading
print("imported", flush=True)

def prepare():
    print("prepared", flush=True)

def main(signals):
    told = threading.Event()
    signals.on_stop(told.set)
    print("works", *sys.argv[1:], flush=True)
    told.wait()
    signals.ended()
    return 0
"""
# A spare imports at once: nothing else starts here.
PROGRAM = """
import sys
from acts_ros.executables import program
program.PREPARE_AFTER_S = 0.0
sys.argv[:] = ["tactile", *sys.argv[1:]]
sys.exit(program.Program("working_node")())
"""


class Program:
    """A process, and the lines that it prints."""

    def __init__(self, folder: Path, *words: str, within: Sequence[str] = ()) -> None:
        path = os.pathsep.join([str(folder), os.environ.get("PYTHONPATH", "")])
        self.process = subprocess.Popen(
            [*within, sys.executable, "-c", PROGRAM, STANDBY_WORD, *words],
            env={**os.environ, "PYTHONPATH": path},
            stdout=subprocess.PIPE,
            text=True,
        )
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout:
            for line in self.process.stdout:
                self._lines.put(line.strip())

    def lines(self, count: int) -> list[str]:
        """The next lines that it prints."""
        return [self._lines.get(timeout=DEADLINE_S) for _ in range(count)]

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        self._reader.join()


Start = Callable[..., Program]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    (tmp_path / "working_node.py").write_text(NODE)
    programs: list[Program] = []

    def run(*words: str, within: Sequence[str] = ()) -> Program:
        programs.append(Program(tmp_path, *words, within=within))
        return programs[-1]

    yield run
    for started in programs:
        started.close()


READY = ["imported", "prepared", "ready to take over if the process that works ends"]


def test_the_spare_takes_over_when_the_first_is_killed_and_the_next_is_the_spare(start: Start) -> None:
    first = start("--set", "a=1")
    assert first.lines(2) == ["imported", "works --set a=1"]
    for _ in range(3):
        spare = start("--set", "a=1")
        assert spare.lines(3) == READY
        first.process.kill()
        assert spare.lines(1) == ["works --set a=1"]
        first = spare
    first.process.send_signal(signal.SIGINT)
    assert first.process.wait(DEADLINE_S) == 0


def test_processes_of_another_namespace_work_beside_one_another(start: Start) -> None:
    for namespace in ("/left", "/right"):
        words = ["--ros-args", "-r", f"__ns:={namespace}"]
        assert start(*words).lines(2) == ["imported", " ".join(["works", *words])]


def test_a_namespace_may_be_as_long_as_ros_takes_it(start: Start) -> None:
    words = ["--ros-args", "-r", f"__ns:=/{200 * 'a'}"]
    assert start(*words).lines(2) == ["imported", " ".join(["works", *words])]
    assert start(*words).lines(3) == READY


def test_a_process_of_another_board_is_no_spare(start: Start) -> None:
    """As where two includes of a launch file were given the same namespace: it would take over with its own board."""
    for port in ("serial:1", "serial:2"):
        words = ["--set", f"driver.port={port}", "--ros-args", "-r", "__ns:=/plate"]
        assert start(*words).lines(2) == ["imported", " ".join(["works", *words])]


def test_a_process_of_another_container_is_no_spare(start: Start) -> None:
    """Two containers with the network of the machine (``docker run --network host``) count their processes alike."""
    container = ["unshare", "--user", "--pid", "--fork", "--kill-child"]
    if subprocess.run([*container, "true"], check=False).returncode:
        pytest.skip("user namespaces are not allowed")
    for _ in range(2):
        assert start(within=container).lines(2) == ["imported", "works"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_spare_that_waits_ends_in_order(start: Start, number: signal.Signals) -> None:
    worker = start()
    assert worker.lines(2)[1] == "works"
    spare = start()
    assert spare.lines(3) == READY
    spare.process.send_signal(number)
    assert spare.process.wait(DEADLINE_S) == 0
    assert worker.process.poll() is None


def test_a_turn_is_waited_for_as_long_as_is_said() -> None:
    one, other = Standby("waited"), Standby("waited")
    assert one.wait_for_turn(0.0)
    assert not other.wait_for_turn(0.05)
    one.close()
    assert other.wait_for_turn(DEADLINE_S)
    other.close()


def test_the_word_is_taken_out_and_a_process_without_it_waits_for_nothing() -> None:
    words = ["tactile", STANDBY_WORD, "--ros-args", "-r", "__ns:=/plate"]
    assert isinstance(take_standby_word(words), Standby)
    assert words == ["tactile", "--ros-args", "-r", "__ns:=/plate"]
    assert take_standby_word(words) is None


def test_a_name_that_another_user_has_taken_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    taken = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    with taken:
        taken.bind(f"\0acts/standby/{os.getppid()}/squatted")
        taken.listen()
        user = os.getuid()
        monkeypatch.setattr(os, "getuid", lambda: user + 1)
        with pytest.raises(ActsError, match=rf"squatted.*user {user}.*standby:=false"):
            Standby("squatted").wait_for_turn()
