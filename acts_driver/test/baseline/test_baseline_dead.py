# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The baseline of a skin with dead taxels: what they read is no touch."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import CalibrationError, SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_driver.baseline import BaselineTracker
from acts_driver.baseline.baseline_config import BaselineConfig
from acts_driver.settings import DriverSettings

ROWS, COLS = 8, 6
SIZE = ROWS * COLS
FRAME_NS = 10_000_000
OPEN_ROW = 3


class Skin:
    """A tracker that gets 100 full frames a second of an array with an open row, which reads anything."""

    def __init__(self, dead_taxels: str) -> None:
        config = BaselineConfig(
            tare_s=0.2, calibration_blocks=5, tau_s=5.0, hold_s=0.5, touch_counts=60, dead_taxels=dead_taxels
        )
        self.tracker = BaselineTracker(ROWS, COLS, config)
        self._rng = np.random.default_rng(5)
        self._frames = 0

    def run(self, seconds: float, counts: float = 20.0, pressed: NDArray[np.bool_] | None = None) -> None:
        for _ in range(round(seconds * 100)):
            field = np.full((ROWS, COLS), counts)
            if pressed is not None:
                field[pressed] += 400
            field[OPEN_ROW] = self._rng.uniform(0, 1023, COLS)
            frame = SampleFrame(
                *(0, 0, 0, Scheme.RASTER, ROWS, COLS, 0, np.arange(SIZE, dtype=np.uint16)),
                np.rint(field).astype(np.uint16).ravel(),
            )
            self.tracker.observe([(frame, self._frames * FRAME_NS)])
            self._frames += 1


def test_an_open_row_that_is_told_hinders_no_calibration_and_no_tare() -> None:
    untold = Skin("")
    untold.run(2.0)
    assert untold.tracker.tare().unsteady == COLS
    with pytest.raises(CalibrationError, match=f"for example row {OPEN_ROW}, column 0"):
        untold.tracker.calibrate()
    told = Skin(f"row={OPEN_ROW}")
    told.run(2.0)
    assert told.tracker.tare().unsteady == 0
    baseline = told.tracker.calibrate().baseline
    np.testing.assert_array_equal(np.delete(baseline.counts, OPEN_ROW, axis=0), 20.0)


def test_taxels_beside_a_dead_row_follow_their_drift() -> None:
    skin = Skin(f"row={OPEN_ROW}")
    skin.run(2.0)
    skin.tracker.calibrate()
    assert skin.tracker.drift() is None
    skin.run(20.0, counts=25.0)
    present, drift = skin.tracker.present(), skin.tracker.drift()
    assert present is not None
    np.testing.assert_allclose(np.delete(present.counts, OPEN_ROW, axis=0), 25.0, atol=0.5)
    assert skin.tracker.below() == 0
    # What the open row reads is no drift: of the others 5 counts in 20 s.
    assert drift is not None
    assert (drift.median, drift.largest) == pytest.approx((15.0, 15.0), abs=1.5)


def test_a_touch_across_a_dead_row_is_a_touch() -> None:
    pressed = np.zeros((ROWS, COLS), dtype=np.bool_)
    pressed[OPEN_ROW - 1 : OPEN_ROW + 2, 2:4] = True
    skin = Skin(f"row={OPEN_ROW}")
    skin.run(2.0)
    skin.tracker.calibrate()
    skin.run(2.0, pressed=pressed)
    with pytest.raises(CalibrationError, match=f"4 taxels, for example row {OPEN_ROW - 1}, column 2"):
        skin.tracker.calibrate()


def test_a_driver_refuses_what_are_no_taxels() -> None:
    with pytest.raises(SettingsError, match="dead_taxels: 'row=16' is outside of an array of 16 x 16"):
        DriverSettings(rows=16, cols=16, dead_taxels="row=16")
    assert DriverSettings(rows=16, cols=16, dead_taxels="row=15").baseline_config().dead_taxels == "row=15"
