# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A recording on the page in a real browser: pause, seek, play."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from view_browser import expect, needs_browser
from view_player import Player, pressed, saved, saved_table
from view_recorded import Shown, write_bag, write_frames
from waiting import wait_for

from acts_core.errors import ViewRequestError
from acts_core.frames import SampleFrame, Scheme
from acts_view.local.sources import RecordedSource, open_recorded
from acts_view.skin.snapshot import SkinShape
from acts_view.web.requests import Request

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]


@pytest.fixture
def shown(tmp_path: Path) -> Iterator[Shown]:
    """A recording of 20 s that plays: 2 frames a second, 900 counts from the seventh on."""
    source, name = open_recorded(write_frames(tmp_path / "press.npz", 40), [], "square")
    made = Shown(source, name)
    yield made
    made.close()


def test_a_recording_is_held_and_one_can_go_anywhere_in_it(shown: Shown, open_page: Callable[..., Page]) -> None:
    page = open_page(shown)
    peak = page.locator("[data-number=peak]")
    bar = page.locator("#replay")
    button, slider, where = bar.locator("button"), bar.locator("input"), bar.locator("output")
    expect(bar.locator(".name")).to_have_text("press.npz")
    expect(page.locator("#note")).to_contain_text("nothing to record")
    expect(page.locator("#recording")).to_be_hidden()
    button.click()
    expect(button).to_have_text("Play")
    page.wait_for_selector(".skin .pill[data-state=held]")
    # 900 counts from the seventh frame on, at 2 Hz.
    slider.fill("10")
    expect(where).to_have_text("10.0 of 20.0 s")
    expect(peak).to_have_text(re.compile("^[89]..$"))
    slider.fill("0")
    expect(peak).to_have_text(re.compile("^[23]..$"))
    # The slider still has the focus.
    page.keyboard.press("s")
    expect(page.locator("#scale")).to_have_value("adaptive")
    page.keyboard.press(" ")
    expect(button).to_have_text("Hold")
    page.keyboard.press(" ")
    expect(button).to_have_text("Play")
    page.focus("canvas.marks")
    page.keyboard.press(" ")
    expect(button).to_have_text("Hold")
    page.wait_for_selector(".skin .pill[data-state=live]")


def test_a_slider_that_is_held_stays_where_it_is_while_the_recording_plays(
    shown: Shown, open_page: Callable[..., Page]
) -> None:
    page = open_page(shown)
    beside = open_page(shown)
    slider, where = page.locator("#replay input"), page.locator("#replay output")
    box = slider.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    expect(where).to_have_text(re.compile(r"^(9\.[5-9]|10\.[0-5]) of"))
    held_at = where.inner_text()
    expect(beside.locator("#replay output")).to_have_text(re.compile(r"^1[2-5]\.\d of"))
    assert where.inner_text() == held_at
    # Beside it.
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + 300)
    page.mouse.up()
    expect(where).to_have_text(re.compile(r"^1[2-9]\.\d of"))


def test_where_one_goes_in_a_pause_of_the_page_is_shown_when_it_goes_on(
    shown: Shown, open_page: Callable[..., Page]
) -> None:
    page = open_page(shown)
    beside = open_page(shown)
    page.click("#replay button")
    expect(page.locator("#replay button")).to_have_text("Play")
    page.locator("#replay input").fill("0")
    peak = page.locator("[data-number=peak]")
    expect(peak).to_have_text(re.compile("^[23]..$"))
    page.click("#pause")
    page.locator("#replay input").fill("10")
    # 900 counts from the seventh frame on, at 2 Hz; nothing more comes of what is held.
    expect(beside.locator("[data-number=peak]")).to_have_text(re.compile("^[89]..$"))
    expect(page.locator("#replay output")).to_have_text("10.0 of 20.0 s")
    expect(page.locator("#replay .answer")).to_have_text("this page is paused: Go on shows it")
    page.click("#pause")
    expect(page.locator("#replay .answer")).to_be_hidden()
    expect(peak).to_have_text(re.compile("^[89]..$"))


def test_what_is_saved_of_a_bag_has_the_time_of_its_stamps(tmp_path: Path, open_page: Callable[..., Page]) -> None:
    # A frame a second, from 10 s to 14 s.
    source, name = open_recorded(write_bag(tmp_path / "bag", {}), [], "square")
    shown = Shown(source, name)
    try:
        # It plays for four seconds, and may be over by then.
        page = open_page(shown, is_live=False)
        expect(page.locator("#replay button")).to_have_text("Play")
        expect(page.locator("[data-number=rate]")).to_have_text("1.0")
        page.select_option("#window", "10")
        times_s = [float(row["time_s"]) for row in saved_table(page, "plots", tmp_path)]
        # The interval of the last frame is not over; each is 8 ms long.
        assert times_s == pytest.approx([10.0, 11.0, 12.0, 13.0], abs=0.008)
        assert saved(page, "taxels", tmp_path).name == "plate_1970-01-01T00-00-14-000_taxels.csv"
    finally:
        shown.close()


def test_samples_of_a_file_have_the_time_of_its_stamps_where_it_has_some(tmp_path: Path) -> None:
    samples: dict[str, Any] = {"indices": np.tile(np.arange(3), (4, 1)), "counts": np.ones((4, 3), int)}
    stamp_ns = 1_700_000_000_000_000_000 + 1_000_000 * np.arange(4)
    np.savez(tmp_path / "stamped.npz", stamp_ns=stamp_ns, **samples)
    np.savez(tmp_path / "plain.npz", rate_hz=1000.0, **samples)
    stamps_s = {}
    began_s = time.time()
    for kind in ("stamped", "plain"):
        source, _ = open_recorded(tmp_path / f"{kind}.npz", [], "square")
        source._take(list(source.recording.frames()))
        taken = source.skin.newest()
        assert taken is not None
        stamps_s[kind] = taken[0].stamp_s
    assert stamps_s["stamped"] == pytest.approx(1_700_000_000.003, abs=1e-5)
    assert began_s <= stamps_s["plain"] <= time.time() + 0.003


class Resized:
    """Two seconds of frames at 100 Hz with a press, the second one of an array of another size."""

    length_us = 1_990_000

    def frames(self, from_us: int = 0) -> Iterator[SampleFrame]:
        for number in range(200):
            side = 32 if number < 100 else 16
            indices = np.arange(side**2, dtype=np.uint16)
            counts = np.full(side**2, 800, np.uint16)
            if 10_000 * number >= from_us:
                yield SampleFrame(number, 10_000 * number, 100, Scheme.RASTER, side, side, 0, indices, counts)


def test_where_the_size_of_the_array_changes_no_picture_of_before_is_shown(open_page: Callable[..., Page]) -> None:
    shown = Shown(RecordedSource("resized", Resized()), "/plate")
    try:
        page = open_page(shown, is_live=False)
        peak, pill, slider = (page.locator(one) for one in ("[data-number=peak]", ".skin .pill", "#replay input"))
        # It plays into the second half, and is held at its end.
        expect(page.locator("#replay button")).to_have_text("Play")
        expect(page.locator("#diagnostics")).to_contain_text("left out: frame of 16 x 16 taxels")
        for time_s, words, state in (("1.9", "–", "waiting"), ("0.5", "800", "paused"), ("1.2", "–", "waiting")):
            slider.fill(time_s)
            expect(peak).to_have_text(words)
            expect(pill).to_have_text(state)
    finally:
        shown.close()


def test_after_a_jump_no_trail_leads_from_the_contact_before(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    server = (player := play(())).server
    server.show_shape("/plate", SkinShape())
    page = open_page(player, is_live=False)

    def show_at(x_m: float) -> None:
        _, frame, samples = pressed("/plate", 1000.0 + x_m)
        frame.contacts[0, :2] = x_m, 0.0
        server.show_frame("/plate", replace(frame, touch=(x_m, 0.0, 1.0, 800.0, 1e-5), outlines=()), samples)
        expect(page.locator("[data-number=x]")).to_have_text(f"{1000 * x_m:.1f}")

    def is_drawn_at(x_m: float) -> bool:
        drawn = """(x) => {
          const canvas = document.querySelector("canvas.marks"), copy = new OffscreenCanvas(1, 1).getContext("2d");
          copy.drawImage(canvas, Math.round((0.5 + x / 0.14) * canvas.width), canvas.height / 2, 1, 1, 0, 0, 1, 1);
          return copy.getImageData(0, 0, 1, 1).data[3] > 0;
        }"""
        return bool(page.evaluate(drawn, x_m))

    server.show_status({"skins": ["/plate"], "diagnostics": []})
    show_at(-0.06)
    show_at(-0.04)
    server.forget("/plate")
    show_at(-0.02)
    assert not any(map(is_drawn_at, (-0.05, -0.03)))


def test_the_slider_reaches_the_end_of_a_recording(tmp_path: Path, open_page: Callable[..., Page]) -> None:
    path = tmp_path / "one.npz"
    # 4.995 s: no multiple of the slider's step.
    count = 1000
    np.savez(path, indices=np.tile(np.arange(3), (count, 1)), counts=np.ones((count, 3), int), rate_hz=200.0)
    source, name = open_recorded(path, [], "square")
    length_s = source.recording.length_us * 1e-6
    assert length_s == pytest.approx(4.995)
    shown = Shown(source, name)
    try:
        # Where this takes longer than it plays, it plays once more.
        page = open_page(shown, is_live=False)
        page.click("#replay button")
        expect(page.locator("#replay button")).to_have_text("Play")
        slider = page.locator("#replay input")
        slider.press("End")
        assert float(slider.input_value()) >= length_s
        wait_for(lambda: bool(source.status()["replay"]["position_s"] == pytest.approx(length_s)))
    finally:
        shown.close()


def test_what_is_refused_is_said_until_something_is_done(
    tmp_path: Path, open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    source, name = open_recorded(write_frames(tmp_path / "press.npz", 40), [], "square")

    def refuse(_: Request) -> str:
        raise ViewRequestError("the recording is read by somebody else")

    shown = Shown(source, name)
    try:
        page = open_page(shown)
        button, answer = page.locator("#replay button"), page.locator("#replay .answer")
        expect(answer).to_be_hidden()
        with monkeypatch.context() as patched:
            patched.setattr(source, "do", refuse)
            button.click()
            expect(answer).to_have_text("the recording is read by somebody else")
        expect(button).to_have_text("Hold")
        button.click()
        expect(button).to_have_text("Play")
        expect(answer).to_be_hidden()
    finally:
        shown.close()


def test_what_is_pressed_twice_before_the_server_has_told_of_it_is_as_before(
    tmp_path: Path, open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    source, name = open_recorded(write_frames(tmp_path / "press.npz", 40), [], "square")
    asked: list[str] = []
    act = source.do

    def note(request: Request) -> str:
        asked.append(request.do)
        return act(request)

    monkeypatch.setattr(source, "do", note)
    shown = Shown(source, name)
    try:
        page = open_page(shown)
        page.evaluate("() => { for (const _ of [1, 2]) document.querySelector('#replay button').click(); }")
        wait_for(lambda: len(asked) == 2, "two requests", state=lambda: asked)
        assert asked == ["pause", "play"]
        expect(page.locator("#replay button")).to_have_text("Hold")
        assert source.status()["replay"]["playing"]
    finally:
        shown.close()
