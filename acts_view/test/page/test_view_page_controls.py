# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What nodes can be asked for on the page, in a real browser: what is no value is refused beside its field."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player
from view_slow_line import StillLine
from waiting import wait_for

from acts_view.nodes.control import RANGES
from acts_view.web.requests import LATE_S, Answer, Number, Request
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
        ("m", "4097", "not set: the largest is 4096"),
        ("threshold_counts", "1024", "not set: the largest is 1023"),
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


def test_a_number_that_comes_while_one_is_about_to_be_typed_does_not_join_it(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    player.status |= {"offers": [["set", "/plate"]], "settings": {"/plate": {"m": 55, "threshold_counts": 40}}}
    page = open_page(player)
    field, other = page.locator("#controls [data-name=m]"), page.locator("#controls [data-name=threshold_counts]")
    expect(field).to_have_value("55")
    field.select_text()
    player.status["settings"] = {"/plate": {"m": 77, "threshold_counts": 41}}
    expect(other).to_have_value("41")
    expect(field).to_have_value("77")
    page.keyboard.type("60")
    expect(field).to_have_value("60")


def test_what_one_is_about_to_press_or_types_stays_where_nodes_come_and_go(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    settings = {"settings": {"/plate": {"m": 55, "threshold_counts": 40}}}
    player.status = {"offers": [["tare", "/plate"], ["stop_balancing", "/plate"], ["set", "/plate"]], **settings}
    page = open_page(player)
    parts, names = page.locator("#controls [data-of='/plate'] > *"), page.locator("#controls h3")
    expect(parts).to_have_count(6)
    field = page.locator("#controls [data-name=m]")
    field.focus()
    page.keyboard.press("ControlOrMeta+A")
    page.keyboard.type("12")
    # Another driver comes, and a service of this one and what stops go.
    player.status = {
        "offers": [["tare", "/arm"], ["calibrate", "/plate"], ["set", "/plate"], ["tare", "/zone"]],
        **settings,
    }
    expect(names).to_have_text(["/arm", "/plate", "/zone"])
    expect(parts.nth(1)).to_have_text("Calibrate")
    expect(parts).to_have_count(5)
    expect(field).to_be_focused()
    page.keyboard.type("8")
    expect(field).to_have_value("128")
    page.focus("#controls [data-do=calibrate]")
    player.status = {"offers": [["tare", "/plate"], ["calibrate", "/plate"]]}
    expect(names).to_have_text(["/plate"])
    expect(parts).to_have_text(["/plate", "Tare", "Calibrate"])
    expect(page.locator("#controls [data-do=calibrate]")).to_be_focused()


@pytest.mark.parametrize(("name", "given", "real"), [("m", "60", "55"), ("scheme", "raster", "tracking")])
def test_what_was_not_obeyed_does_not_stay_in_its_field_though_one_is_still_in_it(
    name: str, given: str, real: str, play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play()
    player.status |= {"offers": [["set", "/plate"]], "schemes": ["raster", "tracking"]}
    player.status |= {"settings": {"/plate": {"m": 55, "scheme": "tracking"}}}
    page = open_page(player)
    field = page.locator(f"#controls [data-name={name}]")
    expect(field).to_have_value(real)
    field.focus()
    if name == "scheme":
        field.select_option(given)
    else:
        page.keyboard.press("ControlOrMeta+A")
        page.keyboard.type(given)
        page.keyboard.press("Enter")
    # This server refuses everything.
    expect(page.locator("#controls > .answer")).to_contain_text(READ_ONLY)
    expect(field).to_be_focused()
    expect(field).to_have_value(real)


def test_the_limits_are_those_of_the_server(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    player = play()
    player.status |= {"offers": [["set", "/plate"]]}
    page = open_page(player)
    for name, (least, most) in RANGES.items():
        field = page.locator(f"#controls [data-name={name}]")
        expect(field).to_have_attribute("min", str(least))
        expect(field).to_have_attribute("max", str(most))


def test_a_field_that_one_has_left_keeps_its_value_until_the_answer(
    play: Callable[..., Player], open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    player = play()
    waiting: list[Answer] = []
    monkeypatch.setattr(player.server, "_on_request", lambda _request, answer: waiting.append(answer))
    player.status |= {"offers": [["set", "/plate"]], "settings": {"/plate": {"m": 55, "threshold_counts": 40}}}
    page = open_page(player)
    field, other = (page.locator(f"#controls [data-name={name}]") for name in ("m", "threshold_counts"))
    expect(field).to_have_value("55")
    field.fill("60")
    page.keyboard.press("Tab")
    expect(other).to_be_focused()
    # Told of later, so that the status has come, which still has the old value.
    player.status["settings"] = {"/plate": {"m": 55, "threshold_counts": 41}}
    expect(other).to_have_value("41")
    assert field.input_value() == "60"
    wait_for(lambda: waiting, "what was asked for")
    (answer,) = waiting
    answer(False, "too busy")
    expect(page.locator("#controls > .answer")).to_contain_text("too busy")
    expect(field).to_have_value("55")


def test_of_values_that_follow_one_another_the_last_one_counts(
    play: Callable[..., Player], open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    player = play()
    asked: list[Number | str | None] = []
    waiting: list[Answer] = []

    def take(request: Request, answer: Answer) -> None:
        asked.append(request.value)
        waiting.append(answer)

    monkeypatch.setattr(player.server, "_on_request", take)
    player.status |= {"offers": [["set", "/plate"]], "settings": {"/plate": {"m": 55, "threshold_counts": 40}}}
    page = open_page(player)
    field = page.locator("#controls [data-name=m]")
    expect(field).to_have_value("55")
    field.focus()
    for _ in range(12):
        page.keyboard.press("ArrowUp")
    expect(field).to_have_value("67")
    wait_for(lambda: len(waiting) == 1, "a request", state=lambda: asked)
    waiting[0](True, "set")
    wait_for(lambda: len(waiting) == 2, "the last value", state=lambda: asked)
    waiting[1](True, "set anew")
    expect(page.locator("#controls > .answer")).to_contain_text("set anew")
    assert asked == [56, 67]
    # Of another one's than this page's.
    player.status["settings"] = {"/plate": {"m": 20, "threshold_counts": 40}}
    expect(field).to_have_value("20")


def test_a_wheel_moves_the_page_and_no_number(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    player = play()
    player.status |= {"offers": [["set", "/plate"]], "settings": {"/plate": {"m": 55, "threshold_counts": 40}}}
    page = open_page(player, 1280, 600)
    field = page.locator("#controls [data-name=m]")
    expect(field).to_have_value("55")
    field.click()
    before = page.evaluate("window.scrollY")
    page.mouse.wheel(0, -100)
    page.wait_for_function("(before) => window.scrollY < before", arg=before)
    assert field.input_value() == "55"
    assert page.locator("#controls > .answer").inner_text() == ""


def test_an_answer_that_comes_late_does_not_take_the_place_of_another(
    play: Callable[..., Player], open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    player = play()
    waiting: dict[str, Answer] = {}
    monkeypatch.setattr(player.server, "_on_request", lambda request, answer: waiting.update({request.do: answer}))
    player.status |= {"offers": [["calibrate", "/plate"], ["stop_balancing", "/plate"]]}
    page = open_page(player)
    lines = page.locator("#controls > .answer > span")
    for what in ("calibrate", "stop_balancing"):
        page.click(f"[data-do={what}]")
        wait_for(lambda what=what: what in waiting, what)  # type: ignore[misc]
    waiting["stop_balancing"](False, "it is not reached")
    expect(lines).to_have_text(["Calibrate, /plate: asked …", "Stop balancing, /plate: it is not reached"])
    waiting["calibrate"](True, "calibrated")
    expect(lines).to_have_text(["Calibrate, /plate: calibrated", "Stop balancing, /plate: it is not reached"])
    page.click("[data-do=calibrate]")
    expect(lines).to_have_text(["Calibrate, /plate: asked …"])


def test_a_robot_is_not_started_when_the_line_goes_on(
    play: Callable[..., Player],
    open_page: Callable[..., Page],
    monkeypatch: pytest.MonkeyPatch,
    request: pytest.FixtureRequest,
) -> None:
    player = play()
    done: list[str] = []
    pages: list[int] = []

    def do(asked: Request, answer: Answer) -> None:
        done.append(asked.do)
        answer(True, "balancing")

    monkeypatch.setattr(player.server, "_on_request", do)
    monkeypatch.setattr(player.server, "_on_clients", pages.append)
    player.status |= {"offers": [["balance", "/plate"]]}
    line = StillLine(player.server.address.port)
    request.addfinalizer(line.close)
    # The server takes the page for its own by its address, which is that of the line.
    page = open_page(line)
    button, words = page.locator("[data-do=balance]"), page.locator("#controls > .answer")
    button.wait_for()
    line.stand_still()
    button.click()
    pressed_s = time.monotonic()
    expect(words).to_contain_text("the connection was lost before the answer; it may be done all the same")
    # Where the press itself took long the page has given it up sooner.
    wait_for(
        lambda: time.monotonic() > pressed_s + LATE_S, "its being late", meanwhile=lambda: page.wait_for_timeout(50)
    )
    line.go_on()
    expect(page.locator("#connection")).to_have_attribute("data-state", "live")
    # Of the connection that stood still the server has taken all by then.
    wait_for(lambda: any(after < before for before, after in pairwise(pages)), "its end", state=lambda: pages)
    assert done == []
    # On a line that does not stand still it is.
    button.click()
    # The button's title has the word, too.
    expect(words).to_contain_text(": balancing")
    assert done == ["balance"]


def test_a_button_that_is_kept_down_by_a_key_asks_once(
    play: Callable[..., Player], open_page: Callable[..., Page], monkeypatch: pytest.MonkeyPatch
) -> None:
    player = play()
    asked: list[str] = []
    monkeypatch.setattr(player.server, "_on_request", lambda request, _answer: asked.append(request.do))
    player.status |= {"offers": [["grasp", "/hand"], ["stop_grasp", "/hand"]]}
    page = open_page(player)
    page.focus("[data-do=grasp]")
    for _ in range(5):
        # All but the first are repeated.
        page.keyboard.down("Enter")
    page.keyboard.up("Enter")
    page.click("[data-do=stop_grasp]")
    wait_for(lambda: "stop_grasp" in asked, "what was asked for last", state=lambda: asked)
    assert asked == ["grasp", "stop_grasp"]
