# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the detector of impacts does with times that cannot be."""

from __future__ import annotations

import numpy as np
import pytest

from acts_core.errors import ArrayError
from acts_recon.impacts import Impact
from acts_recon.settings import ReconstructionSettings


@pytest.mark.parametrize(("time_s", "duration_s"), [(np.nan, 0.002), (np.inf, 0.002), (0.05, np.nan), (0.05, -1.0)])
def test_a_frame_at_no_time_is_refused_and_no_touch_is_forgotten(time_s: float, duration_s: float) -> None:
    settings = ReconstructionSettings(touch_counts=25)
    detector = settings.impact_detector(settings.recovery())
    rows, cols = np.indices((settings.rows, settings.cols))
    touched = (400 * np.exp(-((rows - 10) ** 2 + (cols - 22) ** 2) / 4.5)).astype(np.float32)
    told: list[Impact] = []
    for frame in range(100):
        if frame == 25:
            with pytest.raises(ArrayError, match="needed are finite times"):
                detector.step(time_s, duration_s, touched)
        told += detector.step(0.002 * frame, 0.002, touched if 10 <= frame < 40 else np.zeros_like(touched))
    assert [(impact.number, impact.is_over) for impact in told] == [(1, False), (1, True)]
