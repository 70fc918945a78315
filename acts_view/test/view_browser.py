# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where a browser for the tests of the page is; the fixtures are in conftest.py."""

from __future__ import annotations

import os
import shutil
from typing import Any

import pytest

__all__ = ["BROWSER", "DEADLINE_MS", "INSTALL", "expect", "needs_browser"]

# The first opens a page for a third of the CPU time.
BROWSER = shutil.which("chromium-headless-shell") or shutil.which("chromium")
try:
    from playwright.sync_api import expect
except ImportError:
    BROWSER = None
    expect: Any = None  # type: ignore[no-redef]
INSTALL = (
    "playwright or chromium is missing: sudo apt-get install chromium-headless-shell fonts-dejavu-core; "
    "./acts run python3 -m pip install 'playwright==1.65.*'"
)
needs_browser = pytest.mark.skipif(BROWSER is None and "ACTS_REQUIRE_BROWSER" not in os.environ, reason=INSTALL)
"""Skips a test where there is none, with the command that installs it."""

DEADLINE_MS = 30_000
