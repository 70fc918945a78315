# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The dialogue with a board: with a real virtual board, with silent, stuck and deaf ones, and on a lossy way."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pty_board import PtyBoard, wait_for
from virtual_board import VirtualBoard

from acts_core.errors import BoardError, PortError, SettingsError
from acts_core.sampling import SkinMap
from acts_core.skin import layout
from acts_core.wire import (
    BoardMessage,
    BoardModel,
    BoardSettings,
    Reply,
    StreamDecoder,
    object_library,
    patch_dictionary,
)
from acts_core.wire.board_models import ModelKind
from acts_driver.board import (
    BoardLink,
    BoardParameters,
    BoardSession,
    BoardStatus,
    NoAnswerError,
    NotHeardError,
    RefusedError,
)
from acts_driver.board.model_file import load_model
from acts_driver.port import Reader, SerialSource

pytestmark = pytest.mark.slow

SIZE = (32, 32)
# Long enough for a machine that does not run the board for a while.
PATIENT_S = 2.0


class Host:
    """A reader on a port, a link to its board, and what is wanted of it."""

    def __init__(self, path: Path, reply_timeout_s: float = PATIENT_S, write_limit_s: float = 10.0) -> None:
        self.source = SerialSource(str(path))
        self.link = BoardLink(
            self.source.write, reply_timeout_s=reply_timeout_s, catch_up=lambda timeout_s: self.catch_up(timeout_s)
        )
        self.decoder = StreamDecoder(self.link.receive)
        self.sizes: list[int] = []
        self.published = 0
        self.log: list[str] = []
        self.session: BoardSession | None = None
        self.reader = Reader(
            self.source, self.decoder, self._take, reconnect_s=0.05, on_reconnect=lambda: self.reconnected()
        )
        self.source.open()
        self.reader.start(is_open=True)

    def _take(self, frames: list[object], arrival_ns: int) -> None:
        self.sizes += [len(one.indices) for one in frames]  # type: ignore[attr-defined]
        if self.session is not None and self.session.may_publish:
            self.published += len(frames)

    def catch_up(self, timeout_s: float) -> bool:
        return self.reader.catch_up(timeout_s)

    def reconnected(self) -> None:
        if self.session is not None:
            self.session.reconnected()

    def start_session(self, size: tuple[int, int] = SIZE, **parameters: object) -> BoardSession:
        self.session = BoardSession(
            self.link,
            BoardParameters(**parameters),  # type: ignore[arg-type]
            size=size,
            log=lambda level, words: self.log.append(words),
        )
        self.session.start()
        assert self.session.wait_for_verdict(20.0)
        return self.session

    def close(self) -> None:
        if self.session is not None:
            self.session.stop()
        self.reader.stop()


@pytest.fixture
def board(tmp_path: Path) -> Iterator[VirtualBoard]:
    with VirtualBoard(tmp_path / "board", "--board-id", "77") as board:
        yield board


@pytest.fixture
def host(board: VirtualBoard) -> Iterator[Host]:
    host = Host(board.link)
    yield host
    host.close()


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
    held = host.link.upload(model).state.model
    assert (held.kind, held.rows, held.columns, held.crc32) == (ModelKind.PATCH_DICTIONARY, 64, 300, model.crc32)
    library = object_library(np.eye(1024, 6), np.arange(6) % 3)
    assert host.link.upload(library).state.model.crc32 == library.crc32


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
        super().__init__(path, reply_timeout_s=0.02)
        assert self._stands_still.wait(60.0)

    def _take(self, frames: list[object], arrival_ns: int) -> None:
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
        host = Host(board.link, reply_timeout_s=0.05)

        def ask_until_it_is_frozen() -> None:
            for _ in range(1000):
                host.link.query()

        host.link.query()
        control.write_text("freeze:60\n")
        with pytest.raises(NoAnswerError, match="does not answer commands any more"):
            ask_until_it_is_frozen()
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


class LossyWay:
    """A way to an imagined board that loses commands and replies as it is told, and keeps the others in order."""

    def __init__(self, board: SimpleBoard, losses: list[tuple[bool, bool]]) -> None:
        self.link = BoardLink(self._write, reply_timeout_s=0.001)
        self._board = board
        self._losses = losses

    def _write(self, data: bytes, timeout_s: float) -> None:
        lost_out, lost_in = self._losses.pop(0) if self._losses else (False, False)
        if not lost_out:
            for reply in self._board.receive(data):
                if not lost_in:
                    self.link.receive(reply)


class SimpleBoard:
    """Takes uploads as docs/wire_protocol.md says, with the real codec of this host on both ends."""

    def __init__(self) -> None:
        self.uploaded = bytearray()
        self.held = b""

    def receive(self, data: bytes) -> list[BoardMessage]:
        from acts_core.wire import BoardState, ReplyStatus, cobs_reference
        from acts_core.wire.board_messages import decode_message
        from acts_core.wire.commands import NO_MODEL, encode_reply
        from acts_core.wire.packets import PacketType, unseal

        kind, content = unseal(cobs_reference.decode(data[:-1]))
        request = int.from_bytes(content[:4], "little")
        status, detail = ReplyStatus.OK, 0
        if kind == PacketType.UPLOAD_BEGIN:
            self.uploaded.clear()
        elif kind == PacketType.UPLOAD_DATA:
            if int.from_bytes(content[4:8], "little") == len(self.uploaded):
                self.uploaded += content[8:]
            else:
                status = ReplyStatus.UPLOAD_OUT_OF_ORDER
            detail = len(self.uploaded)
        elif kind == PacketType.UPLOAD_END:
            self.held = bytes(self.uploaded)
        state = BoardState((0, 1, 0), 1, 0, BoardSettings(), False, True, NO_MODEL, 262_144, 0, 0)
        packet = encode_reply(Reply(request, kind, status, detail, state))
        return [decode_message(cobs_reference.decode(packet[:-1]))]


@given(st.lists(st.sampled_from([(True, False), (False, True), (False, False)]), max_size=12))
@settings(max_examples=60, deadline=None)
def test_an_upload_survives_lost_commands_and_replies(losses: list[tuple[bool, bool]]) -> None:
    # Never three in a row: that is a board that does not answer.
    kept = [loss if number % 3 else (False, False) for number, loss in enumerate(losses)]
    board = SimpleBoard()
    model = dictionary(20)
    LossyWay(board, kept).link.upload(model)
    assert board.held == model.payload


def test_the_session_brings_the_board_to_what_is_wanted(host: Host) -> None:
    session = host.start_session(scheme="tracking", m=100, rate_cap_hz=500.0, led="off")
    assert session.may_publish
    assert session.status.problem == ""
    assert session.status.state is not None
    found = session.status.state.settings
    assert (found.scheme, found.m, found.frame_period_us, found.led) == ("tracking", 100, 2000, "off")
    # The board's own share of 11 of 55 is kept.
    assert found.search_quota == 20
    wait_for(lambda: host.sizes[-1:] == [100], "frames of 100")
    session.change(BoardParameters(m=64, search_share=0.5))
    assert host.link.query().state.settings.scheme == "adaptive", "what is not asked is the board's own again"
    session.change(BoardParameters())
    assert host.link.query().state.settings == BoardSettings.from_sampling(BoardParameters().sampling(32, 32))


def test_the_session_keeps_the_layout_of_the_board(board: VirtualBoard, host: Host) -> None:
    session = host.start_session(layout="leap_right")
    hand = SkinMap.of(layout("leap_right"))
    assert host.link.query().state.map_crc32 == hand.crc32
    # Somebody else has told it otherwise.
    host.link.arrange(None)
    session.wake()
    wait_for(lambda: host.link.query().state.map_crc32 == hand.crc32, "the layout again")
    session.change(BoardParameters(layout="square"))
    assert host.link.query().state.map_crc32 == 0
    with pytest.raises(SettingsError, match=r"none\.yaml: cannot be read"):
        session.change(BoardParameters(layout="/none.yaml"))
    assert session.status.problem == ""
    assert [line for line in host.log if "layout" in line] == [
        "the board has taken the layout leap_right",
        "the board has taken the layout leap_right",
        "the board has taken the layout square",
    ]


def test_a_layout_that_takes_long_to_read_is_told_to_the_board_then(
    host: Host, monkeypatch: pytest.MonkeyPatch
) -> None:
    is_there, read = threading.Event(), BoardParameters.skin_map

    def slowly(parameters: BoardParameters, rows: int, cols: int) -> SkinMap | None:
        is_there.wait(10.0)
        return read(parameters, rows, cols)

    monkeypatch.setattr(BoardParameters, "skin_map", slowly)
    session = host.start_session(layout="leap_right")
    assert host.link.query().state.map_crc32 == 0
    assert session.status.problem == ""
    is_there.set()
    hand = SkinMap.of(layout("leap_right"))
    wait_for(lambda: host.link.query().state.map_crc32 == hand.crc32, "the layout")


def test_a_board_that_knows_no_layouts_is_told_of_once() -> None:
    board, log = SimpleBoard(), []
    session = BoardSession(
        LossyWay(board, []).link,
        BoardParameters(layout="glove"),
        size=SIZE,
        log=lambda level, words: log.append((level, words)),
    )
    for _ in range(3):
        session.ask()
        session.change(BoardParameters(layout="glove"))
    told = [words for level, words in log if level == "warning"]
    assert len(told) == 1
    assert "knows no layouts" in told[0]
    session.change(BoardParameters(layout="square"))
    assert session.status.problem == ""


def test_a_change_that_cannot_be_leaves_the_old_wish(host: Host) -> None:
    session = host.start_session(m=64)
    with pytest.raises(SettingsError, match="no uniform grid"):
        session.change(BoardParameters(scheme="uniform", m=57))
    with pytest.raises(BoardError, match=r"no\.npz"):
        session.change(BoardParameters(model="/no.npz"))
    session.wake()
    assert host.link.query().state.settings.m == 64
    assert session.status.problem == ""


def test_a_board_that_was_reset_is_told_again(board: VirtualBoard, host: Host, tmp_path: Path) -> None:
    np.savez(tmp_path / "d.npz", atoms=np.eye(64))
    session = host.start_session(m=64, model=str(tmp_path / "d.npz"))
    board.kill()
    wait_for(lambda: not host.reader.connected, "the loss")
    with VirtualBoard(board.link, "--board-id", "78", "--threshold", "99"):
        wait_for(
            lambda: (
                session.status.state is not None
                and session.status.state.board_id == 78
                and session.status.state.model.kind is ModelKind.PATCH_DICTIONARY
            ),
            "the new board with its model",
        )
        assert session.may_publish
        found = host.link.query().state
        assert (found.settings.m, found.settings.threshold_counts) == (64, 99)
        assert found.model.crc32 == load_model(tmp_path / "d.npz").crc32


def test_a_board_that_resets_itself_behind_an_open_port_is_told_again(tmp_path: Path) -> None:
    control = tmp_path / "control"
    with VirtualBoard(tmp_path / "board", "--control", str(control)) as board:
        host = Host(board.link)
        session = host.start_session(m=64, scheme="random")
        assert session.status.state is not None
        wait_for(lambda: host.sizes[-1:] == [64], "frames of 64")
        control.write_text("reset:0\n")
        wait_for(lambda: host.sizes[-1:] == [55], "the board's own frames")
        # As the node does when the frames show it; otherwise it is noticed within a second.
        session.wake()
        wait_for(lambda: host.sizes[-1:] == [64], "frames of 64 again")
        assert host.reader.reconnects == 0
        session.change(BoardParameters())
        assert host.link.query().state.settings.scheme == "adaptive", "its own settings were not mistaken"
        host.close()


def test_packets_of_another_version_are_named(tmp_path: Path) -> None:
    with VirtualBoard(tmp_path / "board", "--fault", "version:2") as board:
        host = Host(board.link, reply_timeout_s=0.05)
        session = host.start_session(m=64)
        assert session.status.is_silent
        wait_for(lambda: host.decoder.last_error, "the reason")
        assert "version 2; this release reads version 1: install firmware and driver" in host.decoder.last_error
        assert host.sizes == []
        host.close()


def test_a_size_unlike_the_parameters_is_named(host: Host) -> None:
    session = host.start_session(size=(16, 24))
    wait_for(lambda: session.status.problem, "the problem")
    assert "the board measures 32 x 32 taxels, the parameters rows and cols say 16 x 24" in session.status.problem


def test_firmware_of_another_version_is_named_and_not_used(host: Host, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("acts_driver.board.session.FIRMWARE", (7, 3))
    session = host.start_session(m=64)
    assert not session.may_publish
    assert session.status.is_wrong_version
    assert "firmware is 0.1.0, this driver needs 7.3.x" in session.status.problem
    assert host.link.query().state.settings.m == 55
    with pytest.raises(BoardError, match=r"needs 7\.3\.x"):
        session.change(BoardParameters(m=32))


def test_another_firmware_after_a_silent_board_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("acts_driver.board.session.FIRMWARE", (7, 3))
    with PtyBoard(tmp_path) as board:
        host = Host(board.path, reply_timeout_s=0.2)
        session = host.start_session()
        assert session.may_publish
        board.unplug()
        wait_for(lambda: not host.reader.connected, "the loss")
        with VirtualBoard(board.path):
            wait_for(lambda: session.status.is_wrong_version, "the version")
            wait_for(lambda: len(host.sizes) > 20, "frames")
            assert host.published == 0
        host.close()


def test_a_silent_board_may_be_listened_to(tmp_path: Path) -> None:
    with PtyBoard(tmp_path) as board:
        host = Host(board.path, reply_timeout_s=0.02)
        session = host.start_session(m=64)
        assert session.may_publish
        assert session.status == BoardStatus(problem=session.status.problem, is_silent=True)
        # Once, however often it is asked.
        session.wake()
        assert sum(line.endswith("the parameters about the board are not in force") for line in host.log) == 1
        with pytest.raises(BoardError, match="does not answer"):
            session.change(BoardParameters(m=32))
        begin_s = time.monotonic()
        host.close()
        assert time.monotonic() - begin_s < 10.0
