# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A machine that is too slow for its board: it gets fewer frames, not older ones."""

from __future__ import annotations

import math
import time
from pathlib import Path

import pytest
from faulty_board import FaultyBoard
from pty_board import wait_for

from acts_core.frames import SampleFrame
from acts_driver.board import BoardResult
from acts_driver.nodes.intake import Intake
from acts_driver.port import SerialSource
from acts_driver.settings import DriverSettings
from acts_driver.stream import BacklogWatch

pytestmark = pytest.mark.slow

MS = 1_000_000
# A terminal gives a read 4 KB, which is 16 frames or a few more: they come faster than this consumes them.
SLOW_S = 0.04


def test_a_backlog_that_lasts_is_told_from_a_stall() -> None:
    watch = BacklogWatch()
    assert not watch.lasts(0, 3000 * MS)
    assert not watch.lasts(400 * MS, 60 * MS)
    # It had caught up.
    assert not watch.lasts(450 * MS, 40 * MS)
    assert not watch.lasts(500 * MS, 60 * MS)
    assert not watch.lasts(900 * MS, 60 * MS)
    assert watch.lasts(1000 * MS, 60 * MS)
    assert not watch.lasts(1050 * MS, 60 * MS)
    assert watch.lasts(1100 * MS, 60 * MS)
    # The host's clock was set back.
    assert not watch.lasts(10 * MS, 60 * MS)
    assert watch.lasts(510 * MS, 60 * MS)


def test_a_machine_that_is_too_slow_gets_fewer_frames_and_not_older_ones(tmp_path: Path) -> None:
    ages_s: list[tuple[float, float]] = []
    is_slow = True

    def consume(frames: list[tuple[SampleFrame, int]], _results: list[tuple[BoardResult, int]]) -> None:
        now_s = time.monotonic()
        ages_s.extend((now_s, 1e-9 * (time.time_ns() - stamp_ns)) for _, stamp_ns in frames)
        if is_slow:
            time.sleep(SLOW_S)

    def oldest_s() -> float:
        now_s = time.monotonic()
        return max((age_s for at_s, age_s in ages_s if at_s > now_s - 1.0), default=math.inf)

    with FaultyBoard(tmp_path) as board:
        source = SerialSource(str(board.link))
        source.open()
        settings = DriverSettings(port=str(board.link))
        intake = Intake(settings, source, consume, log=lambda level, message: None, on_board=lambda status: None)
        intake.start()
        try:
            begin_s = time.monotonic()
            wait_for(lambda: ages_s and ages_s[-1][0] > begin_s + 4.0, "frames of four seconds")
            statistics = intake.stream.statistics
            lost = statistics.lost
            # All that the board and the terminal hold is 1.5 s old, and so would every frame be.
            wait_for(lambda: oldest_s() < 0.8, f"a second of frames that are not older, {oldest_s()} s")
            is_slow = False
            wait_for(lambda: ages_s[-1][1] < 0.02, "a fresh frame")
            totals = intake.report("active", time.time_ns())[2]
        finally:
            intake.stop()
    assert lost > 500
    discarded = int(str(totals["discarded"]))
    assert discarded > 500
    assert int(str(totals["lost"])) - discarded <= int(str(totals["overruns"]))
    assert (totals["crc_errors"], totals["malformed"], totals["clock_resets"], totals["restarts"]) == (0, 0, 0, 0)
