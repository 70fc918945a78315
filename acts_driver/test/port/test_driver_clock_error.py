# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Stamps against the truth of a real virtual board with a fast clock; `acts bench latency` tells how good they are."""

import time
from pathlib import Path

import numpy as np
import pytest
from driver_rig import DEADLINE_S
from virtual_board import VirtualBoard

from acts_core.wire import StreamDecoder
from acts_driver.port import SerialSource
from acts_driver.stream import FrameStream

pytestmark = pytest.mark.slow

DRIFT_PPM = 300.0
SETTLE_US = 3_000_000
END_US = 6_000_000


def test_stamps_are_the_true_times(tmp_path: Path) -> None:
    rows: list[tuple[int, int, int]] = []
    with VirtualBoard(tmp_path / "board", "--drift-ppm", str(DRIFT_PPM)) as board:
        source = SerialSource(str(board.link))
        stream, decoder = FrameStream(32, 32), StreamDecoder()
        source.open()
        deadline_s = time.monotonic() + DEADLINE_S
        while not rows or rows[-1][0] - rows[0][0] < END_US:
            assert time.monotonic() < deadline_s, "too few frames"
            data = source.read()
            # The monotonic clock, which nobody sets or slews; the board's start is known on it.
            arrival_ns = time.monotonic_ns()
            for frame, stamp_ns in stream.accept(decoder.feed(data), arrival_ns):
                rows.append((frame.board_us, stamp_ns, arrival_ns))
        source.close()
        board_us, stamps_ns, arrivals_ns = np.array(rows, dtype=np.int64).T
        truth_us = board_us / (1 + DRIFT_PPM * 1e-6)
        counts = board_us - board_us[0] >= SETTLE_US
        error_us = ((stamps_ns - board.start["epoch_monotonic_ns"]) / 1000 - truth_us)[counts]
        late_us = ((arrivals_ns - board.start["epoch_monotonic_ns"]) / 1000 - truth_us)[counts]
    # A stamp is never better than the shortest way, and never worse than the arrival. The bound is for a
    # machine that is busy with other things.
    assert np.median(np.abs(error_us)) < 5000
    assert (error_us <= late_us + 1).all()
    assert stream.clock.state.resets == 0
