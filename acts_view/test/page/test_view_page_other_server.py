# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A server that ends and is followed by one with other skins, in a real browser: what becomes of the panels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.skin.snapshot import Frame
from acts_view.web import server

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

PLATE, FOOT = "[data-skin='/plate']", "[data-skin='/foot']"


@pytest.fixture
def follow(play: Callable[..., Player], open_page: Callable[..., Page]) -> Callable[..., tuple[Page, Player]]:
    """Open a page, do something on it, and follow its server with one of these skins."""

    def begin(*names: str, meanwhile: Callable[[Page], object] = lambda _: None, **options: Any) -> tuple[Page, Player]:
        first = play()
        page = open_page(first)
        # The same element as now, and the most panels at a time.
        page.evaluate(
            """() => {
              document.querySelector(".skin").dataset.kept = "yes";
              const { dataset } = document.body, skins = document.getElementById("skins");
              const count = () => { dataset.most = Math.max(dataset.most ?? 0, skins.childElementCount); };
              new MutationObserver(count).observe(skins, { childList: true });
            }"""
        )
        meanwhile(page)
        first.close()
        page.wait_for_selector("#connection[data-state=gone]")
        second = play(names, port=first.server.address.port, **options)
        page.wait_for_selector("#connection[data-state=live]")
        return page, second

    return begin


def test_the_panel_of_a_skin_takes_the_place_of_one_that_is_gone(follow: Callable[..., tuple[Page, Player]]) -> None:
    page, _ = follow("/foot")
    expect(page.locator(f"{FOOT} .pill")).to_have_text("live")
    expect(page.locator(PLATE)).to_have_count(0)
    assert page.get_attribute("body", "data-most") == "1"
    assert page.get_attribute("#skins", "data-count") == "1"


def test_a_skin_that_does_not_come_back_goes(follow: Callable[..., tuple[Page, Player]]) -> None:
    page, _ = follow()
    expect(page.locator(f"{PLATE} .pill")).to_have_text("waiting")
    expect(page.locator(PLATE)).to_have_attribute("data-gone", "true")
    expect(page.locator(".skin")).to_have_count(0)
    expect(page.locator("#empty")).to_be_visible()


def test_a_skin_that_comes_back_late_keeps_its_panel(follow: Callable[..., tuple[Page, Player]]) -> None:
    page, second = follow()
    expect(page.locator(f"{PLATE} .pill")).to_have_text("waiting")
    second.names = ("/plate",)
    expect(page.locator(f"{PLATE} .pill")).to_have_text("live")
    expect(page.locator(PLATE)).to_have_attribute("data-gone", "false")
    expect(page.locator(PLATE)).to_have_attribute("data-kept", "yes")


def test_a_paused_panel_stays_until_one_goes_on(follow: Callable[..., tuple[Page, Player]]) -> None:
    page, _ = follow("/foot", meanwhile=lambda page: page.click("#pause"))
    expect(page.locator(f"{FOOT} .pill")).to_have_text("paused")
    expect(page.locator(f"{PLATE} .pill")).to_have_text("paused")
    expect(page.locator(f"{PLATE} [data-number=peak]")).to_have_text("800")
    page.click("#pause")
    expect(page.locator(PLATE)).to_have_count(0)
    expect(page.locator(f"{FOOT} .pill")).to_have_text("live")


def test_of_a_hand_only_what_the_new_server_tells_stays(follow: Callable[..., tuple[Page, Player]]) -> None:
    def smaller(frame: Frame) -> Frame:
        joints = [["thumb_tip", 0.5], ["thumb_base", 0.25]]
        return replace(frame, regions=frame.regions[1:], hand={**frame.hand, "joints": joints})

    page, _ = follow("/plate", change=smaller)
    hand = page.locator(f"{PLATE} .regions")
    expect(hand.locator("li .name")).to_have_text(["index distal"])
    expect(hand.locator("li .force")).to_have_text(["0.75 N"])
    expect(hand.locator(".joints dt")).to_have_text(["thumb tip", "thumb base"])
    expect(hand.locator(".joints dd")).to_have_text(["29", "14"])


def test_what_a_node_has_said_can_be_opened_also_when_the_server_is_gone(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    page = open_page(player)
    player.close()
    page.wait_for_selector("#connection[data-state=gone]")
    page.click("#diagnostics summary")
    expect(page.locator("#diagnostics dl")).to_have_text("portauto")


def test_what_nodes_and_a_recording_were_about_is_dimmed_while_there_is_no_server(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    first = play()
    present = {"name": "touch", "elapsed_s": 3.0, "bytes": 0, "messages": 9, "lost": 0}
    first.status["recording"] = {"on": True, "note": "", "files": [], **present}
    page = open_page(first)
    told = [page.locator(part) for part in (".nodes", "#recording .answer")]
    expect(told[1]).to_contain_text("9 messages")
    for one in told:
        expect(one).to_have_css("opacity", "1")
    first.close()
    for one in told:
        expect(one).to_have_css("opacity", "0.6")
    play(port=first.server.address.port)
    expect(told[0]).to_have_css("opacity", "1")


def test_a_server_with_another_page_gets_it_loaded_but_not_in_a_pause(
    follow: Callable[..., tuple[Page, Player]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def meanwhile(page: Page) -> None:
        page.click("#pause")
        monkeypatch.setattr(server, "version_of", lambda _files: "another")

    page, second = follow("/plate", meanwhile=meanwhile)
    second.status["note"] = "later"
    expect(page.locator("#note")).to_have_text("later")
    expect(page.locator(PLATE)).to_have_attribute("data-kept", "yes")
    page.click("#pause")
    expect(page.locator(f"{PLATE}:not([data-kept]) .pill")).to_have_text("live")
