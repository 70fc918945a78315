# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A virtual board, and a host that is connected to it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from board_host import Host
from virtual_board import VirtualBoard


@pytest.fixture
def board(tmp_path: Path) -> Iterator[VirtualBoard]:
    with VirtualBoard(tmp_path / "board", "--board-id", "77") as board:
        yield board


@pytest.fixture
def host(board: VirtualBoard) -> Iterator[Host]:
    host = Host(board.link)
    yield host
    host.close()
