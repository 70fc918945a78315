# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The dialogue with a board: with a real virtual board, with silent, stuck and deaf ones, and on a lossy way."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest
from board_host import PATIENT_S, Host, LossyWay, SimpleBoard
from hypothesis import given, settings
from hypothesis import strategies as st
from pty_board import PtyBoard, wait_for
from virtual_board import VirtualBoard

from acts_core.errors import PortError
from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, BoardModel, BoardSettings, object_library, patch_dictionary
from acts_core.wire.board_models import ModelKind
from acts_driver.board import BoardLink, NoAnswerError, NotHeardError, RefusedError

pytestmark = pytest.mark.slow


def test_query_and_configure(host: Host) -> None:
    state = host.link.query().state
    assert (state.board_id, state.settings.m, state.settings.rows) == (77, 55, 32)
    wanted = BoardSettings(scheme="uniform", m=64, frame_period_us=2000)
    assert host.link.configure(wanted).state.settings == wanted
    assert host.link.query().state.settings == wanted
    wait_for(lambda: host.sizes[-1:] == [64], "frames of the new size")
    assert host.decoder.crc_errors + host.decoder.malformed == 0


def test_a_refusal_names_the_setting_and_changes_nothing(host: Host) -> None:
    before = host.link.query().state.settings
    # The virtual board has as many row lines as the Teensy: 32.
    with pytest.raises(RefusedError, match="refuses the setting rows"):
        host.link.configure(BoardSettings(rows=64))
    assert host.link.query().state.settings == before


def dictionary(n_atoms: int) -> BoardModel:
    return patch_dictionary(np.random.default_rng(5).normal(size=(64, n_atoms)))


def test_models_are_uploaded(host: Host) -> None:
    model = dictionary(300)
    reply = host.link.upload(model)
    assert reply is not None
    held = reply.state.model
    assert (held.kind, held.rows, held.columns, held.crc32) == (ModelKind.PATCH_DICTIONARY, 64, 300, model.crc32)
    library = object_library(np.eye(1024, 6), np.arange(6) % 3)
    reply = host.link.upload(library)
    assert reply is not None
    assert reply.state.model.crc32 == library.crc32


def test_a_silent_board_costs_bounded_time(tmp_path: Path) -> None:
    with PtyBoard(tmp_path) as board:
        host = Host(board.path, reply_timeout_s=0.02)
        with pytest.raises(NoAnswerError, match="does not answer commands"):
            host.link.query()
        host.close()


class BusyHost(Host):
    """One whose consumer stands still until all tries of a command are over, or for good."""

    def __init__(self, path: Path, *, gets_on: bool) -> None:
        self._gets_on = gets_on
        self._stands_still, self._goes_on = threading.Event(), threading.Event()
        super().__init__(path, reply_timeout_s=0.1)
        assert self._stands_still.wait(60.0)

    def _take(self, frames: list[SampleFrame], arrival_ns: int) -> None:
        self._stands_still.set()
        self._goes_on.wait(60.0)
        super()._take(frames, arrival_ns)

    def catch_up(self, timeout_s: float) -> bool:
        if not self._gets_on:
            return super().catch_up(0.0)
        self._goes_on.set()
        return super().catch_up(60.0)

    def close(self) -> None:
        self._goes_on.set()
        super().close()


def test_an_answer_that_this_machine_reads_late_is_one(board: VirtualBoard) -> None:
    host = BusyHost(board.link, gets_on=True)
    assert host.link.query().state.board_id == 77
    host.close()


def test_an_answer_that_waits_on_the_board_until_this_machine_reads_is_one() -> None:
    board = SimpleBoard()
    waiting: list[BoardMessage] = []

    def read_all(_timeout_s: float) -> bool:
        # The board's queue is sent once there is room for it, behind what has just been read.
        threading.Timer(0.05, lambda: link.receive(waiting[0])).start()
        return True

    link = BoardLink(
        lambda data, _timeout_s: waiting.extend(board.receive(data)),
        reply_timeout_s=PATIENT_S,
        tries=1,
        catch_up=read_all,
    )
    assert link.query().ok


def test_a_machine_that_does_not_get_to_reading_says_so_of_itself(board: VirtualBoard) -> None:
    host = BusyHost(board.link, gets_on=False)
    with pytest.raises(NotHeardError, match="this machine is too slow or too busy to read all"):
        host.link.query()
    session = host.start_session(m=64)
    assert not session.status.is_silent
    assert "this machine is too slow" in session.status.problem
    host.close()


def test_a_board_that_has_answered_before_is_no_older_firmware(tmp_path: Path) -> None:
    control = tmp_path / "control"
    with VirtualBoard(tmp_path / "board", "--control", str(control)) as board:
        host = Host(board.link)

        def ask_until_it_is_frozen() -> None:
            for _ in range(1000):
                host.link.query()

        host.link.query()
        host.link._timeout_s = 0.05
        control.write_text("freeze:60\n")
        with pytest.raises(NoAnswerError, match="does not answer commands any more"):
            ask_until_it_is_frozen()
        host.close()


def test_a_board_that_makes_images_for_long_is_waited_for(tmp_path: Path) -> None:
    with VirtualBoard(tmp_path / "board", "--recovery-us", "1000000") as board:
        host = Host(board.link)
        host.link.upload(dictionary(20))
        host.link.configure(BoardSettings(output="image"))
        # Less than the board takes for an image, however often it is asked.
        host.link._timeout_s = 0.2
        for _ in range(3):
            assert host.link.query().state.settings.output == "image"
        assert host.link.configure(BoardSettings()).state.settings.output == "samples"
        host.close()


def test_a_board_that_takes_no_bytes_blocks_neither_writing_nor_closing(tmp_path: Path) -> None:
    with PtyBoard(tmp_path) as board:
        host = Host(board.path)
        with pytest.raises(PortError, match="takes no bytes"):
            host.source.write(bytes(1_000_000), 0.05)

        def write() -> None:
            with pytest.raises(PortError, match="is not open"):
                host.source.write(b"x", 60.0)

        writer = threading.Thread(target=write)
        writer.start()
        host.close()
        # Nobody has it open now: the waiting writer learns of that.
        wait_for(lambda: not writer.is_alive(), "the writer to give up")
        with pytest.raises(PortError, match="is not open"):
            host.source.write(b"x", 0.05)


@given(st.lists(st.sampled_from([(True, False), (False, True), (False, False)]), max_size=12))
@settings(max_examples=60, deadline=None)
def test_an_upload_survives_lost_commands_and_replies(losses: list[tuple[bool, bool]]) -> None:
    # Never three in a row: that is a board that does not answer.
    kept = [loss if number % 3 else (False, False) for number, loss in enumerate(losses)]
    board = SimpleBoard()
    model = dictionary(20)
    LossyWay(board, kept).link.upload(model)
    assert board.held == model.payload


def test_an_upload_goes_on_where_this_machine_did_not_read_replies_for_a_while() -> None:
    board, model = SimpleBoard(), dictionary(20)
    begin_and_a_piece = [(False, False)] * 2
    LossyWay(board, begin_and_a_piece + [(False, True)] * 6, is_read=False).link.upload(model)
    assert (board.held, board.begun) == (model.payload, 1)


def test_an_upload_that_is_never_heard_of_ends_with_the_reason() -> None:
    way = LossyWay(SimpleBoard(), [(False, False), *[(False, True)] * 1000], is_read=False)
    with pytest.raises(NotHeardError, match="this machine is too slow or too busy to read all"):
        way.link.upload(dictionary(20))
