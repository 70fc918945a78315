# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The driver process on the virtual board: the firmware's own encoder, pseudo-terminal and clock. ROS_DOMAIN_ID 24."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from driver_rig import Rig, end_process, intake_of, start_process
from lifecycle_msgs.msg import Transition
from virtual_board import VirtualBoard
from waiting import wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import RasterDecoder
from acts_driver.port import SerialSource

pytestmark = pytest.mark.slow


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(24)
    yield rig
    rig.close()


@pytest.fixture
def board(tmp_path: Path) -> Iterator[VirtualBoard]:
    options = ("--scheme", "adaptive", "--m", "55", "--rate-hz", "1000", "--drift-ppm", "100")
    board = VirtualBoard(tmp_path / "board", *options)
    yield board
    board.close()


def test_a_thousand_frames_a_second_without_a_loss_on_the_way(board: VirtualBoard, rig: Rig) -> None:
    process = start_process(rig.domain_id, "-p", f"port:={board.link}", "-p", "frame_id:=plate")
    try:
        rig.spin_until(lambda: len(rig.samples) >= 3000, "3000 messages")
        status = rig.status_until(lambda status: int(status.get("frames", "0")) >= 3000, "the report")
        assert rig.state() == "active"
        assert rig.change_state(Transition.TRANSITION_DEACTIVATE)
        assert rig.state() == "inactive"
    finally:
        end_process(process)
    assert process.returncode == 0
    for message in rig.samples:
        assert len(message.indices) == len(message.counts) == len(set(message.indices)) == 55
        assert (message.rows, message.cols, message.scheme, message.header.frame_id) == (32, 32, 3, "plate")
    stamps_ns = np.array(
        [message.header.stamp.sec * 10**9 + message.header.stamp.nanosec for message in rig.samples], dtype=np.int64
    )
    sequences = np.array([message.sequence for message in rig.samples], dtype=np.int64)
    assert (np.diff(stamps_ns) > 0).all()
    assert (np.diff(sequences) > 0).all()
    # The board and its kernel buffer may drop frames on a loaded machine and say so; the driver must lose none besides
    # where it has thrown none away.
    assert int(status["lost"]) - int(status["discarded"]) <= int(status["overruns"])
    assert (status["crc_errors"], status["malformed"], status["wrong_size"]) == ("0", "0", "0")
    # The board tells when its clock was zero; what is between is the shortest time on the way and 100 ppm.
    assert abs(int(status["clock_offset_us"]) - board.start["epoch_realtime_ns"] / 1000) < 20_000
    # One millisecond a frame on the board's clock.
    period_ns = np.diff(stamps_ns) / np.diff(sequences)
    assert abs(np.median(period_ns) - 1e6) < 1e4


def test_a_board_that_dies_and_comes_back_is_followed(board: VirtualBoard, rig: Rig) -> None:
    driver = rig.start_driver(port=board.link, reconnect_s=0.05)
    rig.spin_until(lambda: len(rig.samples) >= 500, "messages")
    board.kill()
    rig.spin_until(lambda: not intake_of(driver).reader.connected, "the loss")
    seen = len(rig.samples)
    # The new board counts its own only.
    overruns_before = intake_of(driver).stream.statistics.overruns
    again = VirtualBoard(board.link)
    try:
        rig.spin_until(lambda: len(rig.samples) >= seen + 50, "messages of the new board")
        status = rig.status_until(lambda status: status.get("reconnects") == "1", "the report")
        assert (status["restarts"], status["crc_errors"], status["malformed"]) == ("1", "0", "0")
        assert int(status["lost"]) - int(status["discarded"]) <= overruns_before + int(status["overruns"])
    finally:
        again.close()


def test_the_virtual_boards_raster_text(tmp_path: Path) -> None:
    board = VirtualBoard(tmp_path / "board", "--protocol", "raster_ascii")
    source = SerialSource(str(tmp_path / "board"))
    decoder = RasterDecoder()
    try:
        source.open()
        frames: list[SampleFrame] = []
        wait_for(lambda: len(frames) >= 5, "frames", meanwhile=lambda: frames.extend(decoder.feed(source.read())))
    finally:
        source.close()
        board.close()
    assert [frame.sequence for frame in frames[:5]] == list(range(5))
    assert (decoder.partial, decoder.malformed) == (1, 0)
    assert all(len(frame.counts) == 1024 and frame.duration_us > 1000 for frame in frames)
