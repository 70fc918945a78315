# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page for who sees little or nothing, in a real browser: what is read out, keys turned off, large text."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from view_browser import BROWSER, DEADLINE_MS, expect, needs_browser
from view_player import Player, reload

from acts_view.skin.snapshot import Frame

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = [needs_browser, pytest.mark.slow]

OFFERS = [[do, "/plate"] for do in ("tare", "calibrate", "balance", "stop_balancing", "grasp", "release", "set")]
# Keeps what changes and is read out, in the order in which it changes.
LISTEN = """() => {
  window.told = [];
  const listen = (changes) => {
    for (const { target } of changes) {
      const region = (target.closest ? target : target.parentElement).closest("[aria-live], [role=status], output");
      if (region && region.getAttribute("aria-live") !== "off") window.told.push(region.textContent);
    }
  };
  new MutationObserver(listen).observe(document.body, { subtree: true, childList: true, characterData: true });
}"""


def test_what_changes_by_itself_is_not_read_out_but_an_answer_is(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    forces_n = count(1)

    def change(frame: Frame) -> Frame:
        assert frame.touch is not None
        return replace(frame, touch=(*frame.touch[:2], next(forces_n), *frame.touch[3:]))

    player = play(change=change)
    recording = {"on": True, "note": "", "files": [], "name": "touch", "bytes": 0, "messages": 0, "lost": 0}
    recordings = ({**recording, "elapsed_s": float(second)} for second in count())
    replays = ({"name": "press", "playing": True, "position_s": float(at), "length_s": 900.0} for at in count())
    player.status = {"recording": next(recordings), "replay": next(replays)}
    page = open_page(player)
    line, where = page.locator("#recording .answer"), page.locator("#replay output")
    expect(line).to_have_text("touch: 0 s, 0.0 MB, 0 messages, 0 lost")
    page.evaluate(LISTEN)
    player.status = {"recording": next(recordings), "replay": next(replays)}
    expect(line).to_contain_text("touch: 1 s")
    expect(where).to_have_text("1.0 of 900.0 s")
    before = page.inner_text("[data-number=force]")
    expect(page.locator("[data-number=force]")).not_to_have_text(before)
    assert page.evaluate("() => window.told") == []
    # What is said of its end is.
    player.status["recording"] = {**recording, "on": False, "note": "5 messages in 1.0 s"}
    expect(line).to_have_text("5 messages in 1.0 s")
    assert "5 messages in 1.0 s" in page.evaluate("() => window.told")


@pytest.fixture
def large(browser: Browser) -> Iterator[Browser]:
    """Where letters are 32 px high, not 16."""
    made = browser.browser_type.launch(executable_path=BROWSER, args=["--blink-settings=defaultFontSize=32"])
    yield made
    made.close()


def sizes(page: Page) -> list[float]:
    """Of the letters of elements that are sentences or figures [px]."""
    return list(
        page.evaluate(
            """() => ["#diagnostics .message", "#note", "[data-number=force]"].map(
              (one) => parseFloat(getComputedStyle(document.querySelector(one)).fontSize))"""
        )
    )


@pytest.mark.parametrize("width", [360, 1280])
def test_all_text_is_as_large_as_its_reader_wants_it_and_the_page_no_wider(
    play: Callable[..., Player], open_page: Callable[..., Page], large: Browser, width: int
) -> None:
    player = play()
    files = [["touch_2026-11-26_10-20-30.mcap", 12_345_678]]
    player.status = {"offers": OFFERS, "recording": {"on": False, "note": "", "files": files}, "note": "only shows"}
    usual = open_page(player, width)
    usual.wait_for_selector("#diagnostics .message")
    page = large.new_page(viewport={"width": width, "height": 900})
    page.set_default_timeout(DEADLINE_MS)
    page.goto(player.url)
    page.wait_for_selector(".skin .pill[data-state=live]")
    page.wait_for_selector("#controls [data-name=m]")
    page.wait_for_selector(".regions li")
    page.wait_for_selector("#diagnostics .message")
    assert sizes(page) == [2 * size for size in sizes(usual)]
    assert page.evaluate("() => document.documentElement.scrollWidth") <= width
    # The picture has not made way for the words.
    expect(page.locator(".canvases")).to_be_visible()
    picture = page.locator(".canvases").bounding_box()
    assert picture is not None
    assert picture["width"] >= min(width / 2, 700)


def test_of_a_taxel_that_is_pointed_at_only_what_a_person_does_is_read_out(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    forces = count(100)

    def change(frame: Frame) -> Frame:
        assert frame.image is not None
        return replace(frame, image=np.full_like(frame.image, next(forces)))

    page = open_page(play(change=change))
    pointed = page.locator(".pointed")
    page.focus("canvas.marks")
    page.evaluate(LISTEN)
    page.keyboard.press("ArrowDown")
    expect(pointed).to_contain_text("row 16, column 16 ·")
    before = pointed.inner_text()
    expect(pointed).not_to_have_text(before)
    page.keyboard.press("ArrowDown")
    expect(pointed).to_contain_text("row 17, column 16 ·")
    told = page.evaluate("() => window.told")
    assert [words.split(" · ")[0] for words in told] == ["row 16, column 16", "row 17, column 16"]
    assert "counts" in told[0]


def test_where_a_system_chooses_the_colours_one_sees_which_buttons_are_pressed_and_the_scale(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(), forced_colors="active")
    style = "(element, name) => getComputedStyle(element)[name]"
    contacts, smooth = page.locator("#contacts"), page.locator("#smooth")
    expect(contacts).to_have_attribute("aria-pressed", "true")
    expect(smooth).to_have_attribute("aria-pressed", "false")
    assert contacts.evaluate(style, "backgroundColor") != smooth.evaluate(style, "backgroundColor")
    for drawn in (".ramp", ".bar-of-force", ".bar-of-force i"):
        assert page.locator(drawn).first.evaluate(style, "forcedColorAdjust") == "none", drawn


def test_the_buttons_of_the_bar_are_a_group_and_promise_no_keys_of_a_toolbar(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play())
    expect(page.get_by_role("group", name="What is shown").get_by_role("button", name="Pause")).to_be_visible()


def test_keys_that_are_turned_off_stay_off_and_buttons_have_theirs(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play())
    page.click("#keys")
    reload(page)
    expect(page.locator("#keys")).to_have_attribute("aria-pressed", "false")
    page.focus("canvas.marks")
    for key in ("s", "n", "m", "i", "d", "+", " "):
        page.keyboard.press(key)
    page.focus("#measured")
    page.keyboard.press(" ")
    # Of what was pressed only the button acted.
    expect(page.locator("#measured")).to_have_attribute("aria-pressed", "true")
    expect(page.locator("#scale")).to_have_value("fixed")
    expect(page.locator("#theme")).to_have_text("Theme: auto")
    expect(page.locator(".skin .pill")).to_have_text("live")
    page.click("#keys")
    page.keyboard.press("s")
    expect(page.locator("#scale")).to_have_value("adaptive")


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (360, 640)])
def test_what_the_keys_go_to_is_not_covered_by_a_bar(
    play: Callable[..., Player], open_page: Callable[..., Page], width: int, height: int
) -> None:
    player = play()
    player.status = {"offers": OFFERS, "replay": {"name": "x", "playing": True, "position_s": 1.0, "length_s": 9.0}}
    page = open_page(player, width, height)
    page.wait_for_selector("#controls [data-name=m]")
    expect(page.locator("#replay")).to_be_visible()
    # Of a button, a list or a field its corners; the picture may be larger than the window.
    covered = """() => {
      const one = document.activeElement, { left, top, right, bottom } = one.getBoundingClientRect();
      const isSeen = (x, y) => one.contains(document.elementFromPoint(x, y));
      const isWhole = isSeen(left + 6, top + 6) && isSeen(right - 6, bottom - 6);
      const isTold = one.matches("main :is(button, select, input, summary)");
      return isTold && !isWhole ? one.textContent || one.dataset.name : "";
    }"""
    reached = set()
    for key in ("Tab", "Shift+Tab"):
        for _ in range(60):
            page.keyboard.press(key)
            page.evaluate("() => new Promise(requestAnimationFrame)")
            assert page.evaluate(covered) == "", key
            reached.add(page.evaluate("() => document.activeElement.textContent"))
            if page.evaluate("() => document.activeElement === document.body"):
                break
    assert {"Taxels, CSV", "Calibrate", "Release"} <= reached


def test_of_the_row_of_buttons_on_a_phone_what_the_keys_go_to_is_seen_whole(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(), 360, 640)
    is_whole = """() => {
      const own = document.activeElement.getBoundingClientRect();
      const row = document.querySelector(".controls").getBoundingClientRect();
      return own.left >= row.left - 0.5 && own.right <= row.right + 0.5;
    }"""
    reached = []
    for key in [*["Tab"] * 11, *["Shift+Tab"] * 10]:
        page.keyboard.press(key)
        reached.append(page.evaluate("() => document.activeElement.id"))
        assert page.evaluate(is_whole), (key, reached[-1])
    assert (reached[0], reached[10], reached[-1]) == ("scale", "keys", "scale")
    # A press does not move what it is on: of this one 20 pixels are seen.
    place = page.evaluate(
        """() => {
          const [row, smooth] = [".controls", "#smooth"].map((one) => document.querySelector(one));
          const edge = row.getBoundingClientRect().right;
          row.scrollLeft += smooth.getBoundingClientRect().left - edge + 20;
          return [edge - 10, smooth.getBoundingClientRect().top + 10];
        }"""
    )
    page.mouse.click(*place)
    expect(page.locator("#smooth")).to_have_attribute("aria-pressed", "true")


def test_of_a_recording_the_button_says_what_it_does_and_not_that_it_is_pressed(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    off: dict[str, Any] = {"on": False, "note": "", "files": []}
    on = {**off, "on": True, "name": "touch", "elapsed_s": 3.0, "bytes": 0, "messages": 3000, "lost": 0}
    player.status["recording"] = on
    page = open_page(player)
    section = page.locator("#recording .group")
    expect(section.get_by_role("button", name="Stop recording")).to_be_visible()
    assert '- button "Stop recording"\n' in section.aria_snapshot() + "\n"
    background = "(button) => getComputedStyle(button).backgroundColor"
    accent = section.locator("button").evaluate(background)
    player.status["recording"] = off
    expect(section.get_by_role("button", name="Record", exact=True)).to_be_visible()
    # For who sees it, it still looks like what is on.
    assert section.locator("button").evaluate(background) != accent


def test_on_a_dark_system_the_page_is_dark_before_its_script_has_run(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(), color_scheme="dark")
    colours = """() => [document.body, document.querySelector("header"), document.querySelector("#keys")].map((one) => {
      const { backgroundColor, color, colorScheme } = getComputedStyle(one);
      return [backgroundColor, color, colorScheme];
    })"""
    after = page.evaluate(colours)
    page.route("**/main.js", lambda route: route.fulfill(body="", content_type="text/javascript"))
    page.reload()
    assert page.get_attribute("html", "data-theme") is None
    assert page.evaluate(colours) == after
