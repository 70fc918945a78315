# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The baseline of a skin whose taxels lie otherwise than in the matrix."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import CalibrationError
from acts_core.frames import SampleFrame, Scheme
from acts_core.skin import Layout, layout
from acts_driver.baseline import BaselineTracker
from acts_driver.baseline.baseline_config import BaselineConfig

ROWS, COLS = 8, 6
SIZE = ROWS * COLS
FRAME_NS = 10_000_000
CONFIG = BaselineConfig(tare_s=0.2, calibration_blocks=5, tau_s=5.0, hold_s=0.5)
# Rows 0 and 2 are neighbours, rows 0 and 1 are not.
COMBED = "matrix: [8, 6]\npatches:\n  pad:\n    wires: {down: 'rows 0 to 6 by 2, 1 to 7 by 2', across: cols}\n"


@pytest.fixture
def skin(tmp_path: Path) -> Layout:
    path = tmp_path / "combed.yaml"
    path.write_text(COMBED)
    return layout(str(path), ROWS, COLS)


class Stream:
    """A tracker that gets 100 full frames a second."""

    def __init__(self, skin: Layout | None = None) -> None:
        self.tracker = BaselineTracker(ROWS, COLS, CONFIG)
        if skin is not None:
            self.tracker.arrange(skin)
        self._frames = 0

    def run(self, seconds: float, field: NDArray[np.float64]) -> None:
        for _ in range(round(seconds * 100)):
            counts = np.rint(field).astype(np.uint16).ravel()
            frame = SampleFrame(0, 0, 0, Scheme.RASTER, ROWS, COLS, 0, np.arange(SIZE, dtype=np.uint16), counts)
            self.tracker.observe([(frame, self._frames * FRAME_NS)])
            self._frames += 1


def untouched() -> NDArray[np.float64]:
    return np.full((ROWS, COLS), 20.0)


def test_taxels_that_touch_on_the_skin_are_a_touch_and_such_as_touch_in_the_matrix_are_broken(skin: Layout) -> None:
    touched, broken = untouched(), untouched()
    touched[[0, 2], 3] = 400
    broken[[0, 1], 3] = 400
    stream = Stream(skin)
    stream.run(2.0, broken)
    stream.tracker.calibrate()
    stream = Stream(skin)
    stream.run(2.0, touched)
    with pytest.raises(CalibrationError, match="2 taxels, for example row 0, column 3"):
        stream.tracker.calibrate()


def test_taxels_without_skin_are_not_touched(tmp_path: Path) -> None:
    path = tmp_path / "half.yaml"
    path.write_text("matrix: [8, 6]\npicture: [8, 6]\npatches:\n  pad:\n    wires: {down: rows 0 to 3, across: cols}\n")
    stream = Stream(layout(str(path), ROWS, COLS))
    open_wires, touched = untouched(), untouched()
    open_wires[4:, 2:4] = 400
    touched[2:4, 2] = 400
    stream.run(2.0, open_wires)
    assert stream.tracker.calibrate().baseline.counts[4:, 2:4].tolist() == [[400.0] * 2] * 4
    stream.run(2.0, touched)
    with pytest.raises(CalibrationError, match="2 taxels, for example row 2, column 2"):
        stream.tracker.calibrate()


def test_what_lies_beside_a_touch_on_the_skin_does_not_drift(skin: Layout) -> None:
    stream = Stream(skin)
    stream.run(2.0, untouched())
    stream.tracker.calibrate()
    pressed = untouched()
    pressed[0, 3] = 400
    # The edge of the touch: too little to tell from drift. Row 1 lies elsewhere.
    pressed[2, 2:5] += 8
    pressed[1, 3] += 8
    stream.run(20.0, pressed)
    present = stream.tracker.present()
    assert present is not None
    assert present.counts[2, 2:5].tolist() == [20.0] * 3
    assert present.counts[1, 3] == pytest.approx(28, abs=0.5)
