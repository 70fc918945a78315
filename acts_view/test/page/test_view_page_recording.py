# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recording from the page, in a real browser: what it says of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.web.server import READ_ONLY

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]


def test_a_refusal_outlives_the_note_of_an_earlier_recording(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    off: dict[str, Any] = {"on": False, "note": "900 messages in 1.0 s", "files": []}
    on = {**off, "on": True, "note": "", "name": "touch", "elapsed_s": 3.0, "bytes": 0, "messages": 3000, "lost": 0}
    player.status["recording"] = off
    page = open_page(player)
    line, note = page.locator("#recording .answer"), page.locator("#note")
    expect(line).to_have_text("900 messages in 1.0 s")
    page.click("#recording > .group > button")
    expect(line).to_have_text(READ_ONLY)
    player.status["note"] = "later"
    expect(note).to_have_text("later")
    assert line.inner_text() == READ_ONLY
    # Of a recording since then it is told, in the same words, too.
    player.status["recording"] = on
    expect(line).to_contain_text("touch: 3 s")
    player.status["recording"] = off
    expect(line).to_have_text("900 messages in 1.0 s")


def test_a_download_keeps_the_focus_where_another_file_comes_and_an_old_one_goes(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    off: dict[str, Any] = {"on": False, "note": "", "files": [["second", 2_000_000], ["first", 1_000_000]]}
    player.status["recording"] = off
    page = open_page(player)
    buttons = page.locator("#recording .files button")
    expect(buttons).to_have_text(["Download second", "Download first"])
    buttons.nth(0).focus()
    player.status["recording"] = {**off, "files": [["third", 3_000_000], ["second", 2_000_000]]}
    expect(buttons).to_have_text(["Download third", "Download second"])
    expect(buttons.nth(1)).to_be_focused()
    # A file that somebody has removed is not as large as it was.
    player.status["recording"] = {**off, "files": [["third", 0], ["second", 2_000_000]]}
    expect(page.locator("#recording .files")).to_contain_text("0.0 MB")
    expect(buttons.nth(1)).to_be_focused()
