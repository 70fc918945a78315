# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A page that the server refuses, or that a slow line keeps behind, in a real browser: it says so, and goes on."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.web import display, server

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = [needs_browser, pytest.mark.slow]


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """Its browser may complain: of refusals it does."""
    made = browser.new_page()
    yield made
    made.context.close()


def test_a_page_without_the_token_asks_for_it(page: Page, play: Callable[..., Player]) -> None:
    player = play()
    player.server._token = "a-token"
    page.goto(player.url)
    told = page.locator("#connection")
    expect(told).to_have_text(
        f"the server refuses this page: does the address have its token, or are {server.MAX_CLIENTS} pages open?"
    )
    # Of a server that is gone it tells that it is.
    player.close()
    expect(told).to_have_text("server gone, trying again")


def test_a_page_too_many_waits_for_its_turn(
    page: Page, play: Callable[..., Player], monkeypatch: pytest.MonkeyPatch
) -> None:
    player = play()
    with monkeypatch.context() as patched:
        patched.setattr(server, "MAX_CLIENTS", 0)
        page.goto(player.url)
        expect(page.locator("#connection")).to_have_attribute("data-state", "refused")
    expect(page.locator("#connection")).to_have_text("connected")
    expect(page.locator(".skin .pill")).to_have_text("live")


def test_a_page_says_that_it_is_behind_where_a_slow_line_holds_much(
    page: Page, play: Callable[..., Player], monkeypatch: pytest.MonkeyPatch
) -> None:
    late_s = 0.0
    # As of a tunnel, which takes megabytes at once and passes them on later.
    monkeypatch.setattr(display, "time", SimpleNamespace(monotonic=lambda: time.monotonic() - late_s))
    player = play()
    page.goto(player.url)
    told = page.locator("#connection")
    expect(told).to_have_text("connected")
    late_s = 10.0
    expect(told).to_have_text("connected, but what is shown is seconds old: the line is slow")
    late_s = 0.0
    expect(told).to_have_text("connected")
    expect(told).to_have_attribute("data-state", "live")
