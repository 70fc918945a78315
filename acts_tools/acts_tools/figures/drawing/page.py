# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A figure as a PNG file: its panels in a grid, legends and scales beside them, notes and the command below."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl

from acts_tools.figures.drawing.diagrams import draw_panel
from acts_tools.figures.drawing.images import draw_scales
from acts_tools.figures.drawing.legends import draw_legends
from acts_tools.figures.drawing.over_time import draw_time_scale, scale_of
from acts_tools.figures.drawing.style import STYLE, Looks
from acts_tools.figures.figure import Figure
from acts_tools.figures.sheet import Panel
from acts_tools.output_file import save_picture

mpl.use("Agg")
from matplotlib import pyplot as plt

_DPI = 100
_NARROWEST_INCH = 4.2
_LETTERS_AN_INCH = 19
"""Of the notes."""

_TITLE_SIZE, _TITLE_SIZE_NARROW, _NARROW_INCH = 9.0, 8.0, 2.5
"""Of the titles of panels; there are smaller ones below this width."""

_TITLE_INCH, _NOTE_INCH, _SCALE_INCH = 0.45, 0.12, 0.6


def draw(path: Path, figure: Figure, panels: Sequence[Panel], command: str, notes: Sequence[str]) -> None:
    """Draw a figure to a PNG file, with the command that makes it again.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    columns = min(figure.columns, len(panels))
    rows = math.ceil(len(panels) / columns)
    width, height = (size * count for size, count in zip(figure.panel_inch, (columns, rows), strict=True))
    width = max(width, _NARROWEST_INCH) + _SCALE_INCH * any(panel.picture or panel.at_label for panel in panels)
    title_size = _TITLE_SIZE if figure.panel_inch[0] > _NARROW_INCH else _TITLE_SIZE_NARROW
    with mpl.rc_context({**STYLE, "axes.titlesize": title_size}):
        picture = plt.figure(figsize=(width, height + _TITLE_INCH), dpi=_DPI, layout="constrained")
        try:
            _fill(picture, picture.add_gridspec(rows, columns), panels)
            picture.suptitle(f"Fig. {figure.name}: {figure.title}", fontsize=10)
            # The width is known only now, with the legends.
            width, height = picture.get_size_inches()
            lines = [line for note in notes for line in textwrap.wrap(note, int(width * _LETTERS_AN_INCH))]
            picture.set_size_inches(width, height + _NOTE_INCH * (1 + len(lines)))
            picture.supxlabel("\n".join([*lines, command]), fontsize=6, color="0.35")
            save_picture(picture, path, metadata={"Title": f"Fig. {figure.name}", "Description": command})
        finally:
            plt.close(picture)


def _fill(picture: Any, grid: Any, panels: Sequence[Panel]) -> None:
    looks, times = Looks(panels), scale_of(panels)
    axes = []
    for number, panel in enumerate(panels):
        place = grid[number // grid.ncols, number % grid.ncols]
        axes.append(picture.add_subplot(place, projection="3d" if panel.solid else None))
        draw_panel(axes[-1], panel, looks, times)
    _leave_out_repeated(axes, panels, grid.ncols)
    draw_scales(picture, axes, panels)
    draw_time_scale(picture, axes, panels, times)
    free = None
    if len(panels) < grid.nrows * grid.ncols:
        free = picture.add_subplot(grid[-1, len(panels) % grid.ncols])
        free.set_visible(False)
    draw_legends(picture, axes, panels, looks, free)


def _leave_out_repeated(axes: Sequence[Any], panels: Sequence[Panel], columns: int) -> None:
    """Images of the same size side by side have the numbers of their axes once, at the left and below."""
    for number, (axis, panel) in enumerate(zip(axes, panels, strict=True)):
        below, left = number + columns, number - 1
        if below < len(panels) and _same_size(panel, panels[below]):
            axis.set_xlabel("")
            axis.tick_params(labelbottom=False)
        if number % columns and _same_size(panel, panels[left]):
            axis.set_ylabel("")
            axis.tick_params(labelleft=False)


def _same_size(panel: Panel, other: Panel) -> bool:
    one, two = panel.picture, other.picture
    if one is None or two is None:
        return False
    edges = [(it.left, it.right, it.bottom, it.top) for it in (one, two)]
    return edges[0] == edges[1] and (panel.x_label, panel.y_label) == (other.x_label, other.y_label)
