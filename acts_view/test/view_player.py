# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A server of the page with a skin that is pressed at one place, and what pages of it save."""

from __future__ import annotations

import csv
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from waiting import wait_for

from acts_view.skin.snapshot import Frame, RegionState, Sample, SkinShape
from acts_view.web.server import ViewServer

if TYPE_CHECKING:
    from playwright.sync_api import Page

ROW, COL = 8, 20
PERIOD_S = 1 / 30
# A triangle in the lower half of the skin, far from the press.
OUTLINE = [(-0.03, -0.05), (0.03, -0.05), (0.0, -0.02)]


def pressed(name: str, time_s: float) -> tuple[str, Frame, list[Sample]]:
    """A skin that is pressed at one place; 1 kHz for the time between two frames."""
    image = np.zeros((32, 32), np.uint16)
    image[ROW, COL] = 800
    confidence = np.full((32, 32), 255, np.uint8)
    age_s = np.full((32, 32), 0.0123, np.float32)
    age_s[ROW, COL], age_s[0, 0] = 0.0, np.inf
    x_m, y_m = (COL - 15.5) * 0.004375, (15.5 - ROW) * 0.004375
    contacts = np.array([[x_m, y_m, 1.25, 800, 1.9e-5, 0.001, 0.125, 1.0]], np.float32)
    frame = Frame(
        stamp_s=time_s,
        image=image,
        confidence=confidence,
        age_s=age_s,
        contact_numbers=np.array([42], np.uint32),
        contacts=contacts,
        outlines=[np.array(OUTLINE, np.float32)],
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
    """A server that a thread feeds as the node does, with what `pressed` gives or, of its frames, `change`."""

    def __init__(
        self,
        names: tuple[str, ...] = ("/plate",),
        shape: SkinShape | None = None,
        port: int = 0,
        change: Callable[[Frame], Frame] = lambda frame: frame,
        *,
        is_silent: bool = False,
    ) -> None:
        self.server = ViewServer("127.0.0.1", port, on_clients=lambda _: None, log=lambda *_: None)
        self.url = self.server.address.url
        for name in names:
            self.server.show_shape(name, shape or SkinShape())
        self.names = names
        """Of the skins that it plays; those that a test adds have the shape that it gives them."""
        self._change = change
        self.status: dict[str, Any] = {}
        """What each status says besides."""
        self.is_silent = is_silent
        """Whether only what controls the skins says something."""
        self._last: dict[str, Frame] = {}
        self._begin_s = time.time()
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._play, daemon=True)
        self._thread.start()

    def _play(self) -> None:
        number = 0
        node = {"name": "plate/driver", "level": 1, "message": "no board", "age_s": 0.1, "values": [["port", "auto"]]}
        while not self._stopped.wait(PERIOD_S):
            # First, so that a page that shows a skin has a status, too.
            if number % 30 == 0:
                self.server.show_status({"skins": list(self.names), "diagnostics": [node], **self.status})
            for name in self.names:
                _, frame, samples = pressed(name, self._begin_s + number * 0.033)
                frame = self._change(frame)
                if self.is_silent:
                    frame, samples = replace(self._last.get(name, Frame()), ball=frame.ball), []
                self._last[name] = frame
                self.server.show_frame(name, frame, samples)
            number += 1

    @property
    def newest_s(self) -> float:
        """Stamp of its newest frame [s], on a busy machine behind the time of day; a later one ends the history."""
        return max(frame.stamp_s for frame in list(self._last.values()))

    def wait_for_history(self, length_s: float) -> None:
        """Wait until the plots have so much to show [s]."""
        wait_for(lambda: bool(self._last) and self.newest_s - self._begin_s > length_s)

    def close(self) -> None:
        if not self._stopped.is_set():
            self._stopped.set()
            self._thread.join()
            self.server.close()


def next_picture(page: Page) -> None:
    """Wait until what has come by now is drawn, which is with the next picture of the screen."""
    page.evaluate("() => new Promise(requestAnimationFrame)")


def reload(page: Page) -> None:
    """Load the page anew, and wait until a skin is drawn again."""
    page.reload()
    page.wait_for_selector(".skin .pill[data-state=live]")
    next_picture(page)


def saved(page: Page, what: str, folder: Path) -> Path:
    """What a button of the page saves, put into a folder."""
    with page.expect_download() as downloading:
        page.click(f"[data-save={what}]")
    path = folder / downloading.value.suggested_filename
    downloading.value.save_as(path)
    return path


def saved_table(page: Page, what: str, folder: Path) -> list[dict[str, str]]:
    """The rows of a table that a button of the page saves."""
    with saved(page, what, folder).open() as lines:
        return list(csv.DictReader(lines))
