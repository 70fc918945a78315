# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page in a real browser, fed by the server without ROS: what a person sees and can do."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from view_browser import expect, needs_browser

from acts_view.skin.snapshot import Frame, RegionState, Sample, SkinShape
from acts_view.web.server import ViewServer

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

ROW, COL = 8, 20
PERIOD_S = 1 / 30


def pressed(name: str, time_s: float) -> tuple[str, Frame, list[Sample]]:
    """A skin that is pressed at one place; 1 kHz for the time between two frames."""
    image = np.zeros((32, 32), np.uint16)
    image[ROW, COL] = 800
    confidence = np.full((32, 32), 255, np.uint8)
    x_m, y_m = (COL - 15.5) * 0.004375, (15.5 - ROW) * 0.004375
    contacts = np.array([[x_m, y_m, 1.25, 800, 1.9e-5, 0.001, 0.125, 1.0]], np.float32)
    frame = Frame(
        stamp_s=time_s,
        image=image,
        confidence=confidence,
        contact_numbers=np.array([42], np.uint32),
        contacts=contacts,
        touch=(x_m, y_m, 1.25, 800.0, 1.9e-5),
        regions=[RegionState("palm", 2.5, 0.0, False), RegionState("index_distal", 0.75, 0.0032, True)],
        hand={
            "state": "holding",
            "reason": "something is gripped",
            "active": ["slip"],
            "events": [["slip", 3], ["sharp", 0]],
            "joints": [["index_mcp", 0.7854], ["thumb_tip", -0.1745]],
        },
        ball={
            "ball": [x_m, y_m],
            "reference": [x_m + 0.003, y_m + 0.004],
            "segment": "B",
            "state": "balancing",
            "reason": "a ball and a reference",
            "tilt_measured": [0.075, 0.0],
            "tilt_commanded": [0.0, -0.15],
        },
    )
    count = round(PERIOD_S * 1000)
    return name, frame, [Sample(time_s + 0.001 * number, 1.25, 0.4, 0) for number in range(count)]


class Player:
    """A server that a thread feeds as the node does."""

    def __init__(self, names: tuple[str, ...] = ("/plate",), shape: SkinShape | None = None, port: int = 0) -> None:
        self.server = ViewServer("127.0.0.1", port, on_clients=lambda _: None, log=lambda *_: None)
        self.url = self.server.address.url
        for name in names:
            self.server.show_shape(name, shape or SkinShape())
        self._names = names
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._play, daemon=True)
        self._thread.start()

    def _play(self) -> None:
        number = 0
        node = {"name": "plate/driver", "level": 1, "message": "no board", "age_s": 0.1, "values": [["port", "auto"]]}
        begin_s = time.time()
        while not self._stopped.wait(PERIOD_S):
            for name in self._names:
                self.server.show_frame(*pressed(name, begin_s + number * 0.033))
            if number % 30 == 0:
                self.server.show_status({"skins": list(self._names), "diagnostics": [node]})
            number += 1

    def close(self) -> None:
        if not self._stopped.is_set():
            self._stopped.set()
            self._thread.join()
            self.server.close()


@pytest.fixture
def play() -> Iterator[Callable[..., Player]]:
    players: list[Player] = []

    def begin(*arguments: Any, **options: Any) -> Player:
        players.append(Player(*arguments, **options))
        return players[-1]

    yield begin
    for player in players:
        player.close()


def taxel_colours(page: Page) -> np.ndarray:
    """Red, green and blue in the middle of every taxel of a square skin, as they are on the page."""
    pixels = page.evaluate(
        """() => {
          const canvas = document.querySelector("canvas.taxels"), side = canvas.width / 32, colours = [];
          const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
          for (let row = 0; row < 32; row += 1) for (let col = 0; col < 32; col += 1) {
            const at = 4 * (Math.floor((row + 0.5) * side) * canvas.width + Math.floor((col + 0.5) * side));
            colours.push([...data.subarray(at, at + 3)]);
          }
          return colours;
        }"""
    )
    return np.array(pixels).reshape(32, 32, 3)


def test_a_press_is_where_it_is_with_its_numbers(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    colours = taxel_colours(page).astype(int)
    elsewhere = np.ones((32, 32), bool)
    elsewhere[ROW, COL] = False
    assert (colours[elsewhere] == [0x44, 0x01, 0x54]).all()
    # 800 of 1023 counts, in viridis.
    np.testing.assert_allclose(colours[ROW, COL], [113, 206, 86], atol=4)
    expect(page.locator("[data-number=rate]")).to_have_text("1000")
    numbers = {name: page.inner_text(f"[data-number={name}]") for name in ("force", "x", "y", "peak", "area", "lost")}
    assert numbers == {"force": "1.25", "x": "19.7", "y": "32.8", "peak": "800", "area": "19", "lost": "0"}
    assert page.locator(".contacts tbody tr").first.inner_text().split() == ["42", "1.25", "800", "19", "125"]
    assert "plate/driver" in page.inner_text("#diagnostics")
    assert "Warning" in page.inner_text("#diagnostics")
    assert "Is the board plugged in and powered?" in page.inner_text("#diagnostics .advice")
    marks = page.evaluate(
        "() => { const c = document.querySelector('canvas.marks');"
        " return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some((byte) => byte) }"
    )
    assert marks


def test_a_taxel_tells_its_value_to_mouse_and_keyboard(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play())
    box = page.locator("canvas.marks").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + (COL + 0.5) * box["width"] / 32, box["y"] + (ROW + 0.5) * box["height"] / 32)
    pointed = page.locator(".pointed")
    assert pointed.inner_text() == f"row {ROW}, column {COL} · 800 counts · ± 0 counts (100 % sure)"
    page.focus("canvas.marks")
    page.keyboard.press("ArrowDown")
    assert pointed.inner_text().startswith(f"row {ROW + 1}, column {COL} · 0 counts")
    page.keyboard.press("Escape")
    assert pointed.inner_text() == ""


def test_a_ball_its_reference_and_the_tilt_of_the_plate(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    page = open_page(play())
    page.wait_for_selector(".ball h3")
    assert page.inner_text(".ball h3") == "Ball balancing · segment B"
    shown = {name: page.inner_text(f"[data-ball={name}]") for name in ("ball", "reference", "off", "tilt")}
    assert shown == {"ball": "19.7, 32.8", "reference": "22.7, 36.8", "off": "5.0", "tilt": "4.30, 0.00"}
    # About x the plate goes down along -y, which is down on the page; about y, to the left.
    dots = {
        name: [page.get_attribute(f".level .{name}", one) for one in ("cx", "cy")] for name in ("measured", "commanded")
    }
    assert dots == {"measured": ["0.000", "0.500"], "commanded": ["-1.000", "0.000"]}


def test_the_image_is_shown_in_newtons(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    page.keyboard.press("n")
    expect(page.locator(".legend .unit")).to_have_text("N")
    # 768 of 1023 counts by the default response: 0.005 N + 0.3 N * 768 / 255.
    expect(page.locator(".top")).to_have_text("0.91")
    page.focus("canvas.marks")
    for _ in range(2):
        page.keyboard.press("ArrowUp")
    expect(page.locator(".pointed")).to_contain_text("0.000 N (0 counts)")
    # 800 counts are 1.08 N, more than the top of the fixed scale; the adaptive one goes up to it.
    np.testing.assert_allclose(taxel_colours(page)[ROW, COL], [0xFD, 0xE7, 0x25], atol=2)
    page.select_option("#scale", "adaptive")
    expect(page.locator(".top")).to_have_text("1.08")
    page.select_option("#unit", "counts")
    expect(page.locator(".top")).to_have_text("800")


def test_choices_act_and_survive_a_reload(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play())
    page.keyboard.press("s")
    expect(page.locator(".top")).to_have_text("800")
    # The largest value is the top of the scale: viridis ends in yellow.
    np.testing.assert_allclose(taxel_colours(page)[ROW, COL], [0xFD, 0xE7, 0x25], atol=2)
    page.select_option("#colours", "cividis")
    page.click("#theme")
    page.click("#smooth")
    page.reload()
    page.wait_for_selector(".skin .pill[data-state=live]")
    chosen = [page.input_value(name) for name in ("#scale", "#colours")]
    assert chosen == ["adaptive", "cividis"]
    assert page.get_attribute("#smooth", "aria-pressed") == "true"
    assert page.get_attribute("html", "data-theme") == "light"
    assert tuple(taxel_colours(page)[31, 0]) == (0x00, 0x22, 0x4E)


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


def test_a_server_that_is_gone_and_back(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    first = play()
    page = open_page(first)
    first.close()
    page.wait_for_selector("#connection[data-state=gone]")
    play(port=first.server.address.port)
    page.wait_for_selector("#connection[data-state=live]")
    page.wait_for_selector(".skin .pill[data-state=live]")
    expect(page.locator("[data-number=rate]")).to_have_text("1000")


def test_a_hand_has_its_own_shape_and_its_regions(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play(("/hand",), SkinShape(layout="leap_right")))
    page.wait_for_selector(".regions li")
    assert page.locator(".regions h3").first.inner_text() == "Hand holding · slip"
    assert page.inner_text(".regions .joints").split("\n") == ["index mcp", "45", "thumb tip", "-10"]
    assert page.inner_text(".regions .note") == "Reflexes so far: slip 3 ×"
    slipping = page.locator(".regions li[data-slipping=true]")
    assert slipping.inner_text().split("\n") == ["index distal", "0.75 N", "slips 3.2 mm"]
    assert "13 patches" in page.inner_text(".shape")
    # Between the patches there is no skin.
    corner = page.evaluate(
        "() => { const c = document.querySelector('canvas.taxels');"
        " return [...c.getContext('2d').getImageData(c.width - 3, 2, 1, 1).data] }"
    )
    assert corner == [0, 0, 0, 0]


@pytest.mark.parametrize("width", [360, 768])
def test_a_small_window_shows_all_without_scrolling_sideways(
    play: Callable[..., Player], open_page: Callable[..., Page], width: int
) -> None:
    page = open_page(play(("/left", "/right")), width, 800, color_scheme="dark")
    expect(page.locator(".skin .pill[data-state=live]")).to_have_count(2)
    assert page.evaluate("document.documentElement.scrollWidth") == width
    box = page.locator("canvas.taxels").first.bounding_box()
    assert box is not None
    assert box["width"] > 0.5 * min(width, 600)
    assert box["width"] == pytest.approx(box["height"], abs=1)
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(16, 20, 21)"
