# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Another board is plugged in at the port of the one before, as where two boards change names; ROS_DOMAIN_ID 4."""

from __future__ import annotations

import os
import select
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from driver_rig import Rig
from pty_board import PtyBoard, frame, wait_for
from std_srvs.srv import Trigger

from acts_core.frames import SampleFrame
from acts_core.wire import BoardSettings, BoardState, Reply, ReplyStatus, cobs
from acts_core.wire.commands import NO_MODEL, encode_reply
from acts_driver.baseline import Baseline
from acts_driver.baseline.baseline import BaselineSource
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


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(4)
    yield rig
    rig.close()


def test_a_baseline_of_another_board_is_told_until_the_skin_is_tared(rig: Rig, tmp_path: Path) -> None:
    counts = np.full((32, 32), 12.0, dtype=np.float32)
    path = tmp_path / "skin.npz"
    Baseline(counts, counts / np.float32(10), counts > 0, BaselineSource.CALIBRATION, 0, board_id=7).save(path)
    words = "the baseline is of board 7, and the port leads to board 8: give the port serial:7, or calibrate; "
    with PtyBoard(tmp_path) as port:
        board = TalkingBoard(port, 8, time.monotonic_ns() // 1000)
        rig.start_driver(port=port.path, calibration_file=path, reconnect_s=0.05)
        told = rig.status_until(lambda status: status["message"].startswith(words), "what is wrong with the baseline")
        assert (told["level"], told["baseline_board"], told["board"]) == ("1", "7", "8")
        client = rig.listener.create_client(Trigger, "driver/tare")
        answers: list[str] = []

        def tared() -> bool:
            # Refused where this machine has just stood still.
            answer = client.call_async(Trigger.Request())
            rig.spin_until(answer.done, "the answer")
            answers.append(answer.result().message)
            return bool(answer.result().success)

        rig.spin_until(tared, "a tare")
        told = rig.status_until(lambda status: status.get("baseline") == "tare", "the report after it")
        assert "the baseline is of" not in told["message"]
        assert told["baseline_board"] == "8"
        # Five taxels are in a frame. Of the others nothing is known of this skin.
        assert 5 <= int(told["baseline_taxels"]) < 1024
        assert answers[-1].endswith("; what was known of the skin of board 7 is forgotten")
        board.end()


def test_a_baseline_of_the_board_that_is_there_is_fine(rig: Rig, tmp_path: Path) -> None:
    counts = np.full((32, 32), 12.0, dtype=np.float32)
    path = tmp_path / "skin.npz"
    Baseline(counts, counts / np.float32(10), counts > 0, BaselineSource.CALIBRATION, 0, board_id=8).save(path)
    with PtyBoard(tmp_path) as port:
        board = TalkingBoard(port, 8, time.monotonic_ns() // 1000)
        rig.start_driver(port=port.path, calibration_file=path)
        told = rig.status_until(lambda status: status.get("board") == "8", "word of the board")
        assert "the baseline is of" not in told["message"]
        assert told["baseline_board"] == "8"
        board.end()
