# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Processes run by a program of its own, without a log file: respawn, orderly end, and the program killed."""

from __future__ import annotations

import array
import errno
import fcntl
import io
import os
import re
import signal
import subprocess
import sys
import termios
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from waiting import wait_for

from acts_ros.processes.console import Console
from acts_ros.processes.launcher import Launcher
from acts_ros.processes.process import Process
from acts_ros.processes.respawn import LONGEST_WAIT_S, SOON_S, RespawnWait
from acts_ros.processes.screen import Screen

DEADLINE_S = 30.0
PAGE_BYTES = 4096

PROGRAM = '''
import os, sys
from acts_ros.processes.console import Console
from acts_ros.processes.launcher import Launcher
from acts_ros.processes.process import Process

child = """
import signal, sys
signal.signal(signal.SIGINT, lambda *_: sys.exit(0))
print("ready", flush=True)
signal.pause()
"""
command = (sys.executable, "-c", child)
processes = [Process(f"it-{number}", command, dict(os.environ), "screen", True, 0.05) for number in (1, 2)]
code = Launcher(Console(None), name="someone").run(processes)
print("over", flush=True)
if sys.argv[1:] == ["wait"]:
    sys.stdin.readline()
sys.exit(code)
'''

# Stands for a program of Python that still imports: its handlers are those of the interpreter.
STARTING = PROGRAM.replace("signal.signal(signal.SIGINT, lambda *_: sys.exit(0))", "")


def pipe_room(read_end: int) -> int:
    """Bytes that still fit into a pipe, less than a page."""
    waiting = array.array("i", [0])
    fcntl.ioctl(read_end, termios.FIONREAD, waiting)
    return max(fcntl.fcntl(read_end, fcntl.F_GETPIPE_SZ) - waiting[0] - PAGE_BYTES, 0)


def children_of(pid: int) -> list[int]:
    """Numbers of the processes that a process has started."""
    return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


class Run:
    """The program and what it has written."""

    def __init__(self, process: subprocess.Popen[bytes], path: Path) -> None:
        self.process = process
        self._path = path

    @property
    def output(self) -> str:
        return self._path.read_text()

    @property
    def pids(self) -> list[int]:
        return [int(number) for number in re.findall(r"started with pid \[(\d+)\]", self.output)]

    def wait_until(self, condition: Callable[[], bool]) -> None:
        wait_for(condition, timeout_s=DEADLINE_S, state=lambda: self.output)


@contextmanager
def running(folder: Path, program: str = PROGRAM, *arguments: str) -> Iterator[Run]:
    path = folder / "output.txt"
    command = [sys.executable, "-c", program, *arguments]
    with (
        path.open("wb") as output,
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=output, stderr=subprocess.STDOUT) as process,
    ):
        run = Run(process, path)
        try:
            run.wait_until(lambda: run.output.count("] ready") == 2)
            yield run
        finally:
            process.kill()


def is_gone(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):  # the second where it goes while its file is read
        return True
    # One that nobody has collected yet is gone as well.
    return state == "Z"


def test_what_dies_is_started_again_and_the_other_goes_on(tmp_path: Path) -> None:
    with running(tmp_path) as run:
        first, second = run.pids
        os.kill(first, signal.SIGKILL)
        run.wait_until(lambda: run.output.count("[it-1] ready") == 2)
        assert not is_gone(second)
        assert run.output.count("[it-2] ready") == 1
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(DEADLINE_S) == 0
        assert all(is_gone(pid) for pid in run.pids)
        assert "[WARNING] [someone]: user interrupted with ctrl-c (SIGINT)" in run.output


def test_what_has_only_begun_to_start_ends_without_a_traceback(tmp_path: Path) -> None:
    with running(tmp_path, STARTING) as run:
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(DEADLINE_S) == 0
        assert "Traceback" not in run.output
        assert "[ERROR]" not in run.output
        assert "[it-1]: process has ended as told" in run.output


def test_what_hangs_tells_where_before_it_would_be_killed(tmp_path: Path) -> None:
    hanging = """
import threading
from acts_core.stop_signals import StopSignals
signals = StopSignals()
print("ready", flush=True)
threading.Event().wait()
"""
    begin, child, end = PROGRAM.split('"""')
    assert "signal.pause" in child
    program = f'{begin}"""{hanging}"""{end}'.replace("Console(None), ", "Console(None), 1.0, 2.0, ")
    with running(tmp_path, program) as run:
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(DEADLINE_S) == 1
        assert run.output.count("most recent call first") >= 2
        assert "sending signal 'SIGTERM'" in run.output
        assert "sending signal 'SIGKILL'" not in run.output


def test_times_to_stop_of_any_length_are_waited_for(tmp_path: Path) -> None:
    program = PROGRAM.replace("Console(None), ", "Console(None), 9999999.0, 1e300, ")
    with running(tmp_path, program) as run:
        run.process.send_signal(signal.SIGINT)
        assert run.process.wait(DEADLINE_S) == 0
        assert "Traceback" not in run.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_that_comes_when_all_has_ended_changes_nothing(tmp_path: Path, number: signal.Signals) -> None:
    with running(tmp_path, PROGRAM, "wait") as run:
        run.process.send_signal(signal.SIGINT)
        run.wait_until(lambda: "over" in run.output)
        run.process.send_signal(number)
        run.process.communicate(b"go on\n", timeout=DEADLINE_S)
        assert run.process.returncode == 0
        assert "Traceback" not in run.output


def test_waits_double_while_a_process_cannot_live_and_are_short_again_once_it_has() -> None:
    wait = RespawnWait(0.1)
    waits = [wait.next_s(0.5) for _ in range(20)]
    assert waits[:4] == [0.1, 0.2, 0.4, 0.8]
    assert waits[-1] == LONGEST_WAIT_S
    assert wait.next_s(SOON_S + 1.0) == 0.1
    assert wait.next_s(0.5) == 0.2


def test_waits_double_also_where_none_was_asked_for() -> None:
    wait = RespawnWait(0.0)
    waits = [wait.next_s(0.5) for _ in range(20)]
    assert waits[:4] == [0.0, 0.1, 0.2, 0.4]
    assert waits[-1] == LONGEST_WAIT_S


def test_a_wait_that_was_asked_for_is_never_made_shorter() -> None:
    wait = RespawnWait(3 * LONGEST_WAIT_S)
    assert {wait.next_s(0.5) for _ in range(5)} == {3 * LONGEST_WAIT_S}


def test_what_was_started_ends_when_its_program_is_killed(tmp_path: Path) -> None:
    with running(tmp_path) as run:
        run.process.kill()
        run.process.wait()
        run.wait_until(lambda: all(is_gone(pid) for pid in run.pids))


def test_what_refuses_what_it_was_given_is_not_started_again_and_may_leave_the_others_alone(
    capsys: pytest.CaptureFixture[str],
) -> None:
    def process(label: str, script: str, respawn: bool) -> Process:
        return Process(label, ("/bin/sh", "-c", script), dict(os.environ), "screen", respawn, 0.01)

    plan = [process("choosy", "exit 2", True), process("other", "sleep 0.3; echo done", False)]
    assert Launcher(Console(None), ends_on_refusal=False).run(plan) == 1
    output = capsys.readouterr().out
    assert output.count("[choosy]: process started") == 1
    assert "[other] done" in output
    assert "choosy refuses what it was given: exit code 2" in output
    assert "other died" not in output


def test_what_cannot_be_started_again_for_a_moment_is_tried_again(tmp_path: Path) -> None:
    """As while its file is being built anew: here by itself, and it is put right once that was noticed."""
    program = tmp_path / "it"
    program.write_text("#!/bin/sh\ncd ${0%/*}\n[ -e before ] && exit 2\ntouch before\nchmod -x it\n")
    program.chmod(0o755)
    mend = f"cd {tmp_path}; until grep -q 'exception occurred' launch.log; do sleep 0.02; done; chmod +x it"
    processes = [Process("it", (str(program),), dict(os.environ), "log", True, 0.01), shell(mend)]
    assert Launcher(Console(tmp_path, io.StringIO())).run(processes) == 1
    # Of the second time.
    assert "it refuses what it was given" in (tmp_path / "launch.log").read_text()


def shell(script: str, *, respawn: bool = False) -> Process:
    return Process("it", ("/bin/sh", "-c", script), dict(os.environ), "screen", respawn, 0.01)


def test_what_is_another_users_is_told_and_keeps_nobody_else_from_ending_in_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As what is behind sudo: one that ends by itself, and one that does not."""
    killpg, screen, others = os.killpg, io.StringIO(), list[int]()

    def refused(group: int, number: int) -> None:
        others.extend(int(pid) for pid in re.findall(r"sudo-\d.: process started with pid .(\d+)", screen.getvalue()))
        if group in others:
            raise PermissionError(errno.EPERM, "Operation not permitted")
        killpg(group, number)

    monkeypatch.setattr(os, "killpg", refused)
    environment = dict(os.environ)
    orderly = f"trap 'echo orderly; exit 0' INT TERM; kill -INT {os.getpid()}; while :; do sleep 0.02; done"
    plan = [
        Process("sudo-1", ("/bin/sh", "-c", "exit 0"), environment, "screen", False, 0.0),
        Process("sudo-2", ("/bin/sleep", "60"), environment, "screen", False, 0.0),
        Process("own", ("/bin/sh", "-c", orderly), environment, "screen", False, 0.0),
    ]
    try:
        assert Launcher(Console(None, screen), 2.0, 0.1).run(plan) == 1
    finally:
        killpg(others[-1], signal.SIGKILL)
    output = screen.getvalue()
    assert "[own] orderly" in output
    assert output.count("process[sudo-2] is another user's, as behind sudo, and does not get it") == 3
    assert f"sudo-2 could not be ended: end process {others[-1]} yourself" in output


@pytest.mark.parametrize("script", ["exec cat /dev/zero", "exec yes"], ids=["without an end of a line", "lines"])
def test_one_that_writes_without_a_pause_does_not_keep_the_launch_from_ending(tmp_path: Path, script: str) -> None:
    program = PROGRAM.replace(
        'code = Launcher(Console(None), name="someone")',
        f"""
processes.append(Process("writer", ("/bin/sh", "-c", {script!r}), dict(os.environ), "log", False, 0.05))
code = Launcher(Console(None), name="someone")""",
    )
    with running(tmp_path, program) as run:
        run.process.send_signal(signal.SIGINT)
        run.wait_until(lambda: "over" in run.output)
        assert run.process.wait(DEADLINE_S) == 0
        assert all(is_gone(pid) for pid in run.pids)


def test_output_that_nobody_reads_holds_nothing_up(tmp_path: Path) -> None:
    # As behind `less`, or after Ctrl-S.
    chatty = PROGRAM.replace('print("ready", flush=True)', 'print(*["ready"] * 50000, sep=chr(10), flush=True)')
    read_end, write_end = os.pipe()
    process = subprocess.Popen([sys.executable, "-c", chatty], stdout=write_end)
    os.close(write_end)
    try:
        wait_for(lambda: pipe_room(read_end) == 0 and len(children_of(process.pid)) >= 2, timeout_s=DEADLINE_S)
        pids = children_of(process.pid)
        process.send_signal(signal.SIGINT)
        wait_for(lambda: all(is_gone(pid) for pid in pids), timeout_s=DEADLINE_S)
        with open(read_end, "rb", closefd=False) as reader:
            shown = reader.read().decode().splitlines()
        assert process.wait(DEADLINE_S) == 0
        # Either may have been first, and have filled the pipe by itself.
        assert shown.count("[it-1] ready") + shown.count("[it-2] ready") > 4000
    finally:
        process.kill()
        process.wait()
        os.close(read_end)


def test_lines_that_waited_are_shown_and_too_many_are_told() -> None:
    read_end, write_end = os.pipe()
    with os.fdopen(read_end, "rb", 0) as reader, os.fdopen(write_end, "w") as stream:
        screen = Screen(stream)
        count = 200_000
        for number in range(count):
            screen.write(f"line {number}")
        assert screen.is_behind
        shown = b""
        while screen.is_behind:
            shown += reader.read(65536)
            screen.catch_up()
        screen.write("the end")
        stream.flush()
        shown += reader.read(65536)
    *lines, told, end = shown.decode().splitlines()
    assert lines == [f"line {number}" for number in range(len(lines))]
    assert told == f"[WARNING] [launch]: lines left out here: {count - len(lines)}"
    assert end == "the end"


def test_a_line_that_does_not_end_is_shown_in_pieces() -> None:
    screen = io.StringIO()
    assert Launcher(Console(None, screen)).run([shell("head -c 1000000 /dev/zero | tr '\\0' x; echo; echo end")]) == 0
    shown = [line.removeprefix("[it] ") for line in screen.getvalue().splitlines() if line.startswith("[it] ")]
    assert shown[-1] == "end"
    assert "".join(shown) == 1_000_000 * "x" + "end"
    assert max(map(len, shown)) < 1_000_000


def test_a_signal_without_a_name_that_ends_a_process_is_told_by_its_number() -> None:
    screen = io.StringIO()
    assert Launcher(Console(None, screen)).run([shell("kill -40 $$")]) == 1
    assert "it died: exit code -40 (signal 40)" in screen.getvalue()


def test_what_the_screen_or_the_log_cannot_write_is_shown_otherwise(tmp_path: Path) -> None:
    raw = io.BytesIO()
    console = Console(tmp_path, io.TextIOWrapper(raw, encoding="ascii"))
    console.write("grün", to_screen=True, to_log=True)
    console.write("done", to_screen=True, to_log=True)
    console.close()
    assert raw.getvalue().decode("ascii").splitlines() == ["gr\\xfcn", "done"]
    assert "grün\n" in (tmp_path / "launch.log").read_text(encoding="utf-8")


def test_a_process_with_an_argument_that_is_no_text_may_die_beside_one_that_stays(tmp_path: Path) -> None:
    raw = io.BytesIO()
    console = Console(tmp_path, io.TextIOWrapper(raw, encoding="utf-8"))
    odd = Process("odd", ("/bin/sh", "-c", "exit 1", "x:=/tmp/\udcff"), dict(os.environ), "screen", False, 0.0)
    # It says so only after the other has died.
    log = tmp_path / "launch.log"
    healthy = shell(f"until grep -q 'odd.*has died' {log}; do sleep 0.02; done; echo healthy")
    assert Launcher(console).run([odd, healthy]) == 1
    console.close()
    for text in (raw.getvalue().decode(), log.read_text(encoding="utf-8")):
        assert "cmd '/bin/sh -c exit 1 x:=/tmp/\\udcff'" in text
    assert "[it] healthy" in raw.getvalue().decode()
