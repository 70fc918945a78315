# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a program that reads the page out tells by itself, in a real browser: nothing that changes all the time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import count
from typing import TYPE_CHECKING

import pytest
from view_browser import expect, needs_browser
from view_player import Player

from acts_view.skin.snapshot import Frame

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [needs_browser, pytest.mark.slow]

# Keeps what changes and is read out, in the order in which it changes.
LISTEN = """() => {
  window.told = [];
  const listen = (changes) => {
    for (const { target } of changes) {
      const region = (target.closest ? target : target.parentElement).closest("[aria-live], [role=status], output");
      if (region && region.getAttribute("aria-live") !== "off") window.told.push(region.textContent);
    }
  };
  new MutationObserver(listen).observe(document.body, { subtree: true, childList: true, characterData: true });
}"""


def test_what_changes_by_itself_is_not_read_out_but_an_answer_is(
    play: Callable[..., Player], open_page: Callable[..., Page]
) -> None:
    forces_n = count(1)

    def change(frame: Frame) -> Frame:
        assert frame.touch is not None
        return replace(frame, touch=(*frame.touch[:2], next(forces_n), *frame.touch[3:]))

    player = play(change=change)
    recording = {"on": True, "note": "", "files": [], "name": "touch", "bytes": 0, "messages": 0, "lost": 0}
    recordings = ({**recording, "elapsed_s": float(second)} for second in count())
    replays = ({"name": "press", "playing": True, "position_s": float(at), "length_s": 900.0} for at in count())
    player.status = {"recording": next(recordings), "replay": next(replays)}
    page = open_page(player)
    line, where = page.locator("#recording .answer"), page.locator("#replay output")
    expect(line).to_have_text("touch: 0 s, 0.0 MB, 0 messages, 0 lost")
    page.evaluate(LISTEN)
    player.status = {"recording": next(recordings), "replay": next(replays)}
    expect(line).to_contain_text("touch: 1 s")
    expect(where).to_have_text("1.0 of 900.0 s")
    before = page.inner_text("[data-number=force]")
    expect(page.locator("[data-number=force]")).not_to_have_text(before)
    assert page.evaluate("() => window.told") == []
    # What is said of its end is.
    player.status["recording"] = {**recording, "on": False, "note": "5 messages in 1.0 s"}
    expect(line).to_have_text("5 messages in 1.0 s")
    assert "5 messages in 1.0 s" in page.evaluate("() => window.told")
