# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts bench soak`, much shorter than it is meant to be; and what it calls a problem. ROS_DOMAIN_ID 51."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from acts_tools.bench.cases import soak
from acts_tools.bench.cases.soak import measure, problems
from acts_tools.bench.registry import MEASUREMENTS
from acts_tools.bench.rigs.memory import JUDGED_S, Memory
from acts_tools.bench.workbench import Workbench
from acts_tools.running.stopping import StopFlag

pytestmark = pytest.mark.slow

FINE = dict.fromkeys(
    ("frames", "lost", "overruns", "discarded", "crc_errors", "malformed", "repeated", "restarts", "reconnects"), 0
)


def growing(mb_per_h: float, seconds: float = 600.0) -> Memory:
    """A jump of 50 MB at the start, then a line."""
    times = [float(second) for second in range(int(seconds) + 1)]
    return Memory(times, [150.0 + mb_per_h * second / 3600 - 50.0 * (second < 20) for second in times])


def test_five_seconds_lose_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "51")
    # How fast it is in the beginning is not asked here.
    monkeypatch.setattr(soak, "_SETTLE_S", 0.0)
    result = measure(Workbench(5.0, tmp_path, StopFlag()))
    figures: dict[str, Any] = {figure.key: figure.value for figure in result.figures}
    assert result.problems == []
    assert int(figures["frames_sent"]) >= 4000
    assert figures["frames_lost"] == int(figures["overruns"]) + int(figures["discarded"])
    assert figures["frames_sent"] == int(figures["frames_read"]) + int(figures["frames_lost"])
    assert figures["damaged"] == figures["reconnects"] == 0
    assert 10 < float(figures["rss_mb.start"]) < 2000
    assert float(figures["driver_percent"]) > 0
    assert 0 < float(figures["latency_ms.median"]) <= float(figures["latency_ms.p99"])


def test_it_is_made_only_by_name_and_lasts_ten_minutes() -> None:
    entry = MEASUREMENTS["soak"]
    assert entry.only_by_name
    assert entry.seconds == 600.0
    assert entry.load().measure is measure


def test_growth_is_that_behind_the_start() -> None:
    assert growing(0.0).growth_mb_per_h() == pytest.approx(0.0, abs=1e-6)
    assert growing(30.0).growth_mb_per_h() == pytest.approx(30.0)
    assert Memory([0.0], [5.0]).growth_mb_per_h() == 0.0
    assert growing(0.0).at(5.2) == 100.0


def test_what_the_board_dropped_is_slow_and_what_was_lost_besides_is_wrong() -> None:
    assert problems({**FINE, "lost": 7, "overruns": 4, "discarded": 3}, growing(0.0), 600.0) == []
    assert problems({**FINE, "lost": 7, "overruns": 5}, growing(0.0), 600.0) == [
        "2 frames were lost between board and driver"
    ]
    assert "3 crc_errors" in problems({**FINE, "crc_errors": 3}, growing(0.0), 600.0)[0]


def test_a_leak_is_a_problem_where_the_run_was_long_enough() -> None:
    assert problems(FINE, growing(5.0), 600.0) == []
    assert problems(FINE, growing(60.0), JUDGED_S - 1) == []
    assert problems(FINE, growing(60.0), 600.0) == ["the driver's memory grows by 60.0 MB an hour"]
