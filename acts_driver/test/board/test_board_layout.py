# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The layout that a session keeps in force on a board, and takes back."""

from __future__ import annotations

import threading

import pytest
from board_host import SIZE, Host, LossyWay, SimpleBoard
from pty_board import wait_for
from virtual_board import VirtualBoard

from acts_core.errors import SettingsError
from acts_core.sampling import SkinMap
from acts_core.skin import layout, taxels_named
from acts_core.wire import Reply
from acts_driver.board import BoardLink, BoardParameters, BoardSession
from acts_driver.board.dialogue import NoAnswerError

pytestmark = pytest.mark.slow


@pytest.mark.usefixtures("patient")
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


@pytest.mark.usefixtures("patient")
def test_a_layout_that_is_no_longer_asked_for_gives_way_to_the_boards_own(host: Host) -> None:
    session = host.start_session(layout="leap_right")
    hand = SkinMap.of(layout("leap_right"))
    assert host.link.query().state.map_crc32 == hand.crc32
    session.change(BoardParameters())
    assert host.link.query().state.map_crc32 == 0
    # One that somebody else has told it stays, as nothing is asked.
    host.link.arrange(hand)
    session.change(BoardParameters(m=64))
    assert host.link.query().state.map_crc32 == hand.crc32
    assert [line for line in host.log if "layout" in line] == [
        "the board has taken the layout leap_right",
        "the board has its own layout again",
    ]


@pytest.mark.usefixtures("patient")
def test_a_board_is_told_of_dead_taxels_as_of_places_without_skin(host: Host) -> None:
    dead = taxels_named("row=3", *SIZE)
    session = host.start_session(dead_taxels="row=3")
    assert host.link.query().state.map_crc32 == SkinMap.of(layout("square", *SIZE), dead).crc32
    session.change(BoardParameters(layout="leap_right", dead_taxels="row=3"))
    assert host.link.query().state.map_crc32 == SkinMap.of(layout("leap_right"), dead).crc32
    session.change(BoardParameters())
    assert host.link.query().state.map_crc32 == 0
    assert [line for line in host.log if "dead" in line or "layout" in line] == [
        "the board has taken the dead taxels",
        "the board has taken the layout leap_right and the dead taxels",
        "the board has its own layout again",
    ]


@pytest.mark.usefixtures("patient")
def test_a_layout_whose_last_reply_was_lost_gives_way_as_well(host: Host, monkeypatch: pytest.MonkeyPatch) -> None:
    arrange = BoardLink.arrange

    def unheard(link: BoardLink, skin_map: SkinMap | None) -> Reply:
        arrange(link, skin_map)
        raise NoAnswerError("the board does not answer commands any more")

    session = host.start_session()
    with monkeypatch.context() as lost:
        lost.setattr(BoardLink, "arrange", unheard)
        with pytest.raises(NoAnswerError):
            session.change(BoardParameters(layout="leap_right"))
        assert host.link.query().state.map_crc32 == SkinMap.of(layout("leap_right")).crc32
    session.change(BoardParameters())
    assert host.link.query().state.map_crc32 == 0


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


@pytest.mark.usefixtures("patient")
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


@pytest.mark.usefixtures("patient")
@pytest.mark.parametrize(
    ("parameters", "told"),
    [
        (BoardParameters(dead_taxels="row=3"), "knows no layouts: it may take dead taxels for touched; load"),
        (
            BoardParameters(dead_taxels="3,4", layout="glove"),
            "not as glove has them, and it may take dead taxels for touched; load",
        ),
    ],
)
def test_what_follows_where_a_board_knows_no_layouts_is_told(parameters: BoardParameters, told: str) -> None:
    log: list[str] = []
    link = LossyWay(SimpleBoard(), []).link
    session = BoardSession(link, parameters, size=SIZE, log=lambda _, words: log.append(words))
    session.ask()
    session.change(parameters)
    assert sum(told in words for words in log) == 1
