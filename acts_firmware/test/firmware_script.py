# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Runs the scripts that build for the Teensy 4.1, and run programs on an emulated processor of that kind."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/firmware.py"
TOOLS_MISSING = 3
BUILD_LIMIT_S = 600


def firmware(*arguments: str, script: Path = SCRIPT) -> subprocess.CompletedProcess[str]:
    """The script's run; skips the test without its tools, unless ACTS_REQUIRE_FIRMWARE_TOOLS is set."""
    result = subprocess.run(
        [sys.executable, script, *arguments], capture_output=True, text=True, timeout=BUILD_LIMIT_S, check=False
    )
    if result.returncode == TOOLS_MISSING and "ACTS_REQUIRE_FIRMWARE_TOOLS" not in os.environ:
        pytest.skip(result.stderr.strip())
    return result
