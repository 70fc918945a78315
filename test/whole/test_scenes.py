# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Simulated scenes through the whole chain: files of `acts evaluate` -> virtual board -> driver -> reconstruction.

ROS_DOMAIN_ID 75.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from acts_msgs.msg import ContactSeries, Impact
from acts_ros import qos
from acts_ros.messages import stamp_ns_of
from acts_tools.cli import main
from acts_tools.testing.launch_runner import launched

pytestmark = pytest.mark.slow

START_S = 90.0
DROPS = 4
FRAME_S = 0.001
# Before and after a bounce it is as without one.
AROUND_S = 0.05


class Gaps:
    """When frames were missing, as viewers are told: a bounce in which some were left out is not seen whole."""

    def __init__(self) -> None:
        self._gaps_s: list[tuple[float, float]] = []
        self._newest_s = 0.0

    def take(self, series: ContactSeries) -> None:
        self._newest_s = 1e-9 * stamp_ns_of(series.newest)
        for age_s, missing in zip(series.age, series.missing, strict=True):
            if missing:
                end_s = self._newest_s - age_s
                self._gaps_s.append((end_s - missing * FRAME_S, end_s))

    def have_spared(self, impact: Impact) -> bool:
        begin_s = impact.onset.sec + 1e-9 * impact.onset.nanosec - AROUND_S
        end_s = begin_s + impact.duration + 2 * AROUND_S
        return end_s < self._newest_s and not any(gap[0] < end_s and gap[1] > begin_s for gap in self._gaps_s)


def test_a_ball_that_bounces_once_a_second_is_told_as_such(tmp_path: Path) -> None:
    assert main(["evaluate", "impacts", "--seeds", "1", "--m", "64", "--recordings", str(tmp_path)]) == 0
    over: list[Impact] = []
    gaps = Gaps()

    def whole() -> list[Impact]:
        return list(filter(gaps.have_spared, over))

    def keep(impact: Impact) -> None:
        if impact.is_over:
            over.append(impact)

    with launched(
        "acts_bringup",
        "tactile.launch.xml",
        domain_id=75,
        run_dir=str(tmp_path / "run"),
        ball="false",
        recording=str(tmp_path / "drop.npy"),
        recording_rate_hz="8000",
    ) as launch:
        launch.probe.node.create_subscription(ContactSeries, "/plate/view/contact_series", gaps.take, qos.VIEW)
        launch.probe.node.create_subscription(Impact, "/plate/impacts", keep, qos.STREAM)
        launch.probe.wait_for(lambda: len(whole()) >= DROPS, START_S, f"{DROPS} bounces")
        assert launch.stop() == 0
    over = whole()
    assert all(impact.kind == Impact.IMPACT and impact.bounced for impact in over)
    # 8.7 ms in the scene; here 8.8 to 9.3. A frame is 1 ms.
    assert all(0.006 < impact.duration < 0.012 for impact in over)
    onsets_s = np.array([impact.onset.sec + 1e-9 * impact.onset.nanosec for impact in over])
    apart_s = np.diff(onsets_s)
    # Here within 0.25 ms. A board that stood still for a while may have left out a bounce.
    assert np.abs(apart_s - np.rint(apart_s)) == pytest.approx(0.0, abs=2e-3)
    assert (apart_s > 0.5).all()
