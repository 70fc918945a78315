# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The status line of what was launched."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from acts_tools.running.stopping import StopFlag
from acts_tools.running.watcher import Watcher


@pytest.fixture
def launch() -> Iterator[subprocess.Popen[bytes]]:
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as process:
        yield process
        process.kill()


def watched(launch: subprocess.Popen[bytes], line: str) -> None:
    """Wait until messages have been processed once, and end the line."""
    seen = SimpleNamespace(steps=0)

    def take_in() -> None:
        seen.steps += 1

    with StopFlag() as stop:
        watcher = Watcher(take_in, launch, stop, lambda: line)
        assert watcher.until(lambda: seen.steps > 0, 30.0)
        watcher.end()


@pytest.mark.parametrize("is_terminal", [True, False])
def test_an_empty_line_does_not_tear_a_table_apart(
    launch: subprocess.Popen[bytes],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    is_terminal: bool,
) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: is_terminal)
    watched(launch, "")
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(("is_terminal", "shown"), [(True, "\r\x1b[K7 N\n"), (False, "7 N\n")])
def test_a_line_is_shown_and_ended(
    launch: subprocess.Popen[bytes],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    is_terminal: bool,
    shown: str,
) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: is_terminal)
    watched(launch, "7 N")
    assert capsys.readouterr().out == shown
