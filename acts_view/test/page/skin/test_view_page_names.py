# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What skins are called on the page, in a real browser: the one in the root namespace, and those with long names."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player

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
