# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recording from the page, in a real browser: what it says of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.web.requests import Answer, Request
from acts_view.web.server import READ_ONLY, ViewServer

if TYPE_CHECKING:
    from playwright.sync_api import Page
    from websockets.asyncio.server import ServerConnection

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


def test_what_was_begun_is_ended_by_the_next_press_also_before_the_server_has_told_of_it(
    open_page: Callable[..., Page],
) -> None:
    asked: list[str] = []

    def do(request: Request, answer: Answer) -> None:
        asked.append(request.do)
        answer(True, f"done {len(asked)}")

    server = ViewServer("127.0.0.1", 0, on_clients=lambda _: None, log=lambda *_: None, on_request=do)
    try:
        # It says nothing more.
        server.show_status({"skins": [], "diagnostics": [], "recording": {"on": False, "note": "", "files": []}})
        page = open_page(SimpleNamespace(url=server.address.url), is_live=False)
        button, line = page.locator("#recording > .group > button"), page.locator("#recording .answer")
        for number, words in enumerate(("Stop recording", "Record"), 1):
            button.click()
            expect(line).to_have_text(f"done {number}")
            expect(button).to_have_text(words)
        assert asked == ["record", "stop_recording"]
    finally:
        server.close()


# The page waits for fifteen seconds.
IMPATIENT = """
const wait = window.setTimeout;
window.setTimeout = (call, time_ms, ...given) => wait(call, time_ms === 15000 ? 300 : time_ms, ...given);
"""


def test_a_download_that_stands_still_is_given_up(
    play: Callable[..., Player], open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    player = play()
    player.status["recording"] = {"on": False, "note": "", "files": [["touch.mcap", 2_000_000]]}

    async def send_a_piece(connection: ServerConnection, _path: str) -> None:
        await connection.send(bytes(1_000_000))
        await connection.wait_closed()

    monkeypatch.setattr(player.server._downloads, "_find", lambda _name: tmp_path)
    monkeypatch.setattr(player.server._downloads, "send", send_a_piece)
    page = open_page(player)
    page.add_init_script(IMPATIENT)
    page.reload()
    item = page.locator("#recording .files li")
    item.locator("button").click()
    expect(item).to_contain_text("did not send it to its end; try again")
    expect(item.locator("button")).to_have_attribute("aria-disabled", "false")


# As Chromium does where the file is larger than what it keeps in memory, and it has no disk for the rest.
TOO_SMALL = """
Blob.prototype.arrayBuffer = () => Promise.reject(new DOMException("could not be read", "NotReadableError"));
"""


def test_a_download_that_the_browser_cannot_hold_is_told(
    play: Callable[..., Player], open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    player = play()
    player.status["recording"] = {"on": False, "note": "", "files": [["touch.mcap", 2_000_000]]}
    (tmp_path / "touch.mcap").write_bytes(bytes(2_000_000))
    monkeypatch.setattr(player.server._downloads, "_find", lambda name: tmp_path / name)
    page = open_page(player)
    item = page.locator("#recording .files li")
    with page.expect_download() as downloading:
        item.locator("button").click()
    assert downloading.value.path().stat().st_size == 2_000_000
    page.add_init_script(TOO_SMALL)
    page.reload()
    item.locator("button").click()
    expect(item).to_contain_text("too large for this browser; copy it from the machine that serves this page")
