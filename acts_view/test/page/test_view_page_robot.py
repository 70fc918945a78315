# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the page tells of a hand, a ball and a known object, in a real browser: as a person would write it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING, Any

import pytest
from view_browser import DEADLINE_MS, expect, needs_browser
from view_player import Player
from waiting import wait_for

from acts_view.skin.snapshot import Frame, RegionState, SkinShape

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

SMALL = -1e-6
NEAREST = [[2, 0.25], [7, 0.5], [29, 0.75]]
SPOON = {"number": 2, "name": "wooden_spoon", "confidence": 0.5, "nearest": NEAREST}
UNTOUCHED: dict[str, Any] = {"number": None, "name": "", "confidence": None, "nearest": []}


def centred(frame: Frame) -> Frame:
    """All of it a little below zero."""
    ball = {**frame.ball, "ball": [SMALL, SMALL], "tilt_measured": [SMALL, SMALL]}
    hand = {**frame.hand, "joints": [["index_mcp", SMALL]]}
    return replace(frame, touch=(SMALL, SMALL, 1.25, 800.0, 1.9e-5), ball=ball, hand=hand)


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


def test_patches_without_a_hand_are_not_called_one(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play(change=lambda frame: replace(frame, hand={})))
    page.wait_for_selector(".regions li")
    expect(page.locator(".regions h3").first).to_have_text("Patches")


def test_nothing_is_minus_zero(play: Callable[..., Player], open_page: Callable[..., Page]) -> None:
    page = open_page(play(change=centred))
    expect(page.locator("[data-number=x]")).to_have_text("0.0")
    expect(page.locator("[data-number=y]")).to_have_text("0.0")
    expect(page.locator("[data-ball=ball]")).to_have_text("0.0, 0.0")
    expect(page.locator("[data-ball=tilt]")).to_have_text("0.00, 0.00")
    expect(page.locator(".joints dd")).to_have_text(["0"])


def test_joints_of_several_publishers_stay_and_those_of_none_go(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    publishers, frames = ["wrist", "arm"], count()

    def change(frame: Frame) -> Frame:
        # A message has the joints of one of them.
        name = publishers[next(frames) % 2]
        return replace(frame, hand={**frame.hand, "joints": [[name, 0.5]]})

    page = open_page(play(change=change))
    expect(page.locator(".joints dt")).to_have_count(2)
    publishers[:] = ["arm", "finger"]
    expect(page.locator(".joints dt").filter(has_text="wrist")).to_have_count(0)
    expect(page.locator(".joints dt")).to_have_text(["arm", "finger"])
    page.evaluate(
        """() => {
          window.gone = 0;
          const count = (changes) => (window.gone += changes.reduce((sum, one) => sum + one.removedNodes.length, 0));
          new MutationObserver(count).observe(document.querySelector(".joints"), { childList: true });
        }"""
    )
    enough = next(frames) + 60
    wait_for(lambda: next(frames) >= enough, "60 frames", DEADLINE_MS / 1000, lambda: page.wait_for_timeout(100))
    assert page.evaluate("() => window.gone") == 0


@pytest.mark.parametrize("width", [360, 1280])
def test_a_region_has_room_for_its_name(
    play: Callable[..., Player], open_page: Callable[..., Page], width: int
) -> None:
    names = ["middle_proximal", "thumb_proximal", "a_region_of_a_layout_of_ones_own"]
    regions = [RegionState(name, 2.5, 0.0032, True) for name in names]
    page = open_page(play(change=lambda frame: replace(frame, regions=regions)), width)
    expect(page.locator(".regions li")).to_have_count(3)
    rows = page.evaluate(
        """() => [...document.querySelectorAll(".regions li")].map((row) => {
          const [name, bar] = ["name", "bar-of-force"].map((one) => row.querySelector(`.${one}`));
          const words = document.createRange();
          words.selectNodeContents(name);
          const isCut = getComputedStyle(name).overflowX === "hidden";
          const end = isCut ? name.getBoundingClientRect().right : words.getBoundingClientRect().right;
          return { isWhole: name.scrollWidth <= name.clientWidth, isBeside: end <= bar.getBoundingClientRect().left };
        })"""
    )
    assert [row["isWhole"] for row in rows] == [True, True, False]
    assert all(row["isBeside"] for row in rows)
    # What is cut can be read all the same.
    assert page.get_attribute(".regions li:last-child .name", "title") == "a region of a layout of ones own"


def test_a_known_object_is_named_while_somebody_classifies(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    told: dict[str, Any] = {}
    page = open_page(play(change=lambda frame: replace(frame, object=told)))
    card, found = page.locator(".object"), page.locator(".object .found")
    rows = card.locator("tbody tr")
    expect(card).to_be_hidden()
    told = SPOON
    expect(found).to_have_text("wooden spoon (confidence 0.50)")
    expect(rows).to_have_text(["wooden spoon25", "no. 750", "no. 2975"])
    expect(card).to_contain_text("it is no probability")
    # Another one, which nearly fits: of both it knows the names by now.
    told = {"number": 7, "name": "cup", "confidence": 0.125, "nearest": [[7, 0.35], [2, 0.4]]}
    expect(found).to_have_text("not sure: cup, wooden spoon or another (confidence 0.13)")
    told = {**SPOON, "confidence": None, "nearest": NEAREST[:1]}
    expect(found).to_have_text("wooden spoon; there is no other to compare with")
    told = {**SPOON, "nearest": [[2, 0.95], [7, 1.25]]}
    expect(found).to_have_text("nothing known")
    expect(rows).to_have_text(["wooden spoon95", "cup100"])
    told = UNTOUCHED
    expect(found).to_have_text("nothing presses")
    expect(rows).to_have_count(0)
    told = {}
    expect(card).to_be_hidden()
    # Whoever classifies next may have other objects.
    told = {**SPOON, "number": 29, "name": "", "nearest": [[29, 0.1], [2, 0.9]]}
    expect(found).to_have_text("no. 29 (confidence 0.50)")
    expect(rows).to_have_text(["no. 2910", "no. 290"])


def test_names_of_objects_are_forgotten_also_while_nothing_is_drawn(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    told: dict[str, Any] = SPOON
    frames = count()

    def change(frame: Frame) -> Frame:
        next(frames)
        return replace(frame, object=told)

    page = open_page(play(change=change))
    found, pause = page.locator(".object .found"), page.locator("#pause")
    expect(found).to_have_text("wooden spoon (confidence 0.50)")
    # Meanwhile who classified ends, and another one has other objects.
    pause.click()
    others: list[dict[str, Any]] = [{}, {**SPOON, "number": 7, "name": "cup", "nearest": [[7, 0.1], [2, 0.9]]}]
    for other in others:
        told = other
        enough = next(frames) + 60
        wait_for(lambda enough=enough: next(frames) >= enough, "some frames")  # type: ignore[misc]
    expect(found).to_have_text("wooden spoon (confidence 0.50)")
    pause.click()
    expect(found).to_have_text("cup (confidence 0.50)")
    expect(page.locator(".object tbody tr")).to_have_text(["cup10", "no. 290"])


@pytest.mark.parametrize("width", [280, 360, 1280])
def test_a_long_name_stays_in_its_card(play: Callable[..., Player], open_page: Callable[..., Page], width: int) -> None:
    told = {**SPOON, "name": "n" * 200}
    page = open_page(play(change=lambda frame: replace(frame, object=told)), width)
    expect(page.locator(".object .found")).to_contain_text("nnn")
    assert page.evaluate("() => document.documentElement.scrollWidth <= innerWidth")
    inside = page.evaluate(
        """() => {
          const right = document.querySelector(".facts").getBoundingClientRect().right;
          const ends = [...document.querySelectorAll(".object *")].map((one) => one.getBoundingClientRect().right);
          return ends.every((end) => end <= right + 1);
        }"""
    )
    assert inside


def test_the_object_of_a_silent_skin_is_dimmed_with_its_figures(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    player = play(change=lambda frame: replace(frame, object=SPOON))
    page = open_page(player)
    player.is_silent = True
    expect(page.locator(".skin .pill")).to_contain_text("silent")
    expect(page.locator(".facts:has(.object)")).to_have_css("opacity", "0.6")
