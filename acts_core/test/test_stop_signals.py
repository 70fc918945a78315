# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Signals in processes of their own: one request to stop, undisturbed by more, with a last resort."""

import select
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from acts_core.stop_signals import LAST_RESORT_S, LAST_RESORT_VARIABLE, last_resort_s_of, signal_name

DEADLINE_S = 60.0

HEAD = """
import sys, threading, time
from acts_core.stop_signals import StopSignals
signals = StopSignals(last_resort_s=float(sys.argv[1]))
asked = threading.Event()
"""

# Waits where Python runs no handler until it returns: in a lock without timeout, in the main thread.
ENDS = """
signals.on_stop(asked.set)
print("running", flush=True)
asked.wait()
print("ending", flush=True)
sys.stdin.readline()
signals.ended()
print("ended by", signals.first.name, flush=True)
"""

STARTS = """
try:
    with signals.interrupting():
        print("running", flush=True)
        while True:
            pass
except KeyboardInterrupt:
    print("ending", flush=True)
sys.stdin.readline()
signals.on_stop(asked.set)
print("ended by" if asked.is_set() and signals.is_set else "forgotten", signals.first.name, flush=True)
signals.ended()
"""

# As where a dataclass is made.
STARTS_IN_TEXT = STARTS.replace("        while True:\n            pass\n", '        exec("while True: pass")\n')

# As numba's compiler: C calls back, in which an exception is lost, and then fails or goes on without the result.
CALLED_BACK_FROM_C = """
import ctypes
def wait(_left, _right):
    print("running", flush=True)
    while True:
        pass
def call_back():
    two = (ctypes.c_int * 2)()
    kind = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
    ctypes.CDLL(None).qsort(two, 2, 4, kind(wait))
try:
    with signals.interrupting():
        call_back()
        while GOES_ON:
            pass
        FAILURE
    print("not interrupted", flush=True)
except KeyboardInterrupt:
    print("ending", flush=True)
signals.ended()
"""

# No other thread may take the signal.
BLOCKED_BEFORE = """
import os, signal
from acts_core.stop_signals import StopSignals
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
os.kill(os.getpid(), signal.SIGINT)
signals = StopSignals()
try:
    with signals.interrupting():
        print("not interrupted", flush=True)
except KeyboardInterrupt:
    print("ending", signal.pthread_sigmask(signal.SIG_BLOCK, []), flush=True)
signals.ended()
"""


@contextmanager
def program(code: str, last_resort_s: float, head: str = HEAD) -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(
        [sys.executable, "-c", head + code, str(last_resort_s)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    assert select.select([process.stdout], [], [], DEADLINE_S)[0], "the program says nothing"
    return process.stdout.readline().strip()


@pytest.mark.parametrize("code", [ENDS, STARTS, STARTS_IN_TEXT], ids=["running", "starting", "starting in text"])
@pytest.mark.parametrize("first", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_further_signals_do_not_disturb_the_way_out(code: str, first: signal.Signals) -> None:
    with program(code, DEADLINE_S) as process:
        assert line(process) == "running"
        process.send_signal(first)
        assert line(process) == "ending"
        for again in (signal.SIGINT, signal.SIGTERM, signal.SIGINT):
            process.send_signal(again)
        output, errors = process.communicate("go on\n", timeout=DEADLINE_S)
    assert (output, errors) == (f"ended by {first.name}\n", "")
    assert process.returncode == 0


@pytest.mark.parametrize(("goes_on", "failure"), [("True", "pass"), ("False", "pass"), ("False", "raise RuntimeError")])
def test_an_interruption_that_is_lost_in_a_library_takes_effect_after_it(goes_on: str, failure: str) -> None:
    code = CALLED_BACK_FROM_C.replace("GOES_ON", goes_on).replace("FAILURE", failure)
    with program(code, DEADLINE_S) as process:
        assert line(process) == "running"
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=DEADLINE_S)
    assert (output, errors) == ("ending\n", "")
    assert process.returncode == 0


def test_a_signal_that_was_blocked_before_is_not_lost() -> None:
    with program(BLOCKED_BEFORE, DEADLINE_S, head="") as process:
        output, errors = process.communicate(timeout=DEADLINE_S)
    assert (output, errors) == ("ending set()\n", "")
    assert process.returncode == 0


def test_what_does_not_end_is_ended_and_tells_where_it_hangs() -> None:
    with program(ENDS, 0.2) as process:
        assert line(process) == "running"
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE_S) == 1
        assert process.stderr is not None
        errors = process.stderr.read()
    assert "Timeout" in errors
    assert "most recent call first" in errors


def test_what_hangs_after_its_orderly_end_is_ended_too() -> None:
    # The interpreter waits for such a thread.
    code = "threading.Thread(target=threading.Event().wait).start()\n" + ENDS
    with program(code, 1.0) as process:
        assert line(process) == "running"
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate("go on\n", timeout=DEADLINE_S)
    assert output == "ending\nended by SIGINT\n"
    assert "most recent call first" in errors
    assert process.returncode == 1


@pytest.mark.parametrize(("given", "expected_s"), [("4", 4.0), ("0.5", 0.5)])
def test_a_launcher_that_kills_sooner_has_the_last_resort_come_before(given: str, expected_s: float) -> None:
    assert last_resort_s_of({LAST_RESORT_VARIABLE: given}) == expected_s


@pytest.mark.parametrize("given", ["", "soon", "nan", "0", "-1", "1000", "inf"])
def test_no_launcher_has_the_last_resort_come_never_or_at_once(given: str) -> None:
    assert last_resort_s_of({LAST_RESORT_VARIABLE: given}) == last_resort_s_of({}) == LAST_RESORT_S


def test_a_signal_without_a_name_has_a_number() -> None:
    assert signal_name(signal.SIGKILL) == "SIGKILL"
    assert signal_name(40) == "signal 40"
