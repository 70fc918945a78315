# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a board's USB side still held of the session before: it counts for nothing."""

from __future__ import annotations

import os
import select
import threading
from pathlib import Path

from pty_board import DEADLINE_S, PtyBoard, frame, wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import BoardSettings, BoardState, Reply, ReplyStatus, cobs, encode_frame
from acts_core.wire.commands import NO_MODEL, encode_reply
from acts_driver.board.session import FIRMWARE
from acts_driver.nodes.intake import Intake
from acts_driver.port import SerialSource
from acts_driver.settings import DriverSettings


def reply_to(command: bytes) -> bytes:
    packet = cobs.decode(command)
    state = BoardState((*FIRMWARE, 0), 7, 0, BoardSettings(), False, False, NO_MODEL, 262_144, 0, 0)
    return encode_reply(Reply(int.from_bytes(packet[4:8], "little"), packet[0], ReplyStatus.OK, 0, state))


def read_command(board: PtyBoard) -> bytes:
    data = b""
    while not data.endswith(cobs.DELIMITER):
        readable, _, _ = select.select([board.master], [], [], DEADLINE_S)
        assert readable, "no command came"
        data += os.read(board.master, 4096)
    return data.split(cobs.DELIMITER)[0]


def open_intake(board: PtyBoard, published: list[SampleFrame]) -> Intake:
    source = SerialSource(str(board.path))
    source.open()
    return Intake(
        DriverSettings(port=str(board.path)),
        source,
        lambda frames, results: published.extend(one for one, _ in frames),
        log=lambda level, message: None,
        on_board=lambda status: None,
    )


def test_frames_of_the_session_before_are_not_used(tmp_path: Path) -> None:
    old = b"".join(encode_frame(frame(number)) for number in range(20))
    new = [frame(number) for number in range(60_000, 60_003)]
    published: list[SampleFrame] = []
    with PtyBoard(tmp_path) as board:
        intake = open_intake(board, published)

        def play() -> None:
            command = read_command(board)
            # In one piece: the reader may find all of it at once.
            board.write(old[5:] + cobs.DELIMITER + reply_to(command) + encode_frame(new[0]))

        player = threading.Thread(target=play)
        player.start()
        intake.start()
        player.join()
        board.write_frames(*new[1:])
        wait_for(lambda: published and published[-1].sequence == new[-1].sequence, "the newest frame")
        intake.stop()
    statistics = intake.stream.statistics
    assert {one.sequence for one in published} <= {one.sequence for one in new}
    assert (statistics.lost, statistics.restarts, intake.stream.clock.state.resets) == (0, 0, 0)


def test_frames_of_a_board_that_does_not_answer_are_used(tmp_path: Path) -> None:
    published: list[SampleFrame] = []
    with PtyBoard(tmp_path) as board:
        intake = open_intake(board, published)
        intake.start()
        assert intake.session is not None
        assert intake.session.wait_for_verdict(DEADLINE_S)
        board.write_frames(frame(5))
        wait_for(lambda: published, "the frame")
        intake.stop()
    assert published[0].sequence == 5
