# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page in a real browser, fed by the server without ROS: what a person sees and can do."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from view_browser import expect, needs_browser
from view_player import COL, ROW, Player, pressed, reload, saved, saved_table

from acts_view.skin.snapshot import SkinShape

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]


def taxel_colours(page: Page) -> np.ndarray:
    """Red, green and blue in the middle of every taxel of a square skin, as they are on the page."""
    pixels = page.evaluate(
        """() => {
          const canvas = document.querySelector("canvas.taxels"), side = canvas.width / 32, colours = [];
          const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
          for (let row = 0; row < 32; row += 1) for (let col = 0; col < 32; col += 1) {
            const at = 4 * (Math.floor((row + 0.5) * side) * canvas.width + Math.floor((col + 0.5) * side));
            colours.push([...data.subarray(at, at + 3)]);
          }
          return colours;
        }"""
    )
    return np.array(pixels).reshape(32, 32, 3)


def test_a_press_is_where_it_is_with_its_numbers(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    colours = taxel_colours(page).astype(int)
    elsewhere = np.ones((32, 32), bool)
    elsewhere[ROW, COL] = False
    assert (colours[elsewhere] == [0x44, 0x01, 0x54]).all()
    # 800 of 1023 counts, in viridis.
    np.testing.assert_allclose(colours[ROW, COL], [113, 206, 86], atol=4)
    expect(page.locator("[data-number=rate]")).to_have_text("1000")
    numbers = {name: page.inner_text(f"[data-number={name}]") for name in ("force", "x", "y", "peak", "area", "lost")}
    assert numbers == {"force": "1.25", "x": "19.7", "y": "32.8", "peak": "800", "area": "19", "lost": "0"}
    assert page.locator(".contacts tbody tr").first.inner_text().split() == ["42", "1.25", "800", "19", "125"]
    assert "plate/driver" in page.inner_text("#diagnostics")
    assert "Warning" in page.inner_text("#diagnostics")
    assert "Is the board plugged in and powered?" in page.inner_text("#diagnostics .advice")
    marks = page.evaluate(
        "() => { const c = document.querySelector('canvas.marks');"
        " return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some((byte) => byte) }"
    )
    assert marks


def test_a_taxel_tells_its_value_to_mouse_and_keyboard(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play())
    box = page.locator("canvas.marks").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + (COL + 0.5) * box["width"] / 32, box["y"] + (ROW + 0.5) * box["height"] / 32)
    pointed = page.locator(".pointed")
    assert pointed.inner_text() == f"row {ROW}, column {COL} · 800 counts · ± 0 counts (100 % sure) · measured now"
    page.focus("canvas.marks")
    page.keyboard.press("ArrowDown")
    assert pointed.inner_text().startswith(f"row {ROW + 1}, column {COL} · 0 counts")
    assert pointed.inner_text().endswith("measured 12.3 ms before")
    page.keyboard.press("Escape")
    assert pointed.inner_text() == ""


def dots(page: Page) -> list[list[int]]:
    """Rows and columns of the taxels in whose middle the page has drawn something over the picture."""
    found = page.evaluate(
        """() => {
          const canvas = document.querySelector("canvas.marks"), side = canvas.width / 32, found = [];
          const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
          for (let row = 0; row < 32; row += 1) for (let col = 0; col < 32; col += 1) {
            const at = 4 * (Math.floor((row + 0.5) * side) * canvas.width + Math.floor((col + 0.5) * side));
            if (data[at + 3]) found.push([row, col]);
          }
          return found;
        }"""
    )
    assert isinstance(found, list)
    return found


def test_dots_are_on_the_taxels_that_were_measured(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    page.click("#contacts")
    page.click("#measured")
    assert dots(page) == [[ROW, COL]]


def test_outlines_are_drawn_in_place_of_rings(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    row, col = 15.5 + 0.05 / 0.004375, 15.5
    # In the middle of the triangle's lower edge.
    drawn = """([row, col]) => {
      const canvas = document.querySelector("canvas.marks"), side = canvas.width / 32;
      const [x, y] = [Math.round((col + 0.5) * side), Math.round((row + 0.5) * side)];
      const copy = new OffscreenCanvas(1, 1).getContext("2d");
      copy.drawImage(canvas, x, y, 1, 1, 0, 0, 1, 1);
      return copy.getImageData(0, 0, 1, 1).data[3] > 0;
    }"""
    page.wait_for_function(drawn, arg=[row, col])
    page.keyboard.press("o")
    page.wait_for_function(f"(place) => !({drawn})(place)", arg=[row, col])


def test_what_is_shown_can_be_saved(
    play: Callable[..., Player], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    page = open_page(play())
    expect(page.locator("[data-number=rate]")).to_have_text("1000")
    picture = saved(page, "picture", tmp_path)
    assert picture.name.startswith("plate_20")
    assert picture.read_bytes().startswith(b"\x89PNG")
    tables = {what: saved_table(page, what, tmp_path) for what in ("taxels", "contacts", "plots")}
    assert len(tables["taxels"]) == 1024
    pressed_taxel = tables["taxels"][ROW * 32 + COL]
    assert pressed_taxel.pop("force_n") == "1.08123"
    assert pressed_taxel == {
        "row": str(ROW), "col": str(COL), "x_m": "0.0196875", "y_m": "0.0328125",
        "counts": "800", "confidence": "255", "age_s": "0",
    }  # fmt: skip
    assert [tables["taxels"][place]["age_s"] for place in (0, 1)] == ["", "0.0123"]
    (contact,) = tables["contacts"]
    assert (contact["number"], contact["force_n"], contact["speed_m_s"]) == ("42", "1.25", "0.125")
    assert {row["force_max_n"] for row in tables["plots"]} == {"1.25"}
    times_s = [float(row["time_s"]) for row in tables["plots"]]
    assert times_s == sorted(times_s)
    assert abs(times_s[-1] - time.time()) < 60.0


def test_an_image_of_another_size_than_the_skins_is_told_and_gives_no_table(
    play: Callable[..., Player], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    small = np.full((16, 16), 300, np.uint16)
    page = open_page(play(change=lambda frame: replace(frame, image=small)))
    told = "not shown: an image of 16 × 16 taxels, of a skin that has 32 × 32"
    expect(page.locator(".lacks")).to_have_text(told)
    names: list[str] = []
    page.on("download", lambda download: names.append(download.suggested_filename))
    page.click("[data-save=taxels]")
    contacts = saved(page, "contacts", tmp_path)
    assert names == [contacts.name]


def test_the_image_is_shown_in_newtons(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    page.keyboard.press("n")
    expect(page.locator(".legend .unit")).to_have_text("N")
    # 768 of 1023 counts by the default response: 0.005 N + 0.3 N * 768 / 255.
    expect(page.locator(".top")).to_have_text("0.91")
    page.focus("canvas.marks")
    for _ in range(2):
        page.keyboard.press("ArrowUp")
    expect(page.locator(".pointed")).to_contain_text("0.000 N (0 counts)")
    # 800 counts are 1.08 N, more than the top of the fixed scale; the adaptive one goes up to it.
    np.testing.assert_allclose(taxel_colours(page)[ROW, COL], [0xFD, 0xE7, 0x25], atol=2)
    page.select_option("#scale", "adaptive")
    expect(page.locator(".top")).to_have_text("1.08")
    page.select_option("#unit", "counts")
    expect(page.locator(".top")).to_have_text("800")


def test_choices_act_and_survive_a_reload(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    page.keyboard.press("s")
    expect(page.locator(".top")).to_have_text("800")
    # The largest value is the top of the scale: viridis ends in yellow.
    np.testing.assert_allclose(taxel_colours(page)[ROW, COL], [0xFD, 0xE7, 0x25], atol=2)
    page.select_option("#colours", "cividis")
    page.click("#theme")
    page.click("#smooth")
    reload(page)
    chosen = [page.input_value(name) for name in ("#scale", "#colours")]
    assert chosen == ["adaptive", "cividis"]
    assert page.get_attribute("#smooth", "aria-pressed") == "true"
    assert page.get_attribute("html", "data-theme") == "light"
    assert tuple(taxel_colours(page)[31, 0]) == (0x00, 0x22, 0x4E)


def test_the_page_is_light_or_dark_as_the_system_is_until_one_is_chosen(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(), color_scheme="light")
    body = page.locator("body")
    expect(body).to_have_css("background-color", "rgb(244, 245, 242)")
    page.emulate_media(color_scheme="dark")
    expect(body).to_have_css("background-color", "rgb(16, 20, 21)")
    page.click("#theme")
    expect(page.locator("#theme")).to_have_text("Theme: light")
    expect(body).to_have_css("background-color", "rgb(244, 245, 242)")


def test_keys_act_wherever_the_last_click_was(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    # A click leaves the focus on the button.
    page.click("#measured")
    page.keyboard.press("s")
    expect(page.locator("#scale")).to_have_value("adaptive")
    # Of the keys only the blank is the button's own.
    page.keyboard.press(" ")
    expect(page.locator("#measured")).to_have_attribute("aria-pressed", "false")
    expect(page.locator(".skin .pill")).to_have_text("live")
    page.focus("canvas.marks")
    page.keyboard.press(" ")
    expect(page.locator(".skin .pill")).to_have_text("paused")


@pytest.mark.parametrize(("key", "pressed_of"), [("i", "#smooth"), (" ", "#pause")])
def test_a_key_that_is_kept_down_acts_once(
    play: Callable[..., Player], open_page: Callable[..., Page], key: str, pressed_of: str
) -> None:
    page = open_page(play(), 360, 640)
    page.focus("canvas.marks")
    before = page.evaluate("() => scrollY")
    for _ in range(4):
        page.keyboard.down(key)
    expect(page.locator(pressed_of)).to_have_attribute("aria-pressed", "true")
    assert page.evaluate("() => scrollY") == before
    page.keyboard.up(key)
    page.keyboard.press(key)
    expect(page.locator(pressed_of)).to_have_attribute("aria-pressed", "false")


def test_keys_act_after_a_choice_in_the_toolbar(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    page.focus("#colours")
    page.select_option("#colours", "cividis")
    page.keyboard.press("s")
    expect(page.locator("#scale")).to_have_value("adaptive")
    page.keyboard.press(" ")
    expect(page.locator(".skin .pill")).to_have_text("paused")
    # A list that has the focus and was not used has its keys for itself.
    page.focus("#window")
    page.keyboard.press("i")
    expect(page.locator("#smooth")).to_have_attribute("aria-pressed", "false")


def test_a_pause_holds_the_figures_and_a_skin_that_appears_in_it(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    page = open_page(player)
    expect(page.locator("[data-number=rate]")).to_have_text("1000")
    beside = open_page(player)
    # Of what was lost in the first fifth of a second it is not told.
    player.wait_for_history(0.5)
    page.click("#pause")
    _, frame, (sample, *_) = pressed("/plate", player.newest_s)
    player.server.show_frame("/plate", frame, [sample._replace(lost=7)])
    player.server.show_shape("/late", SkinShape())
    # Again and again: one that is silent for a second is not live any more.
    player.names += ("/late",)
    for shown in (page, beside):
        expect(shown.locator("[data-skin='/late'] .pill")).to_have_text("paused" if shown is page else "live")
    expect(beside.locator("[data-skin='/plate'] [data-number=lost]")).to_have_text("7")
    # A part of the plots is of the same moment, and so are the figures.
    page.keyboard.press("+")
    assert page.inner_text("[data-skin='/plate'] [data-number=lost]") == "0"
    assert page.inner_text("[data-skin='/late'] [data-number=peak]") == "–"
    page.click("#pause")
    expect(page.locator("[data-skin='/plate'] [data-number=lost]")).to_have_text("7")
    expect(page.locator("[data-skin='/late'] [data-number=peak]")).to_have_text("800")


def test_what_of_a_skin_cannot_be_shown_here_is_said(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(shape=SkinShape(force_response="/nowhere/skin.npz")), 360, 740)
    expect(page.get_by_text("no newtons: /nowhere/skin.npz cannot be read here")).to_be_visible()
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")


def test_choices_of_two_pages_are_kept(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    first = open_page(play())
    with first.expect_popup() as opening:
        first.evaluate("() => { window.open(location.href); }")
    second = opening.value
    second.wait_for_selector(".skin .pill[data-state=live]")
    first.select_option("#scale", "adaptive")
    second.select_option("#colours", "cividis")
    expect(second.locator("#scale")).to_have_value("fixed")
    first.reload()
    expect(first.locator("#scale")).to_have_value("adaptive")
    expect(first.locator("#colours")).to_have_value("cividis")


def test_keys_go_through_a_list_and_then_on(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    colours = page.locator("#colours")
    colours.focus()
    page.keyboard.press("ArrowDown")
    page.keyboard.press("ArrowDown")
    expect(colours).to_have_value("greys")
    page.keyboard.press("Tab")
    expect(page.locator("#window")).to_be_focused()


@pytest.mark.parametrize(("width", "height"), [(1280, 800), (1920, 1080)])
def test_picture_and_legend_fit_the_window_and_nothing_leaves_its_card(
    play: Callable[..., Player], open_page: Callable[..., Page], width: int, height: int
) -> None:
    page = open_page(play(("/left", "/right")), width, height)
    expect(page.locator(".regions li")).to_have_count(4)
    legend = page.locator(".legend").first.bounding_box()
    assert legend is not None
    assert legend["y"] + legend["height"] < height
    assert legend["width"] > 0.3 * width
    outside = page.evaluate(
        """() => [...document.querySelectorAll(".skin *")].filter((element) => {
          const own = element.getBoundingClientRect(), card = element.closest(".skin").getBoundingClientRect();
          return own.right > card.right - 8;
        }).map((element) => element.className)"""
    )
    assert outside == []


def test_a_server_that_is_gone_and_back(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    first = play()
    page = open_page(first)
    first.close()
    page.wait_for_selector("#connection[data-state=gone]")
    play(port=first.server.address.port)
    page.wait_for_selector("#connection[data-state=live]")
    page.wait_for_selector(".skin .pill[data-state=live]")
    expect(page.locator("[data-number=rate]")).to_have_text("1000")


@pytest.mark.parametrize("width", [360, 768])
def test_a_small_window_shows_all_without_scrolling_sideways(
    play: Callable[..., Player], open_page: Callable[..., Page], width: int
) -> None:
    page = open_page(play(("/left", "/right")), width, 800, color_scheme="dark")
    expect(page.locator(".skin .pill[data-state=live]")).to_have_count(2)
    assert page.evaluate("document.documentElement.scrollWidth") == width
    bar = page.locator("header.bar").bounding_box()
    assert bar is not None
    # Of a phone's title and buttons: the skin is what the page is for.
    assert bar["height"] < (100 if width == 360 else 140)
    box = page.locator("canvas.taxels").first.bounding_box()
    assert box is not None
    assert box["width"] > 0.5 * min(width, 600)
    assert box["width"] == pytest.approx(box["height"], abs=1)
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(16, 20, 21)"
