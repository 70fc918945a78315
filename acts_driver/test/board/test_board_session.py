# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is wanted of a board, and its session that keeps it in force: with virtual boards, silent and reset ones."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from board_host import SIZE, Host, OtherLink
from pty_board import PtyBoard, wait_for
from virtual_board import VirtualBoard
from waiting import pause

from acts_core.errors import BoardError, SettingsError
from acts_core.wire import BoardMessage, BoardSettings, BoardState, Reply, ReplyStatus
from acts_core.wire.board_models import ModelKind
from acts_core.wire.commands import NO_MODEL
from acts_core.wire.packets import PacketType
from acts_driver.board import BoardLink, BoardParameters, BoardSession, BoardStatus
from acts_driver.board.dialogue import RefusedError
from acts_driver.board.model_file import load_model
from acts_driver.board.session import FIRMWARE

pytestmark = pytest.mark.slow


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


def test_a_change_that_cannot_be_leaves_the_old_wish(host: Host) -> None:
    session = host.start_session(m=64)
    with pytest.raises(SettingsError, match="no uniform grid"):
        session.change(BoardParameters(scheme="uniform", m=57))
    with pytest.raises(BoardError, match=r"no\.npz"):
        session.change(BoardParameters(model="/no.npz"))
    session.wake()
    assert host.link.query().state.settings.m == 64
    assert session.status.problem == ""


def test_a_model_whose_file_was_rewritten_is_uploaded_when_it_is_asked_for_again(host: Host, tmp_path: Path) -> None:
    path = tmp_path / "d.npz"
    np.savez(path, atoms=np.eye(64))
    first = load_model(path).crc32
    session = host.start_session(model=str(path))
    wait_for(lambda: host.link.query().state.model.crc32 == first, "the model")
    # A file of another length, in case that the clock of the disk is coarse.
    np.savez(path, atoms=np.eye(64)[:, :32])
    second = load_model(path).crc32
    assert second != first
    session.change(BoardParameters(model=str(path)))
    wait_for(lambda: host.link.query().state.model.crc32 == second, "the new model")
    # One that is gone is no reason to refuse another parameter.
    path.unlink()
    session.change(BoardParameters(model=str(path), m=64))
    state = host.link.query().state
    assert (state.settings.m, state.model.crc32) == (64, second)


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
        before = len(host.sizes)
        control.write_text("reset:0\n")
        # The session may ask the board just then: they are few.
        wait_for(lambda: 55 in host.sizes[before:], "the board's own frames")
        # As the node does when the frames show it; otherwise it is noticed within a second.
        session.wake()
        wait_for(lambda: host.sizes[-1:] == [64], "frames of 64 again")
        assert host.reader.reconnects == 0
        session.change(BoardParameters())
        assert host.link.query().state.settings.scheme == "adaptive", "its own settings were not mistaken"
        host.close()


class LateLink(BoardLink):
    """A way to an imagined board whose answers are read some time after they were given [s], on a clock of its own."""

    def __init__(self, settings: BoardSettings) -> None:
        super().__init__(lambda data, timeout_s: None)
        self.settings = settings
        self.now_s, self.late_s = 100.0, 0.0

    def query(self) -> Reply:
        state = BoardState((*FIRMWARE, 0), 7, int(self.now_s * 1e6), self.settings, False, False, NO_MODEL, 0, 0, 0, 0)
        self.now_s += self.late_s
        return Reply(0, PacketType.QUERY, ReplyStatus.OK, 0, state)

    def configure(self, settings: BoardSettings) -> Reply:
        self.settings = settings
        return self.query()


def test_an_answer_that_is_read_late_is_of_no_restarted_board(monkeypatch: pytest.MonkeyPatch) -> None:
    link = LateLink(BoardSettings(m=55))
    monkeypatch.setattr("acts_driver.board.session.time", SimpleNamespace(monotonic=lambda: link.now_s))
    session = BoardSession(link, BoardParameters(), size=SIZE, log=lambda level, words: None)
    session.ask()
    session.change(BoardParameters(m=64))
    link.now_s += 1.0
    # As by a process that was stopped.
    link.late_s = 5.0
    assert session.ask().settings.m == 64
    link.now_s, link.late_s = link.now_s + 1.0, 0.0
    session.change(BoardParameters())
    assert link.settings.m == 55, "its own settings were not mistaken"


def test_what_a_board_is_told_that_was_reset_in_the_midst_of_the_dialogue_is_not_its_own() -> None:
    link = OtherLink()
    link.is_reset_by_configuring = True
    session = BoardSession(link, BoardParameters(m=64), size=SIZE, log=lambda level, words: None)
    session.start()
    wait_for(lambda: link.settings.m == 64, "the settings")
    session.ask()
    session.change(BoardParameters())
    session.stop()
    assert link.settings.m == 55


def test_a_board_of_another_size_in_the_place_of_one_that_had_just_started_keeps_its_size() -> None:
    link = OtherLink()
    link.settings, link.started_s = BoardSettings(rows=16, cols=16, m=20), time.monotonic()
    session = BoardSession(link, BoardParameters(led="on"), size=SIZE, log=lambda level, words: None)
    session.change(BoardParameters(led="on"))
    session.ask()
    # A simulated one that is started again, with other options: up for a little longer than the one before when seen.
    link.settings = BoardSettings(m=55)
    session.change(BoardParameters(led="off"))
    assert link.settings == BoardSettings(m=55, led="off")


class RefusingLink(OtherLink):
    """A way to an imagined board that takes no settings."""

    def __init__(self) -> None:
        super().__init__()
        self.asked = self.told = 0

    def query(self) -> Reply:
        self.asked += 1
        return super().query()

    def configure(self, settings: BoardSettings) -> Reply:
        self.told += 1
        raise RefusedError(replace(super().query(), status=ReplyStatus.SETTING_REFUSED))


def test_what_a_board_refuses_it_is_not_told_again_and_again() -> None:
    link = RefusingLink()
    session = BoardSession(link, BoardParameters(m=64), size=SIZE, log=lambda level, words: None)
    session.start()
    wait_for(lambda: session.status.problem, "the refusal")
    n_before = link.asked

    def ask() -> None:
        session.wake()
        pause()

    wait_for(lambda: link.asked > n_before + 3, "questions", meanwhile=ask)
    assert link.told == 1
    with pytest.raises(RefusedError):
        session.change(BoardParameters(m=63))
    assert link.told >= 2, "another wish is"
    session.stop()


def test_another_board_in_the_place_of_the_one_before_is_told() -> None:
    link, log = OtherLink(), []
    session = BoardSession(link, BoardParameters(), size=SIZE, log=lambda level, words: log.append((level, words)))
    session.ask()
    # The same one, reset.
    link.started_s = time.monotonic()
    session.ask()
    assert (session.replacements, log) == (0, [])
    link.board_id = 8
    for _ in range(2):
        session.ask()
    assert session.replacements == 1
    [(level, words)] = log
    assert level == "warning"
    assert words.startswith("the port leads to board 8 now, it was board 7 before: ")


def test_a_refused_parameter_is_told_again_after_an_outage(tmp_path: Path) -> None:
    control = tmp_path / "control"
    with VirtualBoard(tmp_path / "board", "--control", str(control)) as board:
        host = Host(board.link)
        session = host.start_session(m=2000)
        assert "m = 2000" in session.status.problem
        # Longer than the session waits between two questions.
        control.write_text("unplug:2.5\n")
        wait_for(lambda: session.status.state is None, "the loss")
        wait_for(lambda: session.status.state is not None, "the board again")
        assert "m = 2000" in session.status.problem
        host.close()


def test_a_size_unlike_the_parameters_is_named(host: Host) -> None:
    session = host.start_session(size=(16, 24))
    wait_for(lambda: session.status.problem, "the problem")
    assert "the board measures 32 x 32 taxels, the parameters rows and cols say 16 x 24" in session.status.problem


@pytest.mark.parametrize("wanted", [{"layout": "leap_right"}, {"dead_taxels": "row=20"}, {"m": 300}])
@pytest.mark.usefixtures("patient")
def test_of_a_board_of_another_size_the_size_is_told_not_what_does_not_fit_it(
    tmp_path: Path, wanted: dict[str, object]
) -> None:
    sizes = "the board measures 16 x 16 taxels, the parameters rows and cols say 32 x 32"
    with VirtualBoard(tmp_path / "board", "--rows", "16", "--cols", "16") as board:
        host = Host(board.link)
        session = host.start_session(SIZE, **wanted)
        wait_for(lambda: sizes in session.status.problem, "the problem")
        with pytest.raises(BoardError, match=sizes):
            session.change(BoardParameters(**wanted))  # type: ignore[arg-type]
        host.close()


def test_a_silent_board_may_be_listened_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = [0]
    query = BoardLink.query

    def counted_query(link: BoardLink) -> Reply:
        asked[0] += 1
        return query(link)

    monkeypatch.setattr(BoardLink, "query", counted_query)
    with PtyBoard(tmp_path) as board:
        host = Host(board.path, reply_timeout_s=0.02)
        session = host.start_session(m=64)
        assert session.may_publish
        assert session.status == BoardStatus(problem=session.status.problem, is_silent=True)
        # Once, however often it is asked.
        n_before = asked[0]

        def ask() -> None:
            session.wake()
            pause()

        wait_for(lambda: asked[0] > n_before + 3, "questions", meanwhile=ask)
        assert sum(line.endswith("the parameters about the board are not in force") for line in host.log) == 1
        with pytest.raises(BoardError, match="does not answer"):
            session.change(BoardParameters(m=32))
        begin_s = time.monotonic()
        host.close()
        assert time.monotonic() - begin_s < 10.0


def test_a_model_on_its_way_is_not_told_as_missing_where_the_board_was_not_heard_for_a_while(
    board: VirtualBoard, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "model.npz"
    np.savez(path, atoms=np.random.default_rng(5).normal(size=(64, 100)).astype(np.float32))
    is_busy = threading.Event()
    unread: list[BoardMessage] = []
    receive = BoardLink.receive

    def read(link: BoardLink, message: BoardMessage) -> None:
        """This machine gets to reading nothing from the first piece of the upload on."""
        if isinstance(message, Reply) and message.state.uploading and not unread:
            is_busy.set()
            link._timeout_s = 0.02
        if is_busy.is_set():
            unread.append(message)
        else:
            receive(link, message)

    monkeypatch.setattr(BoardLink, "receive", read)
    monkeypatch.setattr(Host, "catch_up", lambda host, timeout_s: not is_busy.is_set())
    host = Host(board.link)
    session = host.start_session(output="image", m=64, model=str(path))
    assert session.status.problem == ""
    # With the fourth, one round is over in which the board was asked three times and not heard.
    wait_for(lambda: sum(one.command == PacketType.QUERY for one in unread if isinstance(one, Reply)) > 3, "a round")
    is_busy.clear()
    wait_for(lambda: any("has taken the model" in line for line in host.log), "the model")
    host.close()
    assert not [line for line in host.log if "holds no model" in line]
