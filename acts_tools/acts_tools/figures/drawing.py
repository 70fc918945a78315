# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Draws figures, all in one style: colours tell the scheme of sampling, lines tell whose a curve is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

from acts_core.errors import RecordingError
from acts_tools.figures.figure import Figure
from acts_tools.figures.sheet import OTHERS, OURS, PUBLISHED, SAME, TRUTH, Curve, Panel

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.colors import LogNorm, Normalize

_STYLE = {
    "font.size": 8,
    "axes.titlesize": 9,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "legend.fontsize": 6.5,
    "legend.framealpha": 0.7,
    "image.cmap": "viridis",
}
_COLOURS = {
    "adaptive": "tab:blue",
    "uniform": "tab:orange",
    "random": "tab:green",
    "raster": "tab:gray",
    "tracking": "tab:red",
    "hybrid": "tab:purple",
    "truth": "black",
}
_OTHERS = ("tab:purple", "tab:brown", "tab:pink", "tab:olive", "tab:cyan", "tab:blue", "tab:orange", "tab:green")
_LINES: dict[str, dict[str, Any]] = {
    PUBLISHED: {"linestyle": ":", "linewidth": 1.3},
    SAME: {"linestyle": "-", "linewidth": 1.0, "marker": "o", "markersize": 2.5},
    OURS: {"linestyle": "-", "linewidth": 2.0, "marker": "s", "markersize": 3.0},
    TRUTH: {"linestyle": "--", "linewidth": 1.0},
    OTHERS: {"linestyle": "-.", "linewidth": 1.0},
}
_MARKERS_MAX = 40
"""A line of more points has no markers."""

_BESIDE = 8
"""With more curves, the legend stands beside the diagram."""

_WIDTH, _HEIGHT, _BESIDE_WIDTH = 3.4, 2.9, 1.4
_DPI = 100


def draw(path: Path, figure: Figure, panels: Sequence[Panel], command: str, notes: Sequence[str]) -> None:
    """Draw a figure to a PNG file, with the command that makes it again.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    columns = min(figure.columns, len(panels))
    rows = math.ceil(len(panels) / columns)
    with mpl.rc_context(_STYLE):
        beside = _BESIDE_WIDTH * any(len(panel.curves) > _BESIDE for panel in panels)
        size = (max((_WIDTH + beside) * columns, 5.0), _HEIGHT * rows + 0.45 + 0.14 * len(notes))
        picture, grid = plt.subplots(rows, columns, figsize=size, squeeze=False, layout="constrained")
        for axes, panel in zip(grid.ravel(), panels, strict=False):
            _draw_panel(axes, panel)
        for axes in grid.ravel()[len(panels) :]:
            axes.set_visible(False)
        picture.suptitle(f"Fig. {figure.name}: {figure.title}", fontsize=10)
        picture.supxlabel("\n".join([*notes, command]), fontsize=6, color="0.35")
        try:
            picture.savefig(path, dpi=_DPI, metadata={"Title": f"Fig. {figure.name}", "Description": command})
        except OSError as error:
            raise RecordingError(f"{path}: cannot be written ({error.strerror})") from error
        finally:
            plt.close(picture)


def _draw_panel(axes: Any, panel: Panel) -> None:
    axes.set_title(panel.title)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    if panel.picture is not None:
        _draw_picture(axes, panel)
    if panel.contours is not None:
        lines = axes.contour(
            panel.contours.x,
            panel.contours.y,
            np.array(panel.contours.values),
            levels=panel.contours.levels,
            colors="white" if panel.picture is not None else "black",
            linewidths=0.8,
        )
        axes.clabel(lines, fontsize=6)
    others = iter(_OTHERS * len(panel.curves))
    for curve in panel.curves:
        _draw_curve(axes, curve, _COLOURS.get(curve.scheme) or (curve.scheme or next(others)))
    if panel.log_x:
        _scale_m(axes, panel)
    if panel.log_y:
        axes.set_yscale("log")
    if panel.equal:
        axes.set_aspect("equal", adjustable="datalim")
    else:
        axes.set_ylim(bottom=panel.y_min, top=panel.y_max)
    labels = sum(bool(curve.label) for curve in panel.curves)
    if labels > _BESIDE:
        axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
    elif labels:
        axes.legend()


def _draw_picture(axes: Any, panel: Panel) -> None:
    picture = panel.picture
    assert picture is not None
    scale = (LogNorm if picture.logarithmic else Normalize)(picture.lowest, picture.highest)
    shown = axes.imshow(
        np.array(picture.values),
        extent=(picture.left, picture.right, picture.bottom, picture.top),
        norm=scale,
        aspect="auto" if panel.x_label else "equal",
        interpolation="nearest",
    )
    axes.grid(visible=False)
    if not panel.x_label:
        axes.set_xticks([])
        axes.set_yticks([])
    if picture.unit:
        axes.figure.colorbar(shown, ax=axes, shrink=0.85, label=picture.unit)


def _draw_curve(axes: Any, curve: Curve, colour: str) -> None:
    line = dict(_LINES[curve.by])
    if len(curve.x) > _MARKERS_MAX:
        line.pop("marker", None)
    if curve.points:
        line |= {"linestyle": "none", "marker": "x" if curve.by == PUBLISHED else "o", "markersize": 3.5}
    axes.plot(curve.x, curve.y, color=colour, label=curve.label or None, **line)
    if curve.low:
        axes.fill_between(curve.x, curve.low, curve.high, color=colour, alpha=0.15, linewidth=0)


def _scale_m(axes: Any, panel: Panel) -> None:
    """A logarithmic axis of M with its own numbers, as many as there is room for."""
    axes.set_xscale("log", base=2)
    numbers = sorted({x for curve in panel.curves if curve.by != PUBLISHED for x in curve.x})
    shown: list[float] = []
    for number in numbers:
        if not shown or number >= 1.25 * shown[-1]:
            shown.append(number)
    axes.set_xticks(shown, [f"{number:g}" for number in shown], fontsize=6.5)
    if numbers:
        axes.set_xlim(numbers[0] / 1.1, numbers[-1] * 1.1)
    axes.minorticks_off()
