# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A virtual board, a host that is connected to it, and time for files."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from board_host import Host
from virtual_board import VirtualBoard

from acts_core.runtime import background


@pytest.fixture
def board(tmp_path: Path) -> Iterator[VirtualBoard]:
    with VirtualBoard(tmp_path / "board", "--board-id", "77") as board:
        yield board


@pytest.fixture
def host(board: VirtualBoard) -> Iterator[Host]:
    host = Host(board.link)
    yield host
    host.close()


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """A busy machine may take longer for a layout than a session waits for it before it goes on without."""
    monkeypatch.setattr(background, "PATIENCE_S", 20.0)
