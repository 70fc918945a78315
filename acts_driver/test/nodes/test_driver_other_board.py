# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Another board is plugged in at the port of the one before, as where two boards change names."""

from __future__ import annotations

import os
import select
import threading
import time
from pathlib import Path

from pty_board import PtyBoard, frame, wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import BoardSettings, BoardState, Reply, ReplyStatus, cobs
from acts_core.wire.commands import NO_MODEL, encode_reply
from acts_driver.board.session import FIRMWARE
from acts_driver.nodes.intake import Intake
from acts_driver.port import SerialSource
from acts_driver.settings import DriverSettings

# Some hundred frames a second.
FRAME_S = 0.01
EXACT_NS = 50_000_000


class TalkingBoard(threading.Thread):
    """Answers with its serial number, and sends frames with the times of its clock."""

    def __init__(self, port: PtyBoard, board_id: int, started_us: int) -> None:
        super().__init__(daemon=True)
        self._port = port
        self._board_id = board_id
        self._started_us = started_us
        self._ended = threading.Event()
        self.start()

    def run(self) -> None:
        commands = b""
        while not self._ended.is_set():
            if select.select([self._port.master], [], [], FRAME_S)[0]:
                *whole, commands = (commands + os.read(self._port.master, 4096)).split(cobs.DELIMITER)
                for command in whole:
                    self._port.write(self._reply_to(cobs.decode(command)))
            now_us = self._now_us()
            # By its clock, as of boards that were started together.
            self._port.write_frames(frame(now_us // 1000, board_us=now_us)._replace(duration_us=self._board_id))

    def _reply_to(self, command: bytes) -> bytes:
        settings = BoardSettings()
        state = BoardState((*FIRMWARE, 0), self._board_id, self._now_us(), settings, False, False, NO_MODEL, 0, 0, 0)
        return encode_reply(Reply(int.from_bytes(command[4:8], "little"), command[0], ReplyStatus.OK, 0, state))

    def _now_us(self) -> int:
        return time.monotonic_ns() // 1000 - self._started_us

    def end(self) -> None:
        self._ended.set()
        self.join(20.0)


def test_stamps_are_by_the_clock_of_the_board_that_is_there(tmp_path: Path) -> None:
    taken: list[tuple[SampleFrame, int]] = []
    log: list[str] = []

    def delays_ns(board_id: int) -> list[int]:
        return [delay_ns for one, delay_ns in taken if one.duration_us == board_id]

    with PtyBoard(tmp_path) as port:
        started_us = time.monotonic_ns() // 1000 - 100_000_000
        first = TalkingBoard(port, 7, started_us)
        source = SerialSource(str(port.path))
        source.open()
        intake = Intake(
            DriverSettings(port=str(port.path), reconnect_s=0.05),
            source,
            lambda frames, results: taken.extend((one, time.time_ns() - stamp_ns) for one, stamp_ns in frames),
            log=lambda level, message: log.append(message),
            on_board=lambda status: None,
        )
        intake.start()
        wait_for(lambda: len(delays_ns(7)) > 20, "frames of the first board")
        first.end()
        port.unplug()
        wait_for(lambda: not intake.reader.connected, "the loss")
        last_us = taken[-1][0].board_us
        # Plugged in together with the first one, it has come up a little later; it takes a moment to be found again.
        second_us = started_us + 300_000
        wait_for(lambda: time.monotonic_ns() // 1000 - second_us > last_us + 100_000, "a later time of its clock")
        port.plug_in()
        second = TalkingBoard(port, 8, second_us)
        wait_for(lambda: len(delays_ns(8)) > 20, "frames of the second board")
        second.end()
        intake.stop()
    assert min(delays_ns(7)) < EXACT_NS
    assert min(delays_ns(8)) < EXACT_NS
    assert [line for line in log if "leads to board 8 now, it was board 7" in line]
