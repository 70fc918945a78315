# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a board's USB side still held of the session before: it counts for nothing."""

from __future__ import annotations

import os
import select
import threading
from functools import partial
from pathlib import Path

from pty_board import DEADLINE_S, PtyBoard, frame, wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import (
    BoardSettings,
    BoardState,
    Reply,
    ReplyStatus,
    StreamDecoder,
    cobs,
    encode_frame,
    encode_query,
)
from acts_core.wire.commands import NO_MODEL, encode_reply
from acts_driver.board.session import FIRMWARE
from acts_driver.nodes.intake import Intake
from acts_driver.port import SerialSource, StaleFrames
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


def test_a_reply_to_the_program_before_does_not_make_the_frames_behind_it_new() -> None:
    to_other, to_this = (reply_to(encode_query(number).removesuffix(cobs.DELIMITER)) for number in (4, 5))
    decoder = StreamDecoder(lambda message: stale_frames.receive(message))
    stale_frames = StaleFrames(decoder)
    data = [encode_frame(frame(number)) for number in range(3)]
    frames = decoder.feed(data[0] + to_other + data[1] + to_this + data[2])
    # All of it was read at once, and the dialogue has gone on before the frames were handed on.
    assert [one.sequence for one in stale_frames.new(frames, is_known=True)] == [2]


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


class FullBoard(SerialSource):
    """A port whose board sends at once, whenever it is opened, what it has kept since nobody read it."""

    def __init__(self, board: PtyBoard, kept: bytes) -> None:
        super().__init__(str(board.path))
        self._board = board
        self._kept = kept

    def open(self) -> None:
        super().open()
        self._board.write(self._kept)


def test_lines_without_a_time_that_waited_in_the_board_are_not_taken_for_present_ones(tmp_path: Path) -> None:
    published: list[list[int]] = []
    with PtyBoard(tmp_path) as board:
        source = FullBoard(board, b"3,100\r\n" + b"900,0,0,0,0,0,100\r\n" * 50)
        source.open()
        intake = Intake(
            DriverSettings(port=str(board.path), protocol="raster_ascii", rows=2, cols=3, reconnect_s=0.02),
            source,
            lambda frames, results: published.extend(one.counts.tolist() for one, _ in frames),
            log=lambda level, message: None,
            on_board=lambda status: None,
        )
        intake.start()
        board.write(b"1,2,3,4,5,6,100\r\n")
        wait_for(lambda: published, "the line that was printed when the port was open")
        assert published == [[1, 2, 3, 4, 5, 6]]
        board.unplug()
        wait_for(lambda: not intake.reader.connected, "the loss")
        board.plug_in()
        wait_for(lambda: intake.reader.reconnects == 1, "the port")
        write = partial(board.write, b"6,5,4,3,2,1,100\r\n")
        wait_for(lambda: len(published) > 1, "lines of the port that is back", meanwhile=write)
        intake.stop()
    assert {tuple(counts) for counts in published[1:]} == {(6, 5, 4, 3, 2, 1)}
    assert intake.stream.statistics.lost == 0
