# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A skin that says nothing beside a controller that goes on, in a real browser."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player, next_picture

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]


def opacity_of_taxels(page: Page) -> int:
    """How opaque the corner of the picture is, of 255."""
    return int(
        page.evaluate(
            """() => {
              const context = new OffscreenCanvas(8, 8).getContext("2d", { willReadFrequently: true });
              context.drawImage(document.querySelector("canvas.taxels"), 0, 0);
              return context.getImageData(6, 6, 1, 1).data[3];
            }"""
        )
    )


def test_a_skin_that_stops_is_silent_though_its_controller_goes_on(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    page = open_page(player)
    player.is_silent = True
    # With each picture of the screen: it says so for a second, and an expectation looks no more often than that.
    page.wait_for_function("() => document.querySelector('.skin .pill').textContent === 'silent for 3 s'")
    # What it showed last is not what is there now; what the controller says is.
    expect(page.locator(".canvases")).to_have_css("opacity", "0.6")
    expect(page.locator(".facts")).to_have_css("opacity", "0.6")
    expect(page.locator(".patches")).to_have_css("opacity", "0.6")
    expect(page.locator("[data-ball=ball]")).to_have_css("opacity", "0.6")
    expect(page.locator(".ball")).to_have_css("opacity", "1")
    expect(page.locator("[data-ball=tilt]")).to_have_css("opacity", "1")
    # A page that is opened then knows since when.
    later = open_page(player, is_live=False)
    later.wait_for_selector(".skin .pill[data-state=silent]")
    told = re.fullmatch(r"silent for (\d+) s", later.inner_text(".skin .pill"))
    assert told is not None
    assert int(told[1]) >= 3
    player.is_silent = False
    expect(page.locator(".skin .pill")).to_have_text("live")
    expect(page.locator(".canvases")).to_have_css("opacity", "1")


def test_a_skin_that_nothing_came_of_is_not_shown_as_untouched(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play(is_silent=True)
    page = open_page(player, is_live=False)
    expect(page.locator(".ball .state")).to_contain_text("balancing")
    expect(page.locator(".skin .pill")).to_have_text("waiting")
    assert [page.inner_text(f"[data-number={name}]") for name in ("force", "peak", "area", "lost")] == ["–"] * 4
    assert opacity_of_taxels(page) < 64
    player.is_silent = False
    expect(page.locator(".skin .pill")).to_have_text("live")
    expect(page.locator("[data-number=force]")).to_have_text("1.25")
    next_picture(page)
    assert opacity_of_taxels(page) == 255


def test_a_skin_of_which_nobody_tells_contacts_is_not_shown_as_untouched(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(change=lambda frame: replace(frame, touch=None, is_touch_known=False)))
    expect(page.locator("[data-number=rate]")).not_to_have_text("–")
    assert opacity_of_taxels(page) == 255
    assert [page.inner_text(f"[data-number={name}]") for name in ("force", "peak", "area", "lost")] == ["–"] * 4
