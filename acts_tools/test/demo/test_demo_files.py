# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a demonstration tells where its files cannot be written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from acts_core.errors import RecordingError
from acts_tools.demo.ball import run as ball
from acts_tools.demo.files import DemoFiles
from acts_tools.demo.hand import run as hand
from acts_tools.running.stopping import StopFlag


@pytest.mark.parametrize(
    "run",
    [
        lambda files: ball._run(5.0, files, "127.0.0.1", 0),
        lambda files: hand._run([], files, 0, StopFlag()),
    ],
    ids=["ball", "hand"],
)
def test_what_was_measured_is_told_where_it_cannot_be_written(
    run: Callable[[DemoFiles], int],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    files = DemoFiles(*(tmp_path / "gone" / name for name in ("demo.json", "demo.png", "demo.log")))
    for module in (ball, hand):
        monkeypatch.setattr(module, "use_free_domain", lambda: None)
        monkeypatch.setattr(module, "score", lambda _: {"ok": True})
        monkeypatch.setattr(module, "table", lambda *_: "the table")
    monkeypatch.setattr(ball, "watch", lambda *_: None)
    with pytest.raises(RecordingError, match=r"demo\.json: cannot be written"):
        run(files)
    assert "the table" in capsys.readouterr().out
