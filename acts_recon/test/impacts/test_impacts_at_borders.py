# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An impact whose middle lies beyond the border of the patch that it presses."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from test_detector import bump, told_of

from acts_core.array import ArrayGeometry
from acts_core.sampling import SamplingConfig
from acts_recon.impacts import Kind
from acts_recon.settings import ReconstructionSettings

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(("col", "width"), [(16.8, 1.8), (17.5, 2.5)])
def test_an_impact_is_told_on_the_patch_that_it_presses(col: float, width: float, tmp_path: Path) -> None:
    """What lies beside it in the picture may be another finger."""
    skin = tmp_path / "two.yaml"
    skin.write_text(
        "matrix: [32, 32]\npitch_m: 0.004375\npatches:\n"
        "  left: {at: [0, 0], wires: {down: rows, across: cols 0 to 15}}\n"
        "  right: {at: [0, 16], wires: {down: rows, across: cols 16 to 31}}\n"
    )
    settings = ReconstructionSettings(layout=str(skin), touch_counts=25)

    def pressure(time_s: float) -> NDArray[np.float64]:
        share = (time_s - 0.2) / 0.008
        pressed = np.zeros((32, 32))
        if 0 < share < 1:
            counts = 2000 * math.sin(math.pi * share) * bump(32, 32, 10, col, width)
            pressed[:, :16] = np.minimum(counts, 1000)[:, :16]
        return pressed

    told = told_of(settings, SamplingConfig("tracking", 32, 32, 128, threshold_counts=25), pressure, 0.3)
    (impact,) = (one for one in told if one.kind is Kind.IMPACT)
    inner_m, border_m = ArrayGeometry(32, 32, 0.004375).x_m([13.0, 15.5])
    assert inner_m < impact.x_m <= border_m
    assert max(impact.path_x_m) <= border_m
