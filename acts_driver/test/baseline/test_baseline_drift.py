# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which readings a baseline follows, and what is told of its drift."""

from __future__ import annotations

import numpy as np
import pytest
from tracked_skin import COLS, CONFIG, ROWS, SIZE, Skin

from acts_core.frames import SampleFrame, Scheme
from acts_driver.baseline import BaselineTracker
from acts_driver.baseline.baseline_config import BaselineConfig


def test_a_clock_that_is_set_back_lets_no_taxel_stay_frozen() -> None:
    skin = Skin()
    skin.run(2.5)
    skin.tracker.calibrate()
    skin.run(0.1, skin.pressed())
    skin.now_ns -= 3600 * 10**9
    skin.run(CONFIG.hold_s + 0.5)
    before = skin.tracker.present()
    assert before is not None
    skin.field += 3.0
    skin.run(2.0)
    after = skin.tracker.present()
    assert after is not None
    assert (after.counts - before.counts).min() > 0.0


def test_after_the_clock_was_set_back_drift_is_told_of_the_time_since_then() -> None:
    skin = Skin(noise=0.0)
    skin.run(2.0)
    skin.tracker.calibrate()
    told = []
    for set_back_s in (0, 3600):
        skin.now_ns -= set_back_s * 10**9
        skin.run(0.01)
        assert set_back_s == 0 or skin.tracker.drift() is None
        for _ in range(12):
            skin.field += 0.2
            skin.run(1.0)
            drift = skin.tracker.drift()
        assert drift is not None
        told.append(drift.median)
    # 0.2 counts in a second are 12 in a minute; the baseline lags behind by its time constant.
    assert 5.0 < told[0] < 12.0
    assert told[0] < told[1] < 13.0


def test_drift_is_followed_but_not_where_the_skin_is_touched() -> None:
    skin = Skin()
    skin.run(2.0)
    skin.tracker.calibrate()
    assert skin.tracker.drift() is None
    pressed = skin.pressed(0, 0, 300.0)
    pressed[2, 2] += 6  # the edge of the touch: too little to tell from drift, but beside it
    for _ in range(30):
        skin.field += 0.3
        pressed += 0.3
        skin.run(1.0, pressed)
        drift = skin.tracker.drift()
    present = skin.tracker.present()
    assert present is not None
    # Frozen: the four taxels and all around them. The others lag by the time constant, 1.5 counts.
    assert np.abs(present.counts[:3, :3] - 20).max() < 2
    assert np.abs(present.counts[3:] - 27.5).max() < 1.5
    assert drift is not None
    assert 7 < drift.median < 20
    assert 10 < drift.largest < 24
    # And after the touch is over they catch up.
    skin.run(30.0)
    present = skin.tracker.present()
    assert present is not None
    assert np.abs(present.counts - 29).max() < 1.5


@pytest.mark.parametrize(("noise", "touch_counts", "further"), [(1.5, 60, 30), (25.0, 60, 110), (1.5, 5, 30)])
def test_what_is_farther_from_the_baseline_than_drift_is_not_followed(
    noise: float, touch_counts: int, further: int
) -> None:
    """As far as 20 counts or 6 sigmas of the noise, but no farther than what the board takes for a touch."""
    skin = Skin(BaselineConfig(touch_counts, tare_s=0.2, calibration_blocks=5, tau_s=5.0, hold_s=0.5), noise=noise)
    skin.field += 200
    skin.run(2.0)
    before = skin.tracker.tare().baseline.counts
    skin.noise = 0.0
    skin.run(10.0, skin.field + further)
    present = skin.tracker.present()
    assert present is not None
    assert (present.counts == before).all()


@pytest.mark.parametrize(("noise", "touch_counts", "moved"), [(0.0, 5, 19), (0.0, 60, 19), (8.0, 60, 10)])
def test_drift_is_followed_however_light_a_touch_is_and_however_large_the_noise(
    noise: float, touch_counts: int, moved: int
) -> None:
    skin = Skin(BaselineConfig(touch_counts, tare_s=0.2, tau_s=5.0, hold_s=0.5), noise=noise)
    skin.field += 200
    skin.run(2.0)
    skin.tracker.tare()
    skin.run(30.0, skin.field + moved)
    present = skin.tracker.present()
    assert present is not None
    assert np.abs(present.counts - skin.field - moved).max() < 1.5


def test_a_taxel_that_was_not_measured_for_long_does_not_follow_its_first_reading_at_once() -> None:
    skin = Skin(noise=0.0)
    skin.run(2.0)
    skin.tracker.calibrate()
    skin.now_ns += 3600 * 10**9
    skin.run(0.01, skin.field + 10)
    present = skin.tracker.present()
    assert present is not None
    assert present.counts == pytest.approx(np.full((ROWS, COLS), 20.5))


@pytest.mark.parametrize(("counts", "tau_s"), [(700, 600.0), (40, 36_000.0)])
def test_drift_is_followed_however_often_a_taxel_is_measured(counts: int, tau_s: float) -> None:
    """At 1 kHz a step was less than half of what tells two numbers of single precision apart: the baseline stayed."""
    tracker = BaselineTracker(ROWS, COLS, BaselineConfig(tare_s=0.2, tau_s=tau_s))
    indices = np.arange(SIZE, dtype=np.uint16)

    def run(begin_s: int, seconds: int, reading: int) -> None:
        frame = SampleFrame(0, 0, 0, Scheme.RASTER, ROWS, COLS, 0, indices, np.full(SIZE, reading, np.uint16))
        tracker.observe([(frame, 10**9 * begin_s + 10**6 * k) for k in range(1000 * seconds)])

    run(1000, 2, counts)
    before = tracker.tare().baseline.counts
    run(1002, 60, counts + 10)
    after = tracker.present()
    assert after is not None
    assert after.counts - before == pytest.approx(10 * (1 - np.exp(-60 / tau_s)), rel=0.02)


def test_a_baseline_may_be_told_to_stay() -> None:
    skin = Skin(BaselineConfig(tare_s=0.2, calibration_blocks=5, tau_s=0.0))
    skin.run(2.0)
    before = skin.tracker.calibrate().baseline
    skin.run(5.0, skin.field + 10)
    present = skin.tracker.present()
    assert present is not None
    assert (present.counts == before.counts).all()
