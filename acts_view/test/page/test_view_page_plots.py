# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Plots of the page in a real browser: a part of them is chosen by mouse and by keys, and a slow skin has some."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player, pressed, saved_table

from acts_view.skin.snapshot import Sample, SkinShape

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

pytestmark = [needs_browser, pytest.mark.slow]


# Whether a plot has a dot for each second of five; the first and the last may be at the edge.
HAS_DOTS = """(plot) => {
  const drawn = document.querySelector(`[data-plot=${plot}] canvas`), { width, height } = drawn;
  const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(drawn, 0, 0);
  const { data } = copy.getImageData(0, 0, width, height);
  const wanted = getComputedStyle(document.documentElement).getPropertyValue(`--plot-${plot}`).trim();
  const [red, green, blue] = [1, 3, 5].map((at) => parseInt(wanted.slice(at, at + 2), 16));
  const isLine = (at) => data[at] === red && data[at + 1] === green && data[at + 2] === blue && data[at + 3] === 255;
  const isDrawn = Array.from({ length: width }, (_, x) => {
    for (let at = 4 * x; at < data.length; at += 4 * width) if (isLine(at)) return true;
    return false;
  });
  const dots = isDrawn.filter((drawn, x) => drawn && !isDrawn[x - 1]).length;
  return dots >= 4 && dots <= 6;
}"""

# Keeps the plots that are made, and tells of the first, of force, how many points are shown, from where to where.
KEEP = """
;window.made = [];
{
  const made = uPlot;
  uPlot = function (...given) { const one = new made(...given); window.made.push(one); return one; };
  Object.assign(uPlot, made);
}
"""
POINTS = """() => {
  const [{ data: [times], scales: { x: { min, max } } }] = window.made;
  const shown = times.filter((time) => time >= min && time <= max);
  return [shown.length, min - shown[0], shown[shown.length - 1] - max, times[0] <= min];
}"""


def test_a_pause_holds_and_a_part_of_a_plot_can_be_seen_alone(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play())
    expect(page.locator("[data-number=rate]")).to_have_text("1000")
    plot = page.locator("[data-plot=force] .u-over")
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 0.8 * box["width"], box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.9 * box["width"], box["y"] + 20, steps=4)
    page.mouse.up()
    page.wait_for_selector(".skin .pill[data-state=held]")
    assert page.inner_text("#pause") == "Go on"
    page.click("#pause")
    page.wait_for_selector(".skin .pill[data-state=live]")


def show_a_minute(player: Player) -> None:
    """Show a skin of which contacts of almost a minute are known, at 250 Hz."""
    player.server.show_shape("/plate", SkinShape())
    now_s = time.time()
    name, frame, _ = pressed("/plate", now_s)
    samples = [Sample(now_s - 58 + 0.004 * number, 0.5, 0.5, 0) for number in range(14_500)]
    player.server.show_frame(name, frame, samples)


def drag(page: Page, plot: Locator, points: Sequence[tuple[float, float]]) -> None:
    """Drag a finger over places of a plot, each in shares of its width and height."""
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    assert box is not None
    places = [{"x": box["x"] + x * box["width"], "y": box["y"] + y * box["height"]} for x, y in points]
    session = page.context.new_cdp_session(page)
    kinds = ["touchStart", *["touchMove"] * (len(places) - 1)]
    for kind, place in zip(kinds, places, strict=True):
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [place]})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


def test_a_finger_chooses_a_part_of_a_plot_and_two_taps_show_all(
    play: Callable[..., Player], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    player = play(())
    show_a_minute(player)
    page = open_page(player, 360, 740, is_live=False, has_touch=True, is_mobile=True)
    expect(page.locator("[data-number=rate]")).to_have_text("250")
    page.evaluate("document.querySelector('[data-plot=force] .u-over').scrollIntoView({ block: 'center' })")
    plot = page.locator("[data-plot=force] .u-over")
    drag(page, plot, [(0.6, 0.5), (0.65, 0.5), (0.75, 0.5), (0.9, 0.5)])
    page.wait_for_selector(".skin .pill[data-state=held]")
    few = len(saved_table(page, "plots", tmp_path))
    for _ in range(2):
        plot.tap()
    assert len(saved_table(page, "plots", tmp_path)) > 2 * few


def test_a_finger_that_scrolls_the_page_chooses_nothing(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play(), 360, 740, has_touch=True, is_mobile=True)
    expect(page.locator("[data-number=rate]")).to_have_text("1000")
    page.evaluate("document.querySelector('[data-plot=force] .u-over').scrollIntoView({ block: 'center' })")
    before = page.evaluate("window.scrollY")
    drag(page, page.locator("[data-plot=force] .u-over"), [(0.5, 0.9), (0.55, 0.5), (0.6, -0.5), (0.7, -1.5)])
    page.wait_for_function(f"window.scrollY > {before}")
    expect(page.locator(".skin .pill")).to_have_attribute("data-state", "live")


def test_keys_zoom_the_plots_and_move_the_part(
    play: Callable[..., Player], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    player = play()
    page = open_page(player)
    # More than the part that is seen below, and one before it.
    player.wait_for_history(1.0)
    expect(page.locator("[data-number=rate]")).to_have_text("1000")
    page.select_option("#window", "10")
    rows = []
    for keys in ("+++++", "+", "<", ">", "-", "0"):  # ten seconds, five times halved
        for key in keys:
            page.keyboard.press(key)
        rows.append([float(row["time_s"]) for row in saved_table(page, "plots", tmp_path)])
    part, half, before, half_again, part_again, whole = rows
    page.wait_for_selector(".skin .pill[data-state=held]")
    assert 0.2 < part[-1] - part[0] < 0.32
    assert set(half) < set(part) < set(whole)
    assert before[0] < half[0] < before[-1] < half[-1]
    assert half_again == pytest.approx(half, abs=0.009)
    assert part_again == pytest.approx(part, abs=0.009)


def test_a_skin_that_is_slow_has_plots_and_a_rate(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    player = play(())
    player.server.show_shape("/plate", SkinShape())
    now_s = time.time()
    name, frame, _ = pressed("/plate", now_s)
    player.server.show_frame(name, frame, [Sample(now_s - 20 + number, 0.5, 0.5, 0) for number in range(21)])
    page = open_page(player, is_live=False)
    expect(page.locator("[data-number=rate]")).to_have_text("1.0")
    for plot in ("force", "latency"):
        page.wait_for_function(HAS_DOTS, arg=plot)


def test_a_part_of_a_plot_shows_all_that_is_known_of_it(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play(())
    show_a_minute(player)
    page = open_page(player, is_live=False)
    page.route(
        "**/uPlot.iife.min.js",
        lambda route: route.fulfill(body=route.fetch().text() + KEEP, content_type="text/javascript"),
    )
    page.reload()
    expect(page.locator("[data-number=rate]")).to_have_text("250")
    page.select_option("#window", "60")
    # Of more than a pixel each 8 ms.
    for keys, intervals in (("+++++", 1.875 / 0.008), ("<<<<", 1.875 / 0.008), ("++++", 0.117 / 0.008)):
        for key in keys:
            page.keyboard.press(key)
        page.wait_for_function(f"(least) => ({POINTS})()[0] >= least", arg=0.95 * intervals - 1)
        points, after_s, before_s, is_at_edge = page.evaluate(POINTS)
        assert points <= intervals + 1
        assert -0.016 < after_s <= 0
        assert -0.016 < before_s <= 0
        assert is_at_edge


# Of plots of their own, ten seconds of which are drawn; then 0.4 s more come, and from 4 to 3 s before the newest
# that is drawn are chosen with the mouse. From when to when is shown, counted from what was the newest then.
CHOOSE = """async () => {
  const [{ History }, { Plots }] = await Promise.all([import("/skin/history.js"), import("/skin/plots.js")]);
  const element = document.body.appendChild(document.createElement("div"));
  const history = new History();
  const plots = new Plots(element, history, () => plots.hold(true));
  const begin_s = 1.7e9;
  let count = 0;
  const take = (intervals) => {
    const time_s = (at) => 0.008 * (count + at / 7);
    const data = Float32Array.from({ length: 7 * intervals }, (_, at) => (at % 7 ? 1 : time_s(at)));
    history.take({ life: 0, base_s: begin_s, arrays: { history: { data } } });
    count += intervals;
  };
  take(1250);
  plots.draw(true);
  await new Promise(requestAnimationFrame);
  const newest_s = history.newest_s;
  take(50);
  const { plot } = plots.plots[0];
  const [left, right] = [-4, -3].map((time_s) => plot.valToPos(time_s, "x"));
  plot.setSelect({ left, width: right - left, top: 0, height: 10 });
  const times = plots.shown().map(([time_s]) => time_s - newest_s);
  plots.destroy();
  element.remove();
  return [times[0], times[times.length - 1]];
}"""


def test_the_part_that_is_shown_is_the_one_that_was_seen_and_chosen(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    """What had come since the plot was drawn moved the part: by up to a tenth of a second, more than a short peak."""
    page = open_page(play())
    first_s, last_s = page.evaluate(CHOOSE)
    assert first_s == pytest.approx(-4.0, abs=0.009)
    assert last_s == pytest.approx(-3.0, abs=0.009)
