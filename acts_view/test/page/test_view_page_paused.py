# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A paused page in a real browser: it stays as it is, and answers to its controls."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from view_browser import expect, needs_browser
from view_player import COL, ROW, Player, pressed, saved_table

from acts_view.skin.snapshot import Frame, Sample, SkinShape

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

PITCH_M = 0.004375


@pytest.fixture
def player(play: Callable[..., Player]) -> Player:
    """Shows nothing of itself, only what a test shows."""
    player = play(())
    player.server.show_shape("/plate", SkinShape())
    return player


def shown(player: Player, counts: int = 800, col: int = COL, samples: list[Sample] | None = None) -> Frame:
    """Show a press at a taxel of the row of all presses."""
    _, frame, usual = pressed("/plate", time.time())
    assert frame.image is not None
    image = np.zeros_like(frame.image)
    image[ROW, col] = counts
    contacts = frame.contacts.copy()
    contacts[0, 0] = (col - 15.5) * PITCH_M
    frame = replace(
        frame, image=image, contacts=contacts, touch=(float(contacts[0, 0]), 0.0, 1.25, float(counts), 1e-5)
    )
    player.server.show_frame("/plate", frame, usual if samples is None else samples)
    return frame


def opened(player: Player, open_page: Callable[..., Page]) -> Page:
    """A page that has got what was shown; on a busy machine that is silent again by then."""
    page = open_page(player, is_live=False)
    page.wait_for_selector(".skin .pill:not([data-state=waiting])")
    return page


def test_the_taxel_pointed_at_is_told_in_the_unit_that_is_chosen(
    player: Player, open_page: Callable[..., Page]
) -> None:
    shown(player)
    page = opened(player, open_page)
    page.keyboard.press(" ")
    page.focus("canvas.marks")
    page.keyboard.press("ArrowUp")
    expect(page.locator(".pointed")).to_contain_text("· 0 counts ·")
    page.keyboard.press("n")
    expect(page.locator(".pointed")).to_contain_text("0.000 N (0 counts)")


def test_an_adaptive_scale_does_not_go_on_falling(player: Player, open_page: Callable[..., Page]) -> None:
    shown(player, 1000)
    page = opened(player, open_page)
    top = page.locator(".legend .top")
    page.keyboard.press("s")
    expect(top).to_have_text("1000")
    shown(player, 300)
    expect(top).to_have_text("970")
    page.keyboard.press(" ")
    expect(page.locator(".skin .pill")).to_have_text("paused")
    # What these choose is drawn with each, and then is as before.
    for keys in ("ii", "mmm", "cc", "ss", "nn"):
        for key in keys:
            page.keyboard.press(key)
        expect(page.locator(".legend .unit")).to_have_text("counts")
        assert top.inner_text() == "970", keys


def test_a_trail_stays(player: Player, open_page: Callable[..., Page]) -> None:
    shown(player, col=10)
    page = opened(player, open_page)
    x = page.locator("[data-number=x]")
    opacity = """() => {
      const canvas = document.querySelector("canvas.marks"), side = canvas.width / 32;
      const copy = new OffscreenCanvas(1, 1).getContext("2d");
      copy.drawImage(canvas, Math.round(13 * side), Math.round(8.5 * side), 1, 1, 0, 0, 1, 1);
      return copy.getImageData(0, 0, 1, 1).data[3];
    }"""
    before = 0
    # Again where this machine took longer for the way than a trail stays.
    for _ in range(10):
        for col in (10, 15):
            shown(player, col=col)
            expect(x).to_have_text(f"{1000 * (col - 15.5) * PITCH_M:.1f}")
        page.keyboard.press(" ")
        paused_ms = page.evaluate("performance.now()")
        before = page.evaluate(opacity)
        if before > 0:
            break
        page.keyboard.press(" ")
    assert before > 0
    # Longer than a trail is.
    page.wait_for_function("(from_ms) => performance.now() - from_ms > 1300", arg=paused_ms)
    page.keyboard.press("m")
    assert page.evaluate(opacity) == before


def test_a_shorter_window_shows_what_is_in_it_after_a_zoom_on_what_is_not(
    player: Player, open_page: Callable[..., Page], tmp_path: Path
) -> None:
    begin_s = time.time() - 20.0
    shown(player, samples=[Sample(begin_s + 0.008 * number, 1.25, 0.4, 0) for number in range(2500)])
    page = opened(player, open_page)
    page.select_option("#window", "30")
    page.keyboard.press(" ")
    # The six seconds in the middle of the thirty.
    for key in "++<<":
        page.keyboard.press(key)
    drawn = """() => {
      const canvas = document.querySelector("[data-plot=force] canvas");
      const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
      copy.drawImage(canvas, 0, 0);
      const data = copy.getImageData(0, 0, canvas.width, canvas.height).data;
      let count = 0;
      // The colour of the line, 0c6b6b.
      for (let at = 0; at < data.length; at += 4) {
        count += data[at] < 40 && Math.abs(data[at + 1] - 107) < 20 && data[at + 3] > 200;
      }
      return count;
    }"""
    page.wait_for_function(f"() => ({drawn})() > 20")
    page.select_option("#window", "5")
    page.wait_for_function(f"() => ({drawn})() > 20")
    times_s = [float(row["time_s"]) for row in saved_table(page, "plots", tmp_path)]
    assert times_s[-1] - times_s[0] == pytest.approx(5.0, abs=0.02)
    assert times_s[-1] == pytest.approx(begin_s + 20.0, abs=0.05)
    expect(page.locator(".skin .pill")).to_have_text("paused")


def test_a_skin_that_becomes_another_one_does_so_when_the_page_goes_on(
    player: Player, open_page: Callable[..., Page], tmp_path: Path
) -> None:
    shown(player)
    page = opened(player, open_page)
    page.keyboard.press(" ")
    expect(page.locator(".skin .pill")).to_have_text("paused")
    before = saved_table(page, "taxels", tmp_path)
    player.server.show_shape("/plate", SkinShape(rows=16, cols=16))
    # Told after it, so that it has come.
    player.server.show_shape("/plate_2", SkinShape())
    expect(page.locator(".skin")).to_have_count(2)
    expect(page.locator("[data-skin='/plate'] .shape")).to_contain_text("32 × 32 taxels")
    assert saved_table(page, "taxels", tmp_path) == before
    page.locator("canvas.marks").first.focus()  # the space bar is for what has the focus
    page.keyboard.press(" ")
    expect(page.locator("[data-skin='/plate'] .shape")).to_contain_text("16 × 16 taxels")


def test_what_came_last_in_a_pause_is_shown_when_the_page_goes_on_though_nothing_follows(
    player: Player, open_page: Callable[..., Page], tmp_path: Path
) -> None:
    shown(player, 800)
    page = opened(player, open_page)
    page.focus("canvas.marks")
    page.keyboard.press(" ")
    expect(page.locator(".skin .pill")).to_have_text("paused")
    shown(player, 500)
    shown(player, 300, col=5)
    # Told after it, so that it has come.
    player.server.show_shape("/plate_2", SkinShape())
    expect(page.locator(".skin")).to_have_count(2)
    plate = page.locator("[data-skin='/plate']")
    assert plate.locator("[data-number=peak]").inner_text() == "800"
    page.keyboard.press(" ")
    expect(plate.locator("[data-number=peak]")).to_have_text("300")
    (pressed_at,) = (row for row in saved_table(page, "taxels", tmp_path) if row["counts"] != "0")
    assert (pressed_at["row"], pressed_at["col"], pressed_at["counts"]) == (str(ROW), "5", "300")


def test_the_joints_of_a_hand_stay_in_a_zoom_long_after_the_pause_began(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play())
    joints = page.locator(".joints dt")
    expect(joints).to_have_text(["index mcp", "thumb tip"])
    page.keyboard.press(" ")
    paused_ms = page.evaluate("performance.now()")
    # Longer than they stay where nobody publishes them any more.
    page.wait_for_function("(from_ms) => performance.now() - from_ms > 2100", arg=paused_ms)
    page.keyboard.press("+")
    expect(page.locator("#pause")).to_have_text("Go on")
    expect(joints).to_have_text(["index mcp", "thumb tip"])
