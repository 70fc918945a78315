# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The processes of the hot path under SCHED_FIFO: every thread, said once. ROS_DOMAIN_IDs 140 to 144."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from waiting import pause, wait_for

from acts_ros.processes.packages import executable

CORE = min(os.sched_getaffinity(0))
PARAMETERS = ("realtime_priority:=20", f"cpu_affinity:={CORE},")
DEADLINE_S = 60.0
GUARD_PRIORITY = 21


pytestmark = pytest.mark.slow


class Child:
    """A process and what it has written."""

    def __init__(self, process: subprocess.Popen[bytes], log: Path) -> None:
        self.process = process
        self.log = log

    def until(self, condition: Callable[[], bool], what: str) -> None:
        def turn() -> None:
            assert self.process.poll() is None, self.log.read_text()
            pause()

        wait_for(condition, what, DEADLINE_S, turn, self.log.read_text)

    def until_told(self, words: str) -> None:
        self.until(lambda: words in self.log.read_text(), words)

    def priorities(self) -> dict[int, int]:
        """Of every thread; 0 under the ordinary scheduler."""
        found = {}
        for path in Path(f"/proc/{self.process.pid}/task").iterdir():
            # One may end meanwhile.
            with suppress(ProcessLookupError):
                found[int(path.name)] = os.sched_getparam(int(path.name)).sched_priority
        return found


@contextmanager
def running(folder: Path, domain_id: int, package: str, program: str, *words: str) -> Iterator[Child]:
    log = folder / f"{program}.log"
    environment = {**os.environ, "ROS_DOMAIN_ID": str(domain_id), "ROS_PYTHON_CHECK_FIELDS": "1"}
    command = [str(executable(package, program, os.environ)), *words]
    with log.open("wb") as output:
        process = subprocess.Popen(command, stdout=output, stderr=output, env=environment)
    try:
        yield Child(process, log)
        process.terminate()
        assert process.wait(DEADLINE_S) == 0, log.read_text()
    finally:
        process.kill()
        process.wait()


@pytest.fixture
def folder() -> Iterator[Path]:
    with tempfile.TemporaryDirectory(prefix="acts_test_realtime_", dir="/dev/shm") as name:
        yield Path(name)


def ros_words(*parameters: str) -> Sequence[str]:
    return ["--ros-args", "-r", "__ns:=/plate", *(word for one in parameters for word in ("-p", one))]


def check_all(child: Child, who: str) -> None:
    """All threads run so but the guard."""
    child.until_told(f"{who}: SCHED_FIFO priority 20")
    # At once, but for threads that were being started meanwhile.
    child.until(lambda: set(child.priorities().values()) == {20, GUARD_PRIORITY}, "the priorities")
    child.until(lambda: os.sched_getaffinity(child.process.pid) == {CORE}, "the core")
    assert child.log.read_text().count("SCHED_FIFO") == 1


@pytest.mark.usefixtures("realtime")
def test_the_driver(folder: Path) -> None:
    port = folder / "board"
    with running(folder, 140, "acts_firmware", "virtual_board", "--link", str(port)) as board:
        board.until(port.is_symlink, "the port")
        words = ros_words(f"port:={port}", *PARAMETERS)
        with running(folder, 140, "acts_driver", "driver", *words) as driver:
            check_all(driver, "driver")


@pytest.mark.usefixtures("realtime")
def test_the_simulated_world(folder: Path) -> None:
    words = ros_words(f"field_ring:={folder}/field.ring", "joint_ring:=none", *PARAMETERS)
    with running(folder, 141, "acts_sim", "ball_world", *words) as world:
        check_all(world, "ball_world")


@pytest.mark.usefixtures("realtime")
def test_the_simulated_robot(folder: Path) -> None:
    words = ("--host", "127.0.14.1", "--realtime-priority", "20", "--cpu-affinity", f"{CORE},")
    with running(folder, 142, "acts_sim", "ur_controller", *words) as robot:
        robot.until_told("all of it: SCHED_FIFO priority 20")
        assert os.sched_getscheduler(robot.process.pid) == os.SCHED_FIFO


@pytest.mark.usefixtures("realtime")
def test_the_reconstruction(folder: Path) -> None:
    with running(folder, 143, "acts_recon", "reconstruction", *ros_words(*PARAMETERS)) as reconstruction:
        check_all(reconstruction, "reconstruction")


@pytest.mark.usefixtures("realtime")
def test_the_control(folder: Path) -> None:
    with running(folder, 144, "acts_control", "ball_control", *ros_words(*PARAMETERS, "autostart:=false")) as control:
        check_all(control, "ball_control")


@pytest.mark.parametrize("parameter", ["cpu_affinity:=4095,", "realtime_priority:=100"])
def test_what_cannot_be_ends_the_node(parameter: str) -> None:
    program = str(executable("acts_driver", "driver", os.environ))
    refused = subprocess.run(
        [program, *ros_words(parameter)],
        capture_output=True,
        text=True,
        timeout=DEADLINE_S,
        env={**os.environ, "ROS_DOMAIN_ID": "140"},
    )
    assert refused.returncode == 2
    assert parameter.split(":")[0] in refused.stderr
    assert "allowed" in refused.stderr
