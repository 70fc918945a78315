# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Lines of the log that are throttled go by the steady clock: see `acts_ros.log.STEADY`."""

from __future__ import annotations

import ast
from pathlib import Path

ROOT = Path(__file__).parents[2]


def by_the_system(source: str) -> list[int]:
    """Lines of the calls that are throttled by the clock of the system."""
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call):
            given = {keyword.arg for keyword in node.keywords}
            if "throttle_duration_sec" in given and "throttle_time_source_type" not in given:
                found.append(node.lineno)
    return found


def test_throttled_lines_go_by_the_steady_clock() -> None:
    assert by_the_system("logger.error('it', throttle_duration_sec=1.0)") == [1]
    sources = [file for folder in ("acts_*/acts_*", "examples") for file in ROOT.glob(f"{folder}/**/*.py")]
    assert any("throttle_duration_sec" in file.read_text() for file in sources)
    assert {str(file): found for file in sources if (found := by_the_system(file.read_text()))} == {}
