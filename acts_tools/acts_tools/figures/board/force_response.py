# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figure S9: counts of a taxel over the weight on the skin."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from acts_core.skin import ForceResponse
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, Curve, Panel

_GRAMS = (0, 10, 20, 30, 40, 50, 60, 70, 85, 100, 150, 200, 250, 300, 400, 500, 600, 700, 800)
_TAXELS = 16
"""Under the weight; not published."""

_G_M_S2 = 9.81
_LABEL = "simulated taxel"


def _measure(run: Run) -> list[Panel]:
    newtons = np.array(_GRAMS) * 1e-3 * _G_M_S2 / _TAXELS
    counts = ForceResponse().counts(newtons)
    curve = Curve(_LABEL, [float(grams) for grams in _GRAMS], counts.tolist(), OURS, "tracking")
    return [Panel("counts over weight", "weight on the skin [g]", "counts a taxel", [curve])]


def _published(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    curve = data.curve("figS_forceResponse/forceR.fig", "", named="published", beside=_LABEL, scheme="truth")
    return {panels[0].title: [curve]}


FIGURES = (
    Figure(
        "S9",
        "force response of a taxel",
        _measure,
        _published,
        notes=("The published weight stood on an area that is not told; ours assumes 16 taxels.",),
    ),
)
