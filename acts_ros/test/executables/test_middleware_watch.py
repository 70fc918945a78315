# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A process whose middleware hangs ends with a word, and no other does. ROS_DOMAIN_ID 180."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from held_timers import hold_timers

from acts_ros.executables import middleware_watch
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


def test_a_process_whose_middleware_hangs_ends_with_a_word() -> None:
    with running() as process:
        hold_timers(process.pid)
        _, errors = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 1
    assert "error: Fast DDS hangs: its timers have not run for 2 s" in errors
    assert "Traceback" not in errors


def test_a_process_whose_profile_is_the_users_is_not_ended(tmp_path: Path) -> None:
    """It may announce itself as rarely as it likes, as with static discovery."""
    profile = tmp_path / "mine.xml"
    # Fast DDS of Jazzy complains of a file without a profile.
    participant = '<participant profile_name="mine" is_default_profile="true"><rtps/></participant>'
    profile.write_text(f'<dds xmlns="http://www.eprosima.com"><profiles>{participant}</profiles></dds>')
    with running(FASTDDS_DEFAULT_PROFILES_FILE=str(profile), FASTRTPS_DEFAULT_PROFILES_FILE=str(profile)) as process:
        hold_timers(process.pid)
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


def test_a_thread_that_ends_while_it_is_looked_at_is_passed_over(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Its folder, of which the files are gone.
    (tmp_path / "7").mkdir()
    monkeypatch.setattr(middleware_watch, "_TASKS", tmp_path)
    environment = {"AMENT_PREFIX_PATH": os.environ["AMENT_PREFIX_PATH"]}
    profile = packages.share("acts_config", environment) / "network" / "loopback.xml"
    watched = {**environment, "FASTDDS_DEFAULT_PROFILES_FILE": str(profile)}
    assert announces_often(watched)
    middleware_watch.watch_middleware(watched)
    assert "acts_dds_watch" not in [thread.name for thread in threading.enumerate()]


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
