# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Every measurement that runs the driver, for a moment: what it counts is right, how fast it was is not asked.

ROS_DOMAIN_ID 106 to 108.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_tools.bench.cases import driver_cpu, frame_rate, latency
from acts_tools.bench.result import Result
from acts_tools.bench.workbench import Workbench
from acts_tools.running.stopping import StopFlag

pytestmark = pytest.mark.slow


def values(result: Result) -> dict[str, Any]:
    keys = [figure.key for figure in result.figures]
    assert len(set(keys)) == len(keys)
    return {figure.key: figure.value for figure in result.figures}


@pytest.fixture
def workbench(tmp_path: Path) -> Workbench:
    return Workbench(0.6, tmp_path, StopFlag())


def test_the_driver_loses_nothing_at_200_hz(workbench: Workbench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "106")
    monkeypatch.setattr(driver_cpu, "_RATE_HZ", 200.0)
    figures = values(driver_cpu.measure(workbench))
    # A board that was not woken for a quarter of a second leaves frames out and says so.
    assert figures["lost"] <= figures["overruns"]
    for key in ("driver_percent", "board_percent", "driver_us", "rate_hz", "frames"):
        assert figures[key] >= 0, key


def test_latencies_begin_at_the_true_time(workbench: Workbench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "107")
    figures = values(latency.measure(workbench))
    for key in ("received_ms", "sent_ms", "direct_ms", "by_stamp_ms", "stamp_error_us"):
        percentiles = [figures[f"{key}.{name}"] for name in ("median", "p99", "p999")]
        assert percentiles == sorted(percentiles), key
        # Nothing can be read before it was measured.
        assert percentiles[0] > 0, key
    assert figures["frames"] > 0
    assert np.isfinite(figures["stamp_bias_us"])


def test_the_search_covers_the_driver_and_its_peers(workbench: Workbench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "108")
    for name in ("START_HZ", "MINIMUM_HZ", "MAXIMUM_HZ"):
        monkeypatch.setattr(frame_rate, name, 200.0)
    figures = values(frame_rate.measure(workbench))
    # None where a loaded machine was too slow for even that.
    assert all(figures[f"{name}_hz"] in (200.0, None) for name in ("driver", "plain", "naive"))
    assert figures["ratio"] in (1.0, None)


def test_a_measurement_stops_when_it_is_told_to(workbench: Workbench, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "106")
    workbench.stop.is_set = True
    with pytest.raises(KeyboardInterrupt):
        driver_cpu.measure(workbench)
