# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A real browser, servers of the page, and pages that must not complain."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Protocol

import pytest
from view_browser import BROWSER, DEADLINE_MS, INSTALL
from view_player import Player, next_picture

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page


class HasAddress(Protocol):
    """Serves a page."""

    url: str


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    assert BROWSER is not None, INSTALL
    from playwright.sync_api import expect, sync_playwright

    expect.set_options(timeout=DEADLINE_MS)
    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=BROWSER)
        yield launched
        launched.close()


@pytest.fixture
def play() -> Iterator[Callable[..., Player]]:
    players: list[Player] = []

    def begin(*arguments: Any, **options: Any) -> Player:
        players.append(Player(*arguments, **options))
        return players[-1]

    yield begin
    for player in players:
        player.close()


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Callable[..., Page]]:
    pages: list[Page] = []
    complaints: list[str] = []

    def note(line: Any) -> None:
        # A server that is gone is told so by the browser itself.
        if "ERR_CONNECTION_REFUSED" not in line.text:
            complaints.append(line.text)

    def begin(
        player: HasAddress, width: int = 1280, height: int = 900, *, is_live: bool = True, **options: Any
    ) -> Page:
        page = browser.new_page(viewport={"width": width, "height": height}, **options)
        pages.append(page)
        page.set_default_timeout(DEADLINE_MS)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", note)
        page.goto(player.url)
        if is_live:
            page.wait_for_selector(".skin .pill[data-state=live]")
            next_picture(page)
        return page

    yield begin
    for page in pages:
        page.context.close()
    assert complaints == []
