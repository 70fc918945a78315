# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How far a work is: a bar where somebody looks, a few lines or nothing in a file."""

from __future__ import annotations

import io

import pytest

from acts_tools.progress import Progress, tell


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_file_has_a_line_now_and_then() -> None:
    stream = io.StringIO()
    with Progress("press", 1000, keep=True, stream=stream) as bar:
        for done in range(1, 1001):
            bar.show(done, "note")
    lines = stream.getvalue().splitlines()
    assert len(lines) == 10
    assert lines[0] == "press 100 of 1000: note"
    assert lines[-1] == "press 1000 of 1000: note"


def test_a_file_has_nothing_of_what_is_not_kept() -> None:
    stream = io.StringIO()
    with Progress("tracking", 2, stream=stream) as bar:
        bar.show(1)
    assert stream.getvalue() == ""


def test_a_bar_that_is_kept_ends_in_what_was_done_and_a_line() -> None:
    stream = Terminal()
    with Progress("iteration", 4, done=1, keep=True, stream=stream) as bar:
        bar.show(2, "fine")
        bar.show(4, "done")
    last = stream.getvalue().split("\r")[-1]
    assert last.startswith("iteration: 100%|")
    assert "4/4" in last
    assert last.endswith(", done]\n")


def test_what_is_told_meanwhile_has_a_line_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr("sys.stdout", terminal)
    monkeypatch.setattr("sys.stderr", terminal)
    with Progress("drops", 4) as bar:
        bar.show(1)
        tell("M = 64")
        bar.show(2)
    before, after = terminal.getvalue().split("M = 64")
    # The bar is gone from the line, and comes again below.
    assert before.split("\r")[-1] == ""
    assert after.startswith("\n\rdrops: 25%|")


def test_a_bar_that_is_not_kept_leaves_an_empty_line_after_an_interruption() -> None:
    stream = Terminal()

    def work() -> None:
        with Progress("tracking", 200, stream=stream) as bar:
            bar.show(50)
            bar.show(201)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        work()
    assert "tracking: 0%|" in stream.getvalue()
    *_, cleared, end = stream.getvalue().split("\r")
    assert cleared.strip() == ""
    assert end == ""
