# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process whose middleware hangs ends with a word, and no other does. ROS_DOMAIN_ID 180."""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path

import pytest
import rclpy

from acts_ros.executables.middleware_watch import PATIENCE, Silence
from acts_ros.middleware import announces_often
from acts_ros.processes import packages

NODE = """
import sys
from acts_ros.executables import middleware_watch
from acts_ros.executor import run
from rclpy.node import Node

middleware_watch.PERIOD_S = 0.2

class Example(Node):
    def __init__(self):
        super().__init__("example")
        self.create_timer(0.05, lambda: print("ticking", flush=True))

sys.exit(run([Example]))
"""
DEADLINE_S = 60.0
ONE, OTHER = Path("1"), Path("2")
# From sys/ptrace.h and sys/wait.h.
SEIZE, INTERRUPT, WALL = 0x4206, 0x4207, 0x40000000


@contextmanager
def running(**variables: str) -> Iterator[subprocess.Popen[str]]:
    """A node that ticks."""
    with subprocess.Popen(
        [sys.executable, "-c", NODE],
        env={**os.environ, "ROS_DOMAIN_ID": "180", **variables},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "ticking\n"
            yield process
        finally:
            process.kill()


def hold_timers(process: subprocess.Popen[str]) -> None:
    """Let the thread of timers of Fast DDS in a child process stand still, as in a deadlock, while all others run."""
    if not rclpy.get_rmw_implementation_identifier().startswith("rmw_fastrtps"):
        pytest.skip("only Fast DDS has the thread")
    tasks = Path(f"/proc/{process.pid}/task").iterdir()
    (timers,) = (int(task.name) for task in tasks if (task / "comm").read_text().startswith("dds.ev."))
    held: Future[int] = Future()
    threading.Thread(target=_trace, args=(timers, held), daemon=True).start()
    error = held.result(DEADLINE_S)
    if error:
        pytest.skip(f"a thread cannot be held here ({os.strerror(error)}): allow ptrace of child processes")


def _trace(thread: int, held: Future[int]) -> None:
    """Hold a thread to its end, for which its tracer has to wait before its process can end."""
    libc = ctypes.CDLL(None, use_errno=True)
    for request in (SEIZE, INTERRUPT):
        if libc.ptrace(request, thread, None, None):
            held.set_result(ctypes.get_errno())
            return
    os.waitpid(thread, WALL)
    held.set_result(0)
    os.waitpid(thread, WALL)


def test_a_process_whose_middleware_hangs_ends_with_a_word() -> None:
    with running() as process:
        hold_timers(process)
        _, errors = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 1
    assert "error: Fast DDS hangs: its timers have not run for 2 s" in errors
    assert "Traceback" not in errors


def test_a_process_whose_profile_is_the_users_is_not_ended(tmp_path: Path) -> None:
    """It may announce itself as rarely as it likes, as with static discovery."""
    profile = tmp_path / "mine.xml"
    profile.write_text('<dds xmlns="http://www.eprosima.com"><profiles/></dds>')
    with running(FASTDDS_DEFAULT_PROFILES_FILE=str(profile), FASTRTPS_DEFAULT_PROFILES_FILE=str(profile)) as process:
        hold_timers(process)
        assert process.stdout is not None
        for _ in range(100):
            assert process.stdout.readline() == "ticking\n"


def test_a_process_that_runs_stays_and_ends_in_order() -> None:
    with running() as process:
        assert process.stdout is not None
        for _ in range(100):
            assert process.stdout.readline() == "ticking\n"
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=DEADLINE_S)
    assert (process.returncode, errors) == (0, "")


def test_a_thread_that_wakes_now_and_then_is_not_silent() -> None:
    silence = Silence()
    for count in range(5):
        assert silence.step({ONE: count}) == 0
        for look in range(1, PATIENCE):
            assert silence.step({ONE: count}) == look


def test_the_most_silent_of_some_threads_counts() -> None:
    silence = Silence()
    assert [silence.step({ONE: count, OTHER: 7}) for count in range(PATIENCE)] == list(range(PATIENCE))


@pytest.mark.parametrize("name", ["FASTDDS_DEFAULT_PROFILES_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE"])
@pytest.mark.parametrize("profile", ["loopback", "open", "small_datagrams"])
def test_our_profiles_announce_often_enough_to_be_watched(name: str, profile: str) -> None:
    environment = {"AMENT_PREFIX_PATH": os.environ["AMENT_PREFIX_PATH"]}
    path = packages.share("acts_config", environment) / "network" / f"{profile}.xml"
    assert "<nanosec>500000000</nanosec>" in path.read_text()
    assert announces_often({**environment, name: str(path)})
    assert not announces_often({**environment, name: f"/elsewhere/network/{profile}.xml"})
    assert not announces_often(environment)
