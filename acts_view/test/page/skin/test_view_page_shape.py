# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A skin on the page, in a real browser: drawn when its shape is known, with scale and plots that fit all windows."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player, pressed

from acts_view.skin.snapshot import SkinShape

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

# The half second for which a page waits for the shape never ends.
WAIT_FOR_EVER = """
const wait = window.setTimeout;
window.setTimeout = (call, time_ms, ...given) => (time_ms === 500 ? 0 : wait(call, time_ms, ...given));
"""


def test_a_skin_is_drawn_when_its_shape_is_known(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    player = play(())
    player.server.show_frame(*pressed("/hand", time.time()))
    page = open_page(player, is_live=False)
    page.add_init_script(WAIT_FOR_EVER)
    page.reload()
    skin = page.locator(".skin")
    # Behind it, so that all of the skin has come.
    player.status["note"] = "later"
    expect(page.locator("#note")).to_have_text("later")
    expect(skin).to_have_count(1)
    assert not skin.is_visible()
    player.server.show_shape("/hand", SkinShape(layout="leap_right"))
    expect(skin).to_be_visible()
    expect(skin.locator(".shape")).to_contain_text("13 patches")


def test_a_square_skin_is_drawn_when_it_is_told_to_be_one(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play(())
    player.server.show_frame(*pressed("/plate", time.time()))
    page = open_page(player, is_live=False)
    page.add_init_script(WAIT_FOR_EVER)
    page.reload()
    expect(page.locator(".skin")).to_have_count(1)
    player.server.show_shape("/plate", SkinShape())
    expect(page.locator(".skin")).to_be_visible()


def test_a_skin_that_nobody_describes_is_drawn_all_the_same(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play(())
    player.server.show_frame(*pressed("/plate", time.time()))
    page = open_page(player, is_live=False)
    expect(page.locator(".skin")).to_be_visible()


@pytest.mark.parametrize("width", [360, 1280])
@pytest.mark.parametrize(("rows", "cols"), [(32, 32), (33, 15), (40, 2)])
def test_the_scale_is_as_wide_as_the_picture(
    play: Callable[..., Player], open_page: Callable[..., Page], rows: int, cols: int, width: int
) -> None:
    page = open_page(play(shape=SkinShape(rows=rows, cols=cols)), width)
    picture, scale = (page.locator(one).bounding_box() for one in (".canvases", ".ramp"))
    assert picture is not None
    assert scale is not None
    # Below a very narrow one its words have room, of 16 px a letter.
    assert scale["width"] == pytest.approx(max(picture["width"], 9 * 16), abs=1)
    assert page.evaluate("(ends) => ends.scrollWidth <= ends.clientWidth", page.query_selector(".ends"))


@pytest.mark.parametrize("width", [750, 900, 1024, 1190])
def test_no_plot_is_alone_in_a_row(play: Callable[..., Player], open_page: Callable[..., Page], width: int) -> None:
    page = open_page(play(), width)
    tops = page.eval_on_selector_all(".plots figure", "(all) => all.map((one) => one.offsetTop)")
    assert [tops.count(top) for top in tops] == [2, 2, 2, 2]


def test_a_phone_on_its_side_shows_the_skin_below_one_row_of_buttons_that_does_not_stay(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(), 844, 390, has_touch=True, is_mobile=True)
    bar = page.locator("header.bar")
    tops = page.eval_on_selector_all(".controls > button", "(all) => all.map((one) => one.offsetTop)")
    assert len(set(tops)) == 1
    page.evaluate("window.scrollTo(0, 300)")
    box = bar.bounding_box()
    assert box is not None
    assert box["y"] + box["height"] < 0


def test_a_very_large_screen_has_larger_text_and_pictures(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    sizes = []
    for width, height in ((1920, 1080), (3840, 2160)):
        page = open_page(player, width, height)
        assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
        boxes = (page.locator(one).first.bounding_box() for one in (".canvases", ".plots figure", ".numbers dd"))
        sizes.append([box["height"] for box in boxes if box])
    assert all(large >= 1.45 * usual for usual, large in zip(*sizes, strict=True)), sizes
