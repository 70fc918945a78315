# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How far a published curve and its counterpart here are apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from acts_tools.figures.sheet import PUBLISHED, Panel


def differences(panels: Sequence[Panel]) -> list[dict[str, Any]]:
    """Compare published curves with the curves beside which they stand, where both are.

    Returns
    -------
    list of dict
        `panel`, `published`, `curve`: titles and labels; `points`: how many of the published points lie in the range of
        the curve; `mean_relative`, `largest_relative`: of the absolute differences there, the curve between its points
        linear, relative to the published value; `mean_absolute`, `mean`: of the absolute and the signed difference.
    """
    found = []
    for panel in panels:
        curves = {curve.label: curve for curve in panel.curves if curve.by != PUBLISHED}
        for published in panel.curves:
            if published.by != PUBLISHED or published.beside not in curves:
                continue
            curve = curves[published.beside]
            order = np.argsort(curve.x)
            x, y = np.array(published.x), np.array(published.y)
            inside = (x >= min(curve.x)) & (x <= max(curve.x)) & (y != 0)
            if not inside.any():
                continue
            there = np.interp(x[inside], np.array(curve.x)[order], np.array(curve.y)[order])
            relative = np.abs(there - y[inside]) / np.abs(y[inside])
            found.append(
                {
                    "panel": panel.title,
                    "published": published.label,
                    "curve": published.beside,
                    "points": int(inside.sum()),
                    "mean_relative": float(relative.mean()),
                    "largest_relative": float(relative.max()),
                    "mean_absolute": float(np.abs(there - y[inside]).mean()),
                    "mean": float((there - y[inside]).mean()),
                }
            )
    return found
