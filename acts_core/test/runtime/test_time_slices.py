# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Time slices of threads in processes of their own, and the kernel's answer to them."""

import subprocess
import sys

import pytest

from acts_core.runtime.scheduling import SHORTEST_NS, time_slice_ns

HEAD = """
import os, subprocess, sys, threading, time
from acts_core.runtime.scheduling import *
# The process of the tests may have short ones already, which its children inherit.
set_time_slice(0)
def log(level, sentence):
    print(level, sentence)
go = threading.Event()
def started():
    thread = threading.Thread(target=go.wait, daemon=True)
    thread.start()
    return thread.native_id
"""


@pytest.fixture
def _slices() -> None:
    if time_slice_ns() == 0:
        pytest.skip("kernels before 6.12 have no time slices to choose (`acts doctor` tells)")


def run(code: str) -> list[str]:
    finished = subprocess.run(
        [sys.executable, "-c", HEAD + code], capture_output=True, text=True, timeout=60, check=True
    )
    return finished.stdout.split()


@pytest.mark.usefixtures("_slices")
def test_a_process_that_asks_for_nothing_has_short_slices_in_every_thread_and_child_until_it_is_demoted() -> None:
    before, *short, again = run("""
before = started()
print(time_slice_ns())
enter_realtime(RealtimeConfig(), "reader", log)
print(time_slice_ns(), time_slice_ns(before), time_slice_ns(started()), flush=True)
subprocess.run([sys.executable, "-c", "from acts_core.runtime.scheduling import *; print(time_slice_ns())"])
demote_process()
print(time_slice_ns(before))
""")
    assert short == [str(SHORTEST_NS)] * 4
    assert before == again
    assert int(before) > SHORTEST_NS


@pytest.mark.usefixtures("_slices")
def test_a_process_that_may_have_no_priority_has_short_slices() -> None:
    words = run("""
import resource
resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
if os.getuid() == 0:
    os.setuid(65534)
enter_realtime(RealtimeConfig(realtime_priority=10), "reader", log)
print(time_slice_ns())
""")
    assert words[0] == "warning"
    assert words[-1] == str(SHORTEST_NS)


@pytest.mark.usefixtures("_slices")
def test_policy_and_nice_value_are_kept() -> None:
    """The nice value is 5 more than that of the tests, which may run as `nice make test`."""
    assert run("""
nice = os.nice(5)
os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))
set_time_slice(SHORTEST_NS)
print(time_slice_ns(), os.sched_getscheduler(0) == os.SCHED_BATCH, os.getpriority(os.PRIO_PROCESS, 0) == nice > 0)
""") == [str(SHORTEST_NS), "True", "True"]


def test_a_thread_that_has_ended_has_none_and_gets_none() -> None:
    assert run("""
thread = threading.Thread(target=lambda: None)
thread.start()
thread.join()
# The kernel has it a moment longer than Python.
while os.path.exists(f"/proc/self/task/{thread.native_id}"):
    time.sleep(0.001)
set_time_slice(SHORTEST_NS, thread.native_id)
print(time_slice_ns(thread.native_id))
""") == ["0"]


@pytest.mark.parametrize("other", ["platform.machine = lambda: 'riscv64'", "sys.maxsize = 2**31 - 1"])
def test_a_processor_whose_system_calls_are_not_known_is_left_alone(other: str) -> None:
    assert run(f"""
import platform
{other}
set_time_slice(SHORTEST_NS)
print(time_slice_ns())
enter_realtime(RealtimeConfig(), "reader", log)
""") == ["0"]
