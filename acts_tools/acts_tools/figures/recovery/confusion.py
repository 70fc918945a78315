# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures S7-1 to S7-3: which object is taken for which, as matrices beside the published ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.recovery.recognition import ALL, OUR_KEY, WINDOWS_MS, running_mean, shared_answers
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, Curve, Panel, Picture

_FILE = "confusion_SRC.npz"
_MODES = {"uniform": 0, "random": 1, "adaptive": 2}
"""Of the published matrices."""

_M = (64, 256, 512, ALL)
_M_OF_OURS = 64


def _panel(title: str, shares: ArrayLike, by: str = "") -> Panel:
    """A matrix whose rows are the objects that were pressed, and whose columns are the answers."""
    values = np.asarray(shares, dtype=float)
    last = len(values) + 0.5
    picture = Picture(values.tolist(), "share of the object's presses", 0.5, last, last, 0.5, lowest=0.0, highest=1.0)
    return Panel(title, "answer", "object pressed", picture=picture, by=by, equal=True)


def _measured(scheme: str) -> Callable[[Run], list[Panel]]:
    def measure(run: Run) -> list[Panel]:
        found = shared_answers(run)
        curves: list[Curve] = []
        panels: list[Panel] = []
        for key, m in [*((scheme, m) for m in run.pick(_M, (_M[0], ALL))), (OUR_KEY, _M_OF_OURS)]:
            ours = key == OUR_KEY
            label = f"ours, M = {m}" if ours else f"M = {m}"
            _, means = running_mean(found["right"][f"{key} {m}"], m, found["presses"])
            y = [means[window_ms - WINDOWS_MS[-1] - 1] for window_ms in WINDOWS_MS]
            colour = "tracking" if ours else f"C{len(curves)}"
            curves.append(Curve(label, [float(ms) for ms in WINDOWS_MS], y, OURS if ours else SAME, colour))
            for window_ms, matrix in zip(WINDOWS_MS, found["matrices"][f"{key} {m}"], strict=True):
                shares = np.array(matrix) * len(matrix) / found["presses"]
                panels.append(_panel(f"{label}, {window_ms} ms", shares))
        return [*panels, Panel("mean since contact", "time since contact [ms]", "accuracy", curves)]

    return measure


def _published_means(scheme: str) -> Callable[[PublishedData, Sequence[Panel]], dict[str, list[Curve]]]:
    def published(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
        x = (1e3 * data.array(_FILE, "window_s")).tolist()
        curves = []
        for curve in panels[-1].curves:
            if curve.by == SAME:
                y = [float(np.trace(matrix) / matrix.sum()) for matrix in _counts(data, scheme, curve.label)]
                curves.append(Curve(f"{curve.label}, published", x, y, PUBLISHED, beside=curve.label))
        return {panels[-1].title: curves}

    return published


def _with_published(scheme: str) -> Callable[[PublishedData, Sequence[Panel]], list[Panel]]:
    def published(data: PublishedData, panels: Sequence[Panel]) -> list[Panel]:
        """The published matrices of each M, and at their right ours of the same M and times."""
        whole: list[Panel] = []
        for first in range(0, len(panels) - 1, len(WINDOWS_MS)):
            row = panels[first : first + len(WINDOWS_MS)]
            if row[0].title.startswith("M = "):
                counts = _counts(data, scheme, row[0].title.partition(",")[0])
                for panel, matrix in zip(row, counts, strict=True):
                    shares = matrix / matrix.sum(axis=1, keepdims=True)
                    whole.append(_panel(f"published, {panel.title}", shares, PUBLISHED))
            whole += row
        return [*whole, panels[-1]]

    return published


def _counts(data: PublishedData, scheme: str, label: str) -> np.ndarray:
    """Published answers of the M that a label names, one matrix for each time."""
    at = data.array(_FILE, "M").tolist().index(int(label.rpartition(" ")[2]))
    return data.array(_FILE, "counts")[_MODES[scheme]][at].astype(float)


FIGURES = tuple(
    Figure(
        name,
        f"confusion matrices, {scheme} sampling",
        _measured(scheme),
        _published_means(scheme),
        _with_published(scheme),
        columns=6,
        panel_inch=(2.1, 2.15),
        notes=(
            "Objects by number: here in the order of the alphabet, published in that of the authors. A row here sums "
            "to less than 1 where nothing was felt.",
            "Here each answer is that at this time. The published matrices count all answers since contact, as the "
            "means of the last panel do.",
        ),
    )
    for name, scheme in (("S7-1", "adaptive"), ("S7-2", "uniform"), ("S7-3", "random"))
)
