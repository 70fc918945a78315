# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Real-time scheduling in processes of their own: what was asked for, what is refused, and threads that run away."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest

from acts_core.errors import SettingsError
from acts_core.runtime import RealtimeConfig, parse_cores
from acts_core.runtime.scheduling.realtime import format_cores
from acts_core.runtime.scheduling.realtime_guard import BudgetWatch

CORE = min(os.sched_getaffinity(0))
DEADLINE_S = 60.0

HEAD = f"""
import os, re, threading, time
from acts_core.runtime.scheduling.realtime import RealtimeConfig, enter_realtime
from acts_core.runtime.scheduling import realtime_guard
from acts_core.runtime.scheduling.realtime_guard import guard_thread
POLICIES = {{os.SCHED_OTHER: "other", os.SCHED_FIFO: "fifo"}}
def policy(thread=0):
    return POLICIES[os.sched_getscheduler(thread)]
def print(*words):
    # In one piece, which nothing that another thread says divides.
    os.write(1, (" ".join(map(str, words)) + "\\n").encode())
def log(level, sentence):
    print(f"{{level}}: {{sentence}}")
# Whatever fails here, the machine is not to wait for it.
longest = time.monotonic() + 30.0
def leave_it_to_the_guard():
    # Where a hypervisor takes the core away for a moment, the guard needs a second more.
    realtime_guard.UNBROKEN_S = 20
config = RealtimeConfig(realtime_priority=10, cpu_affinity="{CORE},")
"""


# A thread that runs away under SCHED_FIFO keeps others from the core.
pytestmark = [pytest.mark.alone, pytest.mark.slow]


def run(code: str, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(  # type: ignore[call-overload, no-any-return]
        [sys.executable, "-c", HEAD + code], capture_output=True, text=True, timeout=DEADLINE_S, **options
    )


@pytest.fixture
def on_the_same_core() -> Iterator[None]:
    """The test itself has to get along beside the runaway."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {CORE})
    yield
    os.sched_setaffinity(0, before)


@pytest.mark.usefixtures("realtime")
def test_all_threads_run_as_asked_and_those_that_they_start() -> None:
    finished = run("""
go = threading.Event()
thread = threading.Thread(target=go.wait)
thread.start()
enter_realtime(config, "reader", log)
print(os.sched_getaffinity(thread.native_id), len(os.sched_getaffinity(guard_thread())))
enter_realtime(RealtimeConfig(realtime_priority=12), "reader", log)
later = threading.Thread(target=go.wait)
later.start()
threads = (threading.main_thread().native_id, thread.native_id, later.native_id, guard_thread())
print(*(f"{policy(one)} {os.sched_getparam(one).sched_priority}" for one in threads))
go.set()
""")
    lines = finished.stdout.splitlines()
    assert re.fullmatch(rf"info: reader: SCHED_FIFO priority 10(, memory locked)?, cores {CORE}", lines[0]), finished
    assert lines[1] == f"{{{CORE}}} {len(os.sched_getaffinity(0))}"
    assert lines[3] == "fifo 12 fifo 12 fifo 12 fifo 13"


@pytest.mark.usefixtures("realtime")
def test_threads_that_another_thread_starts_meanwhile_run_so_too() -> None:
    finished = run("""
def left_out():
    go, some = threading.Event(), threading.Event()
    threads = [threading.Thread(target=go.wait, daemon=True) for _ in range(30)]
    def start_all():
        for thread in threads:
            thread.start()
            some.set()
    starter = threading.Thread(target=start_all)
    starter.start()
    some.wait()
    enter_realtime(config, "reader", lambda _level, _sentence: None)
    starter.join()
    return sum(policy(thread.native_id) != "fifo" or len(os.sched_getaffinity(thread.native_id)) > 1
               for thread in threads)
for _ in range(50):
    child = os.fork()
    if child == 0:
        os._exit(left_out())
    _, status = os.waitpid(child, 0)
    print(os.waitstatus_to_exitcode(status))
""")
    assert finished.stdout.split() == ["0"] * 50, finished


def test_nothing_asked_is_nothing_said() -> None:
    finished = run("""
enter_realtime(RealtimeConfig(), "reader", log)
print(policy(), len(os.sched_getaffinity(0)), guard_thread())
""")
    assert finished.stdout == f"other {len(os.sched_getaffinity(0))} None\n"


def test_what_is_not_allowed_is_told_and_done_without() -> None:
    # The same for root, whom no limit holds.
    finished = run("""
import resource
resource.setrlimit(resource.RLIMIT_RTPRIO, (0, 0))
if os.getuid() == 0:
    os.setuid(65534)
enter_realtime(config, "reader", log)
print(policy(), os.sched_getaffinity(0))
""")
    told, state = finished.stdout.splitlines()
    assert told.startswith(f"warning: reader: ordinary scheduler, cores {CORE}; no more than priority 0 "), finished
    assert "10 is asked for" in told
    assert "acts doctor" in told
    assert state == f"other {{{CORE}}}"


@pytest.mark.usefixtures("realtime")
@pytest.mark.usefixtures("on_the_same_core")
def test_a_thread_that_runs_away_in_python_is_put_back() -> None:
    finished = run("""
leave_it_to_the_guard()
error = threading.Event()
def told(level, sentence):
    log(level, sentence)
    if level == "error":
        error.set()
def run_away():
    enter_realtime(config, "reader", told)
    while policy() == "fifo" and time.monotonic() < longest:
        pass
    print(policy())
    enter_realtime(config, "reader", told)
thread = threading.Thread(target=run_away)
thread.start()
thread.join()
print(policy())
# The guard tells it after it has put the thread back, and ends with the process.
error.wait(30)
""")
    assert finished.returncode == 0
    lines = finished.stdout.splitlines()
    assert sum(line.startswith("error: reader (thread") for line in lines) == 1, finished
    assert [line for line in lines if line in ("fifo", "other")] == ["other", "other"]
    refused = [line for line in lines if line.startswith("warning")]
    assert len(refused) == 1
    assert "real time was given up after reader had run away" in refused[0]


@pytest.mark.usefixtures("realtime")
@pytest.mark.usefixtures("on_the_same_core")
def test_a_thread_that_runs_away_in_c_without_the_interpreters_lock_is_put_back() -> None:
    finished = run("""
import hashlib
leave_it_to_the_guard()
ended = threading.Event()
def told(level, sentence):
    log(level, sentence)
    if level == "error":
        os._exit(5)
def run_away():
    enter_realtime(config, "reader", told)
    hashlib.pbkdf2_hmac("sha256", b"a", b"b", 100_000_000)
runaway = threading.Thread(target=run_away)
runaway.start()
runaway.join()  # from Python 3.12 on no thread starts another once the main thread has ended
""")
    assert finished.returncode == 5
    assert "error: reader (thread" in finished.stdout


@pytest.mark.usefixtures("realtime")
@pytest.mark.usefixtures("on_the_same_core")
def test_a_thread_that_runs_away_with_the_interpreters_lock_ends_the_process() -> None:
    finished = run("""
def run_away():
    enter_realtime(config, "reader", log)
    re.match("(a+)+$", 60 * "a" + "b")
runaway = threading.Thread(target=run_away)
runaway.start()
runaway.join()  # from Python 3.12 on no thread starts another once the main thread has ended
""")
    assert finished.returncode == -signal.SIGXCPU
    assert "most recent call first" in finished.stderr
    assert "run_away" in finished.stderr


def test_the_budget_finds_who_takes_more_than_its_share() -> None:
    watch = BudgetWatch(share=0.9, window_s=1.0)
    for step in range(30):
        now_ns = step * 100_000_000
        # 7 takes 89 % of a core, 8 takes all of it from 1 s on, 9 comes late.
        used = {7: 89 * now_ns // 100, 8: max(0, now_ns - 1_000_000_000)}
        if step > 15:
            used[9] = now_ns
        found = watch.step(now_ns, used)
        if found is not None:
            break
    assert found is not None
    assert found[0] == 8
    assert found[1] == pytest.approx(1.0)
    assert step == 20


@pytest.mark.parametrize(
    ("text", "cores"),
    [("", set()), ("none", set()), ("2", {2}), ("2,", {2}), ("0, 2-4", {0, 2, 3, 4}), ("3-3,1", {1, 3})],
)
def test_cores_are_read(text: str, cores: set[int]) -> None:
    assert parse_cores(text, range(8)) == cores
    assert parse_cores(format_cores(cores), range(8)) == cores


@pytest.mark.parametrize("text", ["8", "0-9", "4-2", "0-99999999999", "a", "-1", "1-", "1;2", "²"])
def test_cores_that_are_none_are_refused_with_those_there_are(text: str) -> None:
    with pytest.raises(SettingsError, match="cpu_affinity") as refused:
        parse_cores(text, range(8))
    assert "0-7" in str(refused.value) or "0,2-3" in str(refused.value)


def test_gaps_between_the_cores_are_no_cores() -> None:
    with pytest.raises(SettingsError, match="0,2-3"):
        parse_cores("0-2", (0, 2, 3))


def test_settings_name_what_is_allowed() -> None:
    with pytest.raises(SettingsError, match="realtime_priority"):
        RealtimeConfig(realtime_priority=100)
    with pytest.raises(SettingsError, match="cpu_affinity"):
        RealtimeConfig(cpu_affinity="4095")
