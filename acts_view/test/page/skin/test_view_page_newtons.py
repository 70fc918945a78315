# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A skin in newtons on the page, in a real browser, whose measured response says 0 N up to many counts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from view_browser import expect, needs_browser
from view_player import COL, ROW, Player

from acts_view.skin.snapshot import Frame, SkinShape

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

COLOUR_OF = """([row, col]) => {
  const canvas = document.querySelector("canvas.taxels"), side = canvas.width / 32;
  return [...canvas.getContext("2d").getImageData((col + 0.5) * side, (row + 0.5) * side, 1, 1).data];
}"""


def test_an_untouched_skin_of_which_few_counts_are_no_force_has_the_lowest_colour(
    play: Callable[..., Player], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    """By an adaptive scale it was black, and its legend said that it ends at 0 N."""
    response = tmp_path / "response.csv"
    response.write_text("newtons,counts\n0,150\n1,900\n")

    def unpressed(frame: Frame) -> Frame:
        return replace(frame, image=np.full((32, 32), 40, np.uint16))

    page = open_page(play(shape=SkinShape(force_response=str(response)), change=unpressed))
    page.select_option("#unit", "newtons")
    page.select_option("#scale", "adaptive")
    expect(page.locator(".legend .unit")).to_have_text("N")
    # As of the fixed scale, which ends at 768 counts: 1 N * (768 - 150) / (900 - 150).
    expect(page.locator(".top")).to_have_text("0.82")
    assert page.evaluate(COLOUR_OF, [ROW, COL]) == [0x44, 0x01, 0x54, 0xFF]
