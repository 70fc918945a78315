# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Legends beside the diagrams, never on them, because a curve may be anywhere."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.colorbar import make_axes

from acts_tools.figures.drawing.style import Looks
from acts_tools.figures.sheet import Panel

_NARROW = 1e-3


def named(panel: Panel) -> bool:
    """Whether something in it needs a legend; what a colour scale tells does not."""
    return any(curve.label and curve.at is None for curve in panel.curves)


def draw_legends(figure: Any, axes: Sequence[Any], panels: Sequence[Panel], looks: Looks, free: Any) -> None:
    """Draw one legend for the figure; one for each panel where a label has two meanings.

    Parameters
    ----------
    figure : matplotlib figure
        Becomes wider by the legends that are beside it.
    axes : sequence of matplotlib axes
        One for each panel.
    panels : sequence of Panel
    looks : Looks
    free : matplotlib axes or None
        A place in the grid that no panel needs.
    """
    entries = [_entries(axis) if named(panel) else {} for axis, panel in zip(axes, panels, strict=True)]
    if _agree(panels, looks):
        union = {label: handle for one in reversed(entries) for label, handle in one.items()}
        # In the order in which they are drawn, each as its first panel has it.
        order = dict.fromkeys(label for one in entries for label in one)
        if not union:
            return
        handles = [union[label] for label in order]
        if free is not None:
            free.set_visible(True)
            free.axis("off")
            free.legend(handles, list(order), loc="center")
        else:
            # For a scale, the layout makes room beside diagrams; for a legend only from matplotlib 3.7 on.
            place, _ = make_axes(_of_the_last_column(axes), location="right", fraction=_NARROW)
            place.axis("off")
            legend = place.legend(handles, list(order), loc="center")
            _widen(figure, _width_inch(figure, legend))
        return
    widths = []
    for axis, one in zip(axes, entries, strict=True):
        if one:
            legend = axis.legend(one.values(), one.keys(), loc="center left", bbox_to_anchor=(1.01, 0.5))
            widths.append(_width_inch(figure, legend))
    columns = axes[0].get_gridspec().ncols
    _widen(figure, columns * max(widths, default=0.0))


def _of_the_last_column(axes: Sequence[Any]) -> list[Any]:
    """Those that have no diagram to their right. Beside others may be a scale, which is then not covered."""
    stops = [axis.get_subplotspec().colspan.stop for axis in axes]
    return [axis for axis, stop in zip(axes, stops, strict=True) if stop == max(stops)]


def _entries(axes: Any) -> dict[str, Any]:
    handles, labels = axes.get_legend_handles_labels()
    return dict(zip(labels, handles, strict=True))


def _agree(panels: Sequence[Panel], looks: Looks) -> bool:
    """Whether each label has one colour and one owner in all panels."""
    meanings: dict[str, tuple[str, str]] = {}
    for panel in panels:
        for curve in panel.curves:
            if curve.label and curve.at is None:
                meaning = (looks.colour(curve, panel), curve.by)
                if meanings.setdefault(curve.label, meaning) != meaning:
                    return False
    return True


def _width_inch(figure: Any, legend: Any) -> float:
    return float(legend.get_window_extent(figure.canvas.get_renderer()).width / figure.dpi)


def _widen(figure: Any, more_inch: float) -> None:
    width, height = figure.get_size_inches()
    figure.set_size_inches(width + more_inch, height)
