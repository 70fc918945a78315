# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What of the page nobody sees, in a real browser: it draws nothing there, and the newest when it is seen again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.skin.snapshot import Frame

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

# A browser without a window goes on in a tab that is covered. So, as one with a window does: the page is told that it
# is hidden, and no picture of the screen is made. Counts what is drawn and what has come.
HIDE = """
window.isHidden = false;
window.drawn = window.heard = 0;
Object.defineProperty(document, "hidden", { get: () => window.isHidden });
const request = window.requestAnimationFrame.bind(window), waiting = [];
window.requestAnimationFrame = (call) => (window.isHidden ? waiting.push(call) : request(call));
window.see = () => { window.isHidden = false; waiting.splice(0).forEach(request); };
const clear = CanvasRenderingContext2D.prototype.clearRect;
CanvasRenderingContext2D.prototype.clearRect = function (...box) { window.drawn += 1; clear.apply(this, box); };
const Socket = window.WebSocket;
window.WebSocket = class extends Socket {
  constructor(url) { super(url); this.addEventListener("message", () => { window.heard += 1; }); }
};
"""
PRESSED = """() => {
  const canvas = document.querySelector("canvas.taxels"), side = canvas.width / 32;
  const at = (place) => Math.floor((place + 0.5) * side);
  const copy = new OffscreenCanvas(1, 1).getContext("2d");
  copy.drawImage(canvas, at(3), at(5), 1, 1, 0, 0, 1, 1);
  return copy.getImageData(0, 0, 1, 1).data[0] > 200;
}"""


def heard(page: Page, count: int) -> None:
    """Wait until so many more messages have come; by a timer, since pictures of the screen may not be made."""
    before = page.evaluate("window.heard")
    page.wait_for_function("([before, count]) => window.heard >= before + count", arg=[before, count], polling=50)


def test_a_page_that_nobody_sees_draws_nothing_and_shows_the_newest_when_it_is_seen(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    image = np.zeros((32, 32), np.uint16)

    def change(frame: Frame) -> Frame:
        assert frame.touch is not None
        return replace(frame, image=image.copy(), touch=(*frame.touch[:3], float(image.max()), *frame.touch[4:]))

    page = open_page(play(change=change))
    page.add_init_script(HIDE)
    page.reload()
    page.wait_for_selector(".skin .pill[data-state=live]")
    page.wait_for_function("() => window.drawn > 0")
    page.evaluate("window.isHidden = true")
    # What was begun before comes to its end.
    heard(page, 10)
    drawn = page.evaluate("window.drawn")
    image[5, 3] = 1023
    heard(page, 40)
    assert page.evaluate("window.drawn") == drawn
    assert not page.evaluate(PRESSED)
    page.evaluate("window.see()")
    page.wait_for_function(PRESSED)
    expect(page.locator("[data-number=peak]")).to_have_text("1023")
    expect(page.locator(".skin .pill")).to_have_text("live")


# How often the picture of each skin is drawn.
COUNT = """() => {
  window.counts = {};
  const clear = CanvasRenderingContext2D.prototype.clearRect;
  CanvasRenderingContext2D.prototype.clearRect = function (...box) {
    const name = this.canvas.closest(".skin")?.dataset.skin;
    window.counts[name] = (window.counts[name] ?? 0) + 1;
    clear.apply(this, box);
  };
}"""


def test_of_many_skins_those_far_beyond_the_window_are_drawn_when_one_scrolls_there(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(("/a", "/b", "/c", "/d")), 390, 844)
    page.wait_for_selector("[data-skin='/d'] .pill[data-state=live]")
    page.evaluate(COUNT)
    # What was begun before comes to its end.
    page.wait_for_function("() => window.counts['/a'] > 10")
    page.evaluate("window.counts = {}")
    page.wait_for_function("() => window.counts['/a'] > 50")
    assert "/d" not in page.evaluate("Object.keys(window.counts)")
    page.locator("[data-skin='/d'] canvas.marks").scroll_into_view_if_needed()
    page.wait_for_function("() => window.counts['/d'] > 50")
    page.evaluate("window.counts = {}")
    page.wait_for_function("() => window.counts['/d'] > 50")
    assert "/a" not in page.evaluate("Object.keys(window.counts)")
    # What it feels is told all the same.
    expect(page.locator("[data-skin='/a'] [data-number=peak]")).to_have_text("800")
