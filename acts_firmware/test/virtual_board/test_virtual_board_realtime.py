# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The virtual board under SCHED_FIFO: as asked, not as asked, and when it has more to do than there is time."""

import os
import subprocess
from pathlib import Path

import pytest
from board_process import DEADLINE_S, BoardProcess
from core_library import installed
from waiting import wait_for

from acts_core.runtime.scheduling import SHORTEST_NS, time_slice_ns

CORE = min(os.sched_getaffinity(0))
# Ten times as much as a core can do: every measurement of a board with shorted lines looks at all their taxels.
TOO_MUCH = (
    *("--rows", "64", "--cols", "64", "--m", "4096", "--sample-us", "0.1", "--rate-hz", "100000"),
    *("--hardware-fault", "short-rows=1,2", "--hardware-fault", "short-cols=3,4"),
)


def wait_for_words(board: BoardProcess, words: str) -> None:
    def look() -> None:
        assert board.process.poll() is None, board.errors.read_text()

    wait_for(lambda: words in board.errors.read_text(), repr(words), DEADLINE_S, look, board.errors.read_text)


@pytest.mark.usefixtures("realtime")
def test_it_runs_as_asked(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--realtime-priority", 20, "--cpu-affinity", f"{CORE},") as board:
        wait_for_words(board, f"virtual_board: SCHED_FIFO priority 20, cores {CORE}\n")
        assert os.sched_getscheduler(board.process.pid) == os.SCHED_FIFO
        assert os.sched_getaffinity(board.process.pid) == {CORE}


@pytest.mark.usefixtures("realtime")
def test_it_is_put_back_when_it_never_sleeps(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, *TOO_MUCH, "--realtime-priority", 20) as board:
        wait_for_words(board, "the ordinary scheduler has it now")
        assert os.sched_getscheduler(board.process.pid) == os.SCHED_OTHER


def test_nothing_asked_is_nothing_said(tmp_path: Path) -> None:
    with BoardProcess(tmp_path, "--realtime-priority", 0, "--cpu-affinity", "none", "--status-period-s", 0.01) as board:
        assert board.status()["frames"] > 0
        assert os.sched_getscheduler(board.process.pid) == os.SCHED_OTHER
        # Kernels before 6.12 tell none.
        assert time_slice_ns(board.process.pid) == (SHORTEST_NS if time_slice_ns() else 0)
        assert board.errors.read_text() == ""


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--cpu-affinity", "4095"), "--cpu-affinity 4095: allowed are cores"),
        (("--cpu-affinity", "0-99999999999"), "--cpu-affinity 0-99999999999: allowed are cores"),
        (("--cpu-affinity", "x"), "--cpu-affinity x: allowed are cores"),
        (("--realtime-priority", "100"), "--realtime-priority 100: allowed is a whole number from 0 to 99"),
    ],
)
def test_what_cannot_be_is_refused(words: tuple[str, str], told: str) -> None:
    refused = subprocess.run([installed("virtual_board"), *words], capture_output=True, text=True, timeout=DEADLINE_S)
    assert refused.returncode == 2
    assert refused.stderr.startswith(f"virtual_board: {told}")
