# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A host that comes directly after another gets nothing of what the virtual board had for that one."""

import os
import signal
import termios
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from board_process import DEADLINE_S, BoardProcess

from acts_core.wire import RasterDecoder

pytestmark = pytest.mark.slow

QUICK = ("--sample-us", 0.5, "--status-period-s", 0.05)
"""Full frames, so many of them that a host that does not read has soon filled the board's queue."""

CATCH_UP_S = 0.25
"""How late the virtual board may be before it leaves out frames (`kCatchUpUs` in acts_firmware)."""


def line_with(board: BoardProcess, **values: Any) -> dict[str, Any]:
    """The next line that the board prints with these values."""
    deadline = time.monotonic() + DEADLINE_S
    while time.monotonic() < deadline:
        line = board.status()
        if line.items() >= values.items():
            return line
    raise AssertionError(f"no line with {values}")


def leave_unread(board: BoardProcess) -> None:
    """Until the board's queue has been full for half a second."""
    while board.status().get("overruns", 0) == 0:
        pass
    frames = board.status()["frames"]
    while board.status()["frames"] < frames + 500:
        pass


def test_one_that_comes_while_the_board_is_frozen(tmp_path: Path) -> None:
    control = tmp_path / "control"
    with BoardProcess(tmp_path, *QUICK, "--scheme", "raster", "--control", control) as board:
        board.open_port()
        leave_unread(board)
        control.write_text("freeze:0.5\n")
        line_with(board, fault="freeze:0.5", over=False)
        board.close_port()
        port = board.open_port()
        opened_ns = time.monotonic_ns()
        line_with(board, fault="freeze:0.5", over=True)
        assert os.read(port, 1) == b"\0"
        frames = board.read_frames(3)
        assert board.start["epoch_monotonic_ns"] + frames[0].board_us * 1000 >= opened_ns
        assert board.decoder.malformed == board.decoder.crc_errors == board.decoder.partial == 0


def test_one_that_opens_the_port_of_the_published_sketch_at_once(tmp_path: Path) -> None:
    # The text has no time of a frame: here the counts tell it, which grow by 50 a second.
    recording = tmp_path / "ramp.npy"
    np.save(recording, np.stack([np.zeros((32, 32), np.uint16), np.full((32, 32), 1000, np.uint16)]))
    played = ("--recording", recording, "--recording-rate-hz", 0.05, "--noise-counts", 0)
    with BoardProcess(tmp_path, *QUICK, *played, "--protocol", "raster_ascii") as board:
        board.decoder = RasterDecoder()
        board.open_port()
        leave_unread(board)
        # A board that a busy machine has held up measures afterwards what the field was then. One that stood still
        # for longer than it catches up does not: what it measures from now on is of the time after the opening.
        board.process.send_signal(signal.SIGSTOP)
        port = board.open_port()
        # As the driver does: what waits there already is the last host's, until the board has noticed.
        termios.tcflush(port, termios.TCIFLUSH)
        opened_s = (time.monotonic_ns() - board.start["epoch_monotonic_ns"]) * 1e-9
        board.stand_still(2 * CATCH_UP_S)
        frames = board.read_frames(3)
        assert frames[0].counts.min() >= 50 * opened_s - 2
        assert board.decoder.malformed == 0


def pass_frames(board: BoardProcess, count: int) -> None:
    """Until the board has measured so many more."""
    first = line_with(board, connected=True)["frames"]
    while board.status()["frames"] < first + count:
        pass


@pytest.mark.parametrize("comes_at_once", [False, True], ids=["the_first_host", "one_directly_after_another"])
def test_a_program_that_opens_and_closes_the_port_of_another_changes_nothing(
    tmp_path: Path, comes_at_once: bool
) -> None:
    with BoardProcess(tmp_path, "--status-period-s", 0.01) as board:
        board.open_port()
        if comes_at_once:
            board.read_frames(20)
            board.process.send_signal(signal.SIGSTOP)
            termios.tcflush(board.open_port(), termios.TCIFLUSH)
            board.process.send_signal(signal.SIGCONT)
        frames = board.read_frames(20)
        for _ in range(20):
            # Some wait to be read.
            pass_frames(board, 10)
            os.close(os.open(board.link, os.O_RDWR | os.O_NOCTTY))
            pass_frames(board, 2)
            frames += board.read_frames(5)
        assert board.decoder.malformed == board.decoder.crc_errors == board.decoder.partial == 0
        lost = frames[-1].sequence - frames[0].sequence + 1 - len(frames)
        assert lost == frames[-1].overruns - frames[0].overruns
