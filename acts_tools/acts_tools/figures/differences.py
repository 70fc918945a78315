# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How far a published curve and its counterpart here are apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_tools.figures.sheet import PUBLISHED, Curve, Panel


def differences(panels: Sequence[Panel]) -> list[dict[str, Any]]:
    """Compare published curves with the curves beside which they stand, where both are.

    Returns
    -------
    list of dict
        `panel`, `published`, `curve`: titles and labels; `points`: how many of the published points lie in the range of
        the curve, or the two ends of the range that both have where less than two do; `mean_relative`,
        `largest_relative`: of the absolute differences there, both linear between their points, relative to the
        published value; `mean_absolute`, `mean`: of the absolute and the signed difference.
    """
    found = []
    for panel in panels:
        curves = {curve.label: curve for curve in panel.curves if curve.by != PUBLISHED}
        for published in panel.curves:
            if published.by != PUBLISHED or published.beside not in curves:
                continue
            curve = curves[published.beside]
            x, y = np.array(published.x), np.array(published.y)
            first, last = max(min(curve.x), x.min()), min(max(curve.x), x.max())
            inside = (x >= first) & (x <= last) & (y != 0)
            if inside.sum() < 2 and first < last:
                ends = np.array([first, last])
                x, y = ends, _at(ends, published)
                inside = y != 0
            if not inside.any():
                continue
            there = _at(x[inside], curve)
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


def _at(x: NDArray[np.float64], curve: Curve) -> NDArray[np.float64]:
    """Values of a curve, linear between its points."""
    order = np.argsort(curve.x)
    return np.interp(x, np.array(curve.x)[order], np.array(curve.y)[order])
