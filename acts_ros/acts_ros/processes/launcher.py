# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Run processes: start, watch, respawn, and stop all of them.

One thread only: a child gets SIGTERM when the thread that started it ends (`leave_with_parent`), so that must be the
main thread.
"""

from __future__ import annotations

import errno
import os
import selectors
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import IO

from acts_core.errors import REFUSED_EXIT_CODE
from acts_core.stop_signals import LAST_RESORT_VARIABLE, signal_name
from acts_ros.executables.refused import LAUNCHER_VARIABLE
from acts_ros.processes.children import catches_sigterm, leave_with_parent, signal_group
from acts_ros.processes.console import Console
from acts_ros.processes.process import Process
from acts_ros.processes.respawn import RespawnWait

STOPPED_CODES = (0, -signal.SIGINT, -signal.SIGTERM, 128 + signal.SIGINT, 128 + signal.SIGTERM)
"""Exit codes after a request to stop that are no failure; shells report a signal as 128 + its number."""

_STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)
# As long after its start a process may not have come to its signal handlers, on a busy machine [s].
_YOUNG_S = 2.0
_DRAIN_S = 0.5
# How often lines that nobody has read are tried again.
_CATCH_UP_S = 0.1
# The system refuses to wait for weeks; after as long, the loop only looks again.
_WAIT_S_MAX = 3600.0
# So long before it would be killed, a process that hangs is to say where.
_LAST_WORDS_S = 0.5
# One that writes without a pause is read no further in a turn; far more than a pipe holds, so that its rest is read.
_READS = 16
_READ_BYTES = 65536
# What has no end of line by then is shown as a line.
_LINE_BYTES_MAX = 65536


@dataclass
class _Child:
    """One planned process, and its running instance, if any."""

    process: Process
    popen: subprocess.Popen[bytes] | None = None
    started_s: float = 0.0
    wait: RespawnWait = field(init=False)
    restart_at_s: float | None = None
    escalations: list[tuple[float, signal.Signals, str]] = field(default_factory=list)
    killed: bool = False
    failure: str | None = None

    def __post_init__(self) -> None:
        self.wait = RespawnWait(self.process.respawn_delay_s)

    @property
    def pending(self) -> bool:
        return self.popen is not None or self.restart_at_s is not None


@dataclass
class _Stream:
    """One output pipe, and the line that is not complete yet."""

    child: _Child
    pipe: IO[bytes]
    is_error: bool
    rest: bytes = b""


class Launcher:
    """Runs processes until all have ended or the user stops them.

    Parameters
    ----------
    console : Console
        Receives the output of the processes and the launcher's messages.
    sigterm_timeout_s, sigkill_timeout_s : float
        Time after SIGINT at which a process gets SIGTERM, and time after that at which it gets SIGKILL [s].
    name : str
        Name of the launcher in its messages.
    ends_on_refusal : bool
        Whether all processes are stopped when one ends with `REFUSED_EXIT_CODE`. Such a process is never respawned.
    """

    def __init__(
        self,
        console: Console,
        sigterm_timeout_s: float = 5.0,
        sigkill_timeout_s: float = 5.0,
        *,
        name: str = "launch",
        ends_on_refusal: bool = True,
    ) -> None:
        self._console = console
        self._name = name
        self._ends_on_refusal = ends_on_refusal
        self._sigterm_timeout_s = sigterm_timeout_s
        self._sigkill_timeout_s = sigkill_timeout_s
        self._children: list[_Child] = []
        self._selector = selectors.DefaultSelector()
        self._groups: set[int] = set()
        self._signals: list[int] = []
        self._stopping = False

    def run(self, processes: list[Process]) -> int:
        """Start the processes, and return when the last one has ended.

        Parameters
        ----------
        processes : list of Process
            In the order in which they are started.

        Returns
        -------
        int
            0 when every process ended by itself with code 0, was respawned, or ended in order when asked to;
            1 when one died.
        """
        self._children = [_Child(process) for process in processes]
        with self._signal_wakeup():
            try:
                for child in self._children:
                    if not self._stopping:
                        self._start(child)
                        self._turn(timeout_s=0.0)
                while any(child.pending for child in self._children):
                    self._turn(self._next_deadline_s())
                self._drain()
            finally:
                self._kill_rest()
        failed = [child for child in self._children if child.failure is not None]
        for child in failed:
            self._console.say("ERROR", self._name, f"{child.process.label} {child.failure}")
        self._console.catch_up(_DRAIN_S)
        return 1 if failed else 0

    @contextmanager
    def _signal_wakeup(self) -> Iterator[None]:
        """Let signals only wake the loop, which handles them; they interrupt nothing else."""
        read_end, write_end = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        # Under nohup, the end of the terminal is to be ignored.
        nohup = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
        stop_signals = [number for number in _STOP_SIGNALS if not (nohup and number is signal.SIGHUP)]
        handlers = {number: signal.getsignal(number) for number in (*stop_signals, signal.SIGCHLD)}
        previous_fd = signal.set_wakeup_fd(write_end, warn_on_full_buffer=False)
        for number in stop_signals:
            signal.signal(number, lambda number, _frame: self._signals.append(number))
        signal.signal(signal.SIGCHLD, lambda _number, _frame: None)
        self._selector.register(read_end, selectors.EVENT_READ, None)
        try:
            yield
        finally:
            for number, handler in handlers.items():
                # Told to stop, this process has only to exit: with the code that it has found.
                is_over = self._stopping and number in stop_signals
                signal.signal(number, signal.SIG_IGN if is_over else handler)
            signal.set_wakeup_fd(previous_fd)
            self._selector.close()
            os.close(read_end)
            os.close(write_end)

    def _turn(self, timeout_s: float | None) -> None:
        """Wait for output, a signal, the end of a process or a deadline, and handle it."""
        for key, _ in self._selector.select(timeout_s):
            if key.data is None:
                with suppress(BlockingIOError):
                    while os.read(key.fd, 4096):
                        pass
            else:
                self._read(key.data)
        while self._signals:
            self._on_stop_signal(signal.Signals(self._signals.pop(0)))
        self._console.catch_up()
        if self._console.screen_lost and not self._stopping:
            self._stop("the output can no longer be written")
        now_s = time.monotonic()
        for child in self._children:
            self._reap(child, now_s)
            if child.restart_at_s is not None and now_s >= child.restart_at_s:
                self._start(child)
            while child.popen is not None and child.escalations and now_s >= child.escalations[0][0]:
                _, number, words = child.escalations.pop(0)
                self._console.say("ERROR", child.process.label, words)
                self._send(child, number)

    def _next_deadline_s(self) -> float | None:
        deadlines = [child.restart_at_s for child in self._children if child.restart_at_s is not None]
        deadlines += [child.escalations[0][0] for child in self._children if child.popen and child.escalations]
        deadlines += [time.monotonic() + _CATCH_UP_S] if self._console.is_behind else []
        return min(max(0.0, min(deadlines) - time.monotonic()), _WAIT_S_MAX) if deadlines else None

    def _start(self, child: _Child) -> None:
        child.restart_at_s = None
        last_resort_s = self._sigterm_timeout_s + self._sigkill_timeout_s - _LAST_WORDS_S
        try:
            child.popen = subprocess.Popen(
                child.process.command,
                env={**child.process.environment, LAUNCHER_VARIABLE: "1", LAST_RESORT_VARIABLE: f"{last_resort_s}"},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                # In a session of its own it does not get the terminal's Ctrl-C in addition to our signal.
                start_new_session=True,
                preexec_fn=leave_with_parent(os.getpid()),
            )
        except (OSError, subprocess.SubprocessError) as error:
            self._console.say("ERROR", child.process.label, f"exception occurred while executing process: {error}")
            if child.process.respawn and child.started_s:
                # It could be started before: the memory is full for a moment, or its file is being built anew.
                child.restart_at_s = time.monotonic() + child.wait.next_s(0.0)
            else:
                child.failure = f"could not be started: {error}"
            return
        child.started_s = time.monotonic()
        self._groups.add(child.popen.pid)
        self._console.say("INFO", child.process.label, f"process started with pid [{child.popen.pid}]")
        for pipe, is_error in ((child.popen.stdout, False), (child.popen.stderr, True)):
            assert pipe is not None
            os.set_blocking(pipe.fileno(), False)
            self._selector.register(pipe, selectors.EVENT_READ, _Stream(child, pipe, is_error))

    def _read(self, stream: _Stream) -> None:
        """Pass on the available output, up to `_READS` pieces; close the pipe at its end."""
        for _ in range(_READS):
            try:
                data = os.read(stream.pipe.fileno(), _READ_BYTES)
            except BlockingIOError:
                return
            *lines, stream.rest = (stream.rest + data).split(b"\n")
            if stream.rest and (not data or len(stream.rest) > _LINE_BYTES_MAX):
                lines.append(stream.rest)
                stream.rest = b""
            for line in lines:
                self._show(stream, line)
            if not data:
                self._selector.unregister(stream.pipe)
                stream.pipe.close()
                return

    def _show(self, stream: _Stream, line: bytes) -> None:
        process = stream.child.process
        self._console.write(
            f"[{process.label}] {line.decode(errors='replace')}",
            to_screen=process.output != "log" or stream.is_error,
            to_log=process.output != "screen",
        )

    def _streams(self) -> list[_Stream]:
        return [key.data for key in self._selector.get_map().values() if key.data is not None]

    def _reap(self, child: _Child, now_s: float) -> None:
        popen = child.popen
        if popen is None:
            return
        # Before it is reaped, its number, which is also that of its process group, cannot be given to another process.
        if os.waitid(os.P_PID, popen.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
            return
        signal_group(popen.pid, signal.SIGTERM)  # processes that it has started and left behind
        code = popen.wait()
        if signal_group(popen.pid, 0) == errno.ESRCH:
            self._groups.discard(popen.pid)  # the group is empty; its number may be given to another process
        for stream in self._streams():
            if stream.child is child:
                self._read(stream)
        child.popen = None
        child.escalations.clear()
        self._tell_end(child, popen.pid, code)
        if code == REFUSED_EXIT_CODE and not self._stopping:
            child.failure = f"refuses what it was given: {_describe_code(code)}"
            if self._ends_on_refusal:
                self._stop(f"{child.process.label} refuses what it was given, see its message; ending")
        elif child.process.respawn and not self._stopping:
            child.restart_at_s = now_s + child.wait.next_s(now_s - child.started_s)

    def _tell_end(self, child: _Child, pid: int, code: int) -> None:
        if code == 0:
            self._console.say("INFO", child.process.label, f"process has finished cleanly [pid {pid}]")
            return
        if self._stopping and code in STOPPED_CODES and not child.killed:
            self._console.say("INFO", child.process.label, f"process has ended as told [pid {pid}, exit code {code}]")
            return
        self._console.say(
            "ERROR",
            child.process.label,
            f"process has died [pid {pid}, exit code {code}, cmd '{' '.join(child.process.command)}'].",
        )
        if self._stopping:
            if child.killed:
                child.failure = "had to be killed"
            else:
                child.failure = f"died while it was being stopped: {_describe_code(code)}"
        elif not child.process.respawn:
            child.failure = f"died: {_describe_code(code)}"

    def _on_stop_signal(self, number: signal.Signals) -> None:
        words = "user interrupted with ctrl-c (SIGINT)" if number is signal.SIGINT else f"received {number.name}"
        if self._stopping:
            self._console.say("WARNING", self._name, f"{words} again, ignoring...")
        else:
            self._stop(words)

    def _stop(self, why: str) -> None:
        """Send SIGINT to every process, once; `_turn` escalates for those that do not end.

        A young process that does not handle SIGTERM has only begun to start, and gets that, which ends it. Python would
        answer SIGINT with a traceback and code 1.
        """
        self._stopping = True
        self._console.say("WARNING", self._name, why)
        now_s = time.monotonic()
        for child in self._children:
            child.restart_at_s = None
            if child.popen is None:
                continue
            label = child.process.label
            after_int_s = now_s + self._sigterm_timeout_s
            child.escalations = [
                (after_int_s, signal.SIGTERM, _escalation(label, self._sigterm_timeout_s, "SIGINT", "SIGTERM")),
                (
                    after_int_s + self._sigkill_timeout_s,
                    signal.SIGKILL,
                    _escalation(label, self._sigkill_timeout_s, "SIGTERM", "SIGKILL"),
                ),
            ]
            is_starting = now_s - child.started_s < _YOUNG_S and not catches_sigterm(child.popen.pid)
            self._send(child, signal.SIGTERM if is_starting else signal.SIGINT)

    def _send(self, child: _Child, number: signal.Signals) -> None:
        assert child.popen is not None
        label = child.process.label
        self._console.say("INFO", label, f"sending signal '{number.name}' to process[{label}]")
        child.killed = number is signal.SIGKILL
        # To the whole group, as a terminal does it: a wrapper script ends together with its program.
        if signal_group(child.popen.pid, number) != errno.EPERM:
            return
        self._console.say("ERROR", label, f"process[{label}] is another user's, as behind sudo, and does not get it")
        if child.killed:
            child.failure = f"could not be ended: end process {child.popen.pid} yourself"
            child.popen = None

    def _drain(self) -> None:
        """Read the output that descendants of ended processes still write, for `_DRAIN_S`."""
        deadline_s = time.monotonic() + _DRAIN_S
        while self._streams() and time.monotonic() < deadline_s:
            self._turn(timeout_s=0.05)

    def _kill_rest(self) -> None:
        """Kill all that is left of any process group, also after an error of the launcher."""
        for group in self._groups:
            signal_group(group, signal.SIGKILL)
        for stream in self._streams():
            stream.pipe.close()


def _escalation(label: str, timeout_s: float, sent: str, next_signal: str) -> str:
    return (
        f"process[{label}] failed to terminate '{timeout_s:g}' seconds after receiving '{sent}', "
        f"escalating to '{next_signal}'"
    )


def _describe_code(code: int) -> str:
    return f"exit code {code}" if code >= 0 else f"exit code {code} ({signal_name(-code)})"
