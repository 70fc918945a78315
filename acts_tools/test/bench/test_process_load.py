# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The load of processes by their own clocks."""

import os
import subprocess
import sys
import time

import pytest

from acts_tools.process_load import LoadMeter, cpu_s

BUSY = """
import sys, threading, time
def work():
    end_s = time.thread_time() + 0.2
    while time.thread_time() < end_s:
        pass
thread = threading.Thread(target=work)
thread.start()
thread.join()
print("done", flush=True)
sys.stdin.read()
"""


def test_time_of_threads_that_have_ended_counts() -> None:
    command = [sys.executable, "-c", BUSY]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "done\n"
        used_s = cpu_s(process.pid)
        process.communicate("")
    assert 0.2 <= used_s < 5.0


def test_a_process_of_short_turns_is_seen() -> None:
    """Ticks see a process that always sleeps when they come either never or always."""
    before_s, clock_s = cpu_s(os.getpid()), time.process_time()
    for _ in range(50):
        end_s = time.process_time() + 2e-4
        while time.process_time() < end_s:
            pass
        time.sleep(1e-3)
    assert cpu_s(os.getpid()) - before_s == pytest.approx(time.process_time() - clock_s, abs=0.005)


def test_a_process_that_is_gone_has_no_clock() -> None:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait()
    with pytest.raises(ProcessLookupError):
        cpu_s(process.pid)


def test_the_tree_is_told_by_name() -> None:
    meter = LoadMeter(os.getpid(), "root")
    meter.start()
    command = [sys.executable, "-c", BUSY]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "done\n"
        loads = meter.percent()
        process.communicate("")
    assert set(loads) >= {"root"}
    child = [value for name, value in loads.items() if name.startswith("python")]
    assert child
    assert child[0] > 0.0
