# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A board that sends frames."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pty_board import PtyBoard
from skin_stream import Stream


@pytest.fixture
def stream(tmp_path: Path) -> Iterator[Stream]:
    with PtyBoard(tmp_path) as board:
        stream = Stream(board)
        yield stream
        stream.ended.set()
        if stream.is_alive():
            stream.join()
