# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What nodes can be asked for on the page, in a real browser: what is no value is refused beside its field."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.web.server import READ_ONLY

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]


@pytest.mark.parametrize(
    ("name", "given", "words"),
    [
        ("m", "", "not set: needed is a whole number from 0 on"),
        ("m", "-1", "not set: needed is a whole number from 0 on"),
        ("m", "2.5", "not set: needed is a whole number from 0 on"),
        ("threshold_counts", "", "not set: needed is a whole number from -1 on"),
        ("threshold_counts", "-2", "not set: needed is a whole number from -1 on"),
    ],
)
def test_a_number_that_is_none_is_refused_beside_its_field(
    name: str, given: str, words: str, play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    player.status |= {"offers": [["set", "/plate"]], "settings": {"/plate": {"m": 55, "threshold_counts": 40}}}
    page = open_page(player)
    field, refused = page.locator(f"#controls [data-name={name}]"), page.locator(f"#controls [data-refused={name}]")
    answer = page.locator("#controls > .answer")
    expect(field).not_to_have_value("")
    expect(refused).to_be_hidden()
    field.fill(given)
    field.blur()
    expect(refused).to_have_text(words)
    assert answer.inner_text() == ""
    box, below = refused.bounding_box(), field.bounding_box()
    assert box is not None
    assert below is not None
    assert abs(box["y"] - below["y"]) < 2 * below["height"]
    # What is asked for then reaches the server, which answers.
    field.fill("60")
    field.blur()
    expect(refused).to_be_hidden()
    expect(answer).to_contain_text(READ_ONLY)
