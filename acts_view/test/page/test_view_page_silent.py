# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the page says of a skin that is silent, of none at all, and of a node that complains, in a real browser."""

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


def test_without_a_skin_it_tells_how_to_start_one(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play(()), is_live=False)
    expect(page.locator("#empty")).to_contain_text("acts launch acts_bringup tactile.launch.xml")


def test_of_a_skin_that_is_waited_for_it_asks_for_its_name_and_nodes(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play(())
    player.status = {"skins": ["/foot"]}
    page = open_page(player, is_live=False)
    empty = page.locator("#empty")
    expect(empty).to_contain_text("Nothing has come from /foot yet. Is the name right")
    # There may be other skins.
    assert "Nobody publishes touch" not in empty.inner_text()


@pytest.mark.parametrize(
    ("message", "advice"),
    [
        # "late" is in the name of the topic only.
        ("no contact messages on /plate/contact", "Does the reconstruction of this skin run? Its own line says."),
        ("/plate/contact has 2 publishers (/acts_player, /plate/reconstruction): end all but one", "is a mixture"),
        (
            "the board measures 16 x 16 taxels, the parameters rows and cols say 32 x 32",
            "or acts view --board its --size",
        ),
        ("9 frames were late", "The machine is too busy"),
        ("7 cycles missed", "The machine is too busy"),
        ("the world stood still for 48 ms", "The machine is too busy"),
        ("stopped: connection to the robot lost", "Is the robot on, reachable and in remote control?"),
        ("stopped: the connection is lost: its process has ended", "Is the robot on, reachable"),
        ("motor index_mcp_side has lost its power", "Is the hand powered"),
        ("the robot has stopped writing its joints; the plate is at rest", "The simulated robot has ended"),
    ],
)
def test_what_to_do_follows_from_what_is_complained_of(
    message: str, advice: str, play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    player.status = {"diagnostics": [{"name": "a", "level": 1, "message": message, "age_s": 0.1, "values": []}]}
    page = open_page(player)
    expect(page.locator("#diagnostics .message")).to_have_text(message)
    expect(page.locator("#diagnostics .advice")).to_contain_text(advice)
