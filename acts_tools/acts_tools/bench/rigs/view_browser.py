# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The page in a real browser without a window, in a process of its own: how often and how late it draws.

    python3 -m acts_tools.bench.rigs.view_browser PORT SECONDS FILE

At the end it writes an object of JSON to the file, the fields of `Watched`. It needs playwright and chromium.
"""

from __future__ import annotations

import importlib.util
import json
import shutil
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from acts_tools.bench.rigs.view_clients import Watched

_OPEN_MS = 60_000
# Of each picture of the taxels, from the stamp of what it shows to the turn in which the browser shows it [ms]. The
# page draws in that turn.
_WATCH = """
window.ages_ms = [];
let stamp_s = null;
const parse = JSON.parse;
JSON.parse = (text) => {
  const value = parse(text);
  if (value?.type === "frame" && value.arrays.some(([name]) => name === "image")) stamp_s = value.stamp_s;
  return value;
};
const put = CanvasRenderingContext2D.prototype.putImageData;
CanvasRenderingContext2D.prototype.putImageData = function (...what) {
  put.apply(this, what);
  if (stamp_s !== null) window.ages_ms.push(Date.now() - 1000 * stamp_s);
};
"""


def browser() -> str | None:
    """The program of the browser; None where it or playwright is missing."""
    if importlib.util.find_spec("playwright") is None:
        return None
    return shutil.which("chromium") or shutil.which("chromium-headless-shell")


def watch(program: str, port: int, seconds: float) -> Watched:
    """Open the page for a while."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=program)
        page = launched.new_page(viewport={"width": 1280, "height": 900})
        page.set_default_timeout(_OPEN_MS)
        page.add_init_script(_WATCH)
        began_s = time.monotonic()
        page.goto(f"http://127.0.0.1:{port}/")
        # As a function: the page refuses to evaluate text, unless it is true at once.
        page.wait_for_function("() => window.ages_ms.length > 0")
        first_s = time.monotonic()
        page.evaluate("window.ages_ms = []")
        page.wait_for_timeout(1e3 * max(seconds - (first_s - began_s), 1.0))
        ages_ms = page.evaluate("window.ages_ms")
        lasted_s = time.monotonic() - first_s
        launched.close()
    return Watched([first_s - began_s], [len(ages_ms) / lasted_s], ages_ms)


def main(words: Sequence[str]) -> int:
    """Watch, write what was seen, and return 0."""
    program = browser()
    assert program is not None
    Path(words[2]).write_text(json.dumps(asdict(watch(program, int(words[0]), float(words[1])))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
