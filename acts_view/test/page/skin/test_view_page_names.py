# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Names and long words on the page, in a real browser: a skin in the root namespace, long names, what nodes say."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.skin.snapshot import Frame

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

LONG = "/laboratory_of_robotics/robot_with_many_skins/left_upper_arm_inner_side"


def test_a_skin_in_the_root_namespace_is_called_by_its_slash(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(("",)))
    expect(page.get_by_role("heading", name="/", exact=True)).to_be_visible()
    expect(page.get_by_label("tactile image of /;")).to_be_visible()


def test_a_skin_in_the_root_namespace_that_is_waited_for_is_named(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play(())
    player.status = {"skins": [""]}
    page = open_page(player, is_live=False)
    expect(page.locator("#empty")).to_contain_text("Nothing has come from / yet.")


@pytest.mark.parametrize("width", [360, 1280])
def test_a_long_name_stays_in_the_card_of_its_skin(
    play: Callable[..., Player], open_page: Callable[..., Page], width: int
) -> None:
    page = open_page(play((LONG, "/x")), width, 800)
    expect(page.locator(".skin .pill[data-state=live]")).to_have_count(2)
    assert page.evaluate("document.documentElement.scrollWidth") == width
    is_inside = page.evaluate(
        """() => {
          const title = document.querySelector(".skin h2"), words = document.createRange();
          words.selectNodeContents(title);
          return words.getBoundingClientRect().right <= title.closest(".skin").getBoundingClientRect().right;
        }"""
    )
    assert is_inside


def test_what_nodes_say_in_long_words_makes_a_phone_s_page_no_wider(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    path = "/dev/serial/by-id/usb-Teensyduino_USB_Serial_12345678-if00"

    def change(frame: Frame) -> Frame:
        hand = {**frame.hand, "reason": path, "events": [[path, 1]], "joints": [["x" * 60, 0.5]]}
        return replace(frame, hand=hand, ball={**frame.ball, "segment": path, "reason": path})

    player = play(change=change)
    node = {"name": "plate/driver", "level": 2, "message": path, "age_s": 0.0, "values": [["x" * 60, path]]}
    player.status = {"diagnostics": [node], "note": path}
    page = open_page(player, 360, 800)
    expect(page.locator("#note")).to_have_text(path)
    page.click("#diagnostics summary")
    expect(page.locator("#diagnostics dd")).to_have_text(path)
    expect(page.locator(".regions .joints dt")).to_have_text("x" * 60)
    assert page.evaluate("document.documentElement.scrollWidth") == 360
    lines = """() => {
      const angle = document.createRange();
      angle.selectNodeContents(document.querySelector(".regions .joints dd"));
      return angle.getClientRects().length;
    }"""
    assert page.evaluate(lines) == 1


def test_the_dot_beside_a_long_state_stays_round(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play(), 360, 800)
    # As long as the state of a page that the server refuses.
    page.evaluate(
        """() => {
          const state = document.querySelector("#connection");
          state.dataset.state = "refused";
          state.textContent = "the server refuses this page: does the address have its token, or are 32 pages open?";
        }"""
    )
    dot = page.locator("#connection").evaluate(
        """(state) => {
          const { width, height } = getComputedStyle(state, "::before");
          return [parseFloat(width), parseFloat(height)];
        }"""
    )
    assert dot[0] == dot[1] > 0
