# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is said of the taxel that one points at, in a real browser: it can be read, and it stays."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from view_browser import expect, needs_browser
from view_player import COL, ROW, Player, next_picture, pressed

from acts_view.skin.snapshot import SkinShape

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]


@pytest.mark.parametrize("layout", ["square", "leap_right"])
@pytest.mark.parametrize("width", [360, 1280])
def test_all_of_it_can_be_read_and_nothing_moves(
    play: Callable[..., Player], open_page: Callable[..., Page], width: int, layout: str
) -> None:
    page = open_page(play(shape=SkinShape(layout=layout)), width, 900)
    page.keyboard.press("n")
    below = page.locator(".savers")
    pointed = page.locator(".pointed")
    page.focus("canvas.marks")
    expect(pointed).to_have_text("")
    before = below.evaluate("(element) => element.offsetTop")
    page.keyboard.press("ArrowUp")
    expect(pointed).to_contain_text("measured 12.3 ms before")
    wide, has_wide, high, has_high = pointed.evaluate(
        "(line) => [line.scrollWidth, line.clientWidth, line.scrollHeight, line.clientHeight]"
    )
    assert wide <= has_wide
    assert high <= has_high
    assert below.evaluate("(element) => element.offsetTop") == before


def test_what_was_tapped_stays_until_something_else_is(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(), 360, 740, has_touch=True, is_mobile=True)
    picture = page.locator("canvas.marks")
    picture.scroll_into_view_if_needed()
    box = picture.bounding_box()
    assert box is not None
    # A finger that is lifted leaves the picture, and is seen to.
    picture.evaluate("(canvas) => canvas.addEventListener('pointerleave', () => { canvas.dataset.left = 'yes'; })")
    page.touchscreen.tap(box["x"] + (COL + 0.5) * box["width"] / 32, box["y"] + (ROW + 0.5) * box["height"] / 32)
    expect(picture).to_have_attribute("data-left", "yes")
    expect(page.locator(".pointed")).to_contain_text(f"row {ROW}, column {COL} · 800 counts")
    page.locator("#pause").tap()
    expect(page.locator(".pointed")).to_have_text("")


def test_a_mouse_that_leaves_points_at_nothing(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    page.hover("canvas.marks")
    expect(page.locator(".pointed")).to_contain_text("counts")
    page.hover("#pause")
    expect(page.locator(".pointed")).to_have_text("")


def test_a_taxel_that_a_smaller_skin_does_not_have_is_pointed_at_no_longer(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    server = (player := play(())).server
    server.show_shape("/plate", SkinShape())
    name, frame, samples = pressed("/plate", time.time())
    server.show_frame(name, frame, samples)
    page = open_page(player, is_live=False)
    # With a force of each taxel, that of none cannot be told.
    page.keyboard.press("n")
    pointed = page.locator(".pointed")
    page.focus("canvas.marks")
    for _ in range(10):
        page.keyboard.press("ArrowDown")
    expect(pointed).to_contain_text("row 25, column 16")
    server.show_shape("/plate", SkinShape(rows=16, cols=16))
    small = np.full((16, 16), 300, np.uint16)
    server.show_frame(name, replace(frame, image=small, touch=(0.0, 0.0, 1.0, 300.0, 1e-5)), samples)
    expect(page.locator("[data-number=peak]")).to_have_text("300")
    next_picture(page)
    assert pointed.inner_text() == ""
