# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Boards with firmware of another version, or with a scheme that this driver does not know."""

from __future__ import annotations

from pathlib import Path

import pytest
from board_host import SIZE, Host, OtherBoard
from pty_board import PtyBoard, wait_for
from virtual_board import VirtualBoard

from acts_core.errors import BoardError
from acts_driver.board import BoardParameters, BoardSession
from acts_driver.board.session import FIRMWARE

pytestmark = pytest.mark.slow


def test_packets_of_another_version_are_named(tmp_path: Path) -> None:
    with VirtualBoard(tmp_path / "board", "--fault", "version:2") as board:
        host = Host(board.link, reply_timeout_s=0.05)
        session = host.start_session(m=64)
        assert session.status.is_silent
        wait_for(lambda: host.decoder.last_error, "the reason")
        assert "version 2; this release reads version 1: install firmware and driver" in host.decoder.last_error
        assert host.sizes == []
        host.close()


def test_firmware_of_another_version_is_named_and_not_used(host: Host, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("acts_driver.board.session.FIRMWARE", (7, 3))
    session = host.start_session(m=64)
    assert not session.may_publish
    assert session.status.is_wrong_version
    assert "firmware is 0.1.0, this driver needs 7.3.x" in session.status.problem
    assert host.link.query().state.settings.m == 55
    with pytest.raises(BoardError, match=r"needs 7\.3\.x"):
        session.change(BoardParameters(m=32))


def other_session(version: tuple[int, int, int], log: list[str], **parameters: object) -> BoardSession:
    session = BoardSession(
        OtherBoard(version).link,
        BoardParameters(**parameters),  # type: ignore[arg-type]
        size=SIZE,
        log=lambda level, words: log.append(f"{level}: {words}"),
    )
    session.start()
    assert session.wait_for_verdict(20.0)
    return session


def test_firmware_of_another_version_is_named_and_not_used_also_where_its_replies_cannot_be_read() -> None:
    log: list[str] = []
    session = other_session((FIRMWARE[0], FIRMWARE[1] + 1, 0), log)
    assert not session.may_publish
    assert session.status.is_wrong_version
    assert "firmware is 0.2.0, this driver needs 0.1.x" in session.status.problem
    assert log == [f"error: {session.status.problem}"]
    with pytest.raises(BoardError, match=r"needs 0\.1\.x"):
        session.change(BoardParameters(m=32))
    session.stop()


def test_a_board_of_this_version_whose_replies_cannot_be_read_is_listened_to_and_told() -> None:
    """Firmware with a sampling scheme of somebody's own, whose settings this host does not know."""
    log: list[str] = []
    session = other_session((*FIRMWARE, 7), log, m=64)
    assert session.may_publish
    assert session.status.is_silent
    assert "install firmware and driver of the same release, with the same schemes" in session.status.problem
    assert log == [f"warning: {session.status.problem}: the parameters about the board are not in force"]
    session.stop()


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
