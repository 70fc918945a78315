# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One panel of a figure: its curves, and its axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.colors import Normalize

from acts_tools.figures.drawing.images import draw_contours, draw_image
from acts_tools.figures.drawing.over_time import colour_at, draw_solid
from acts_tools.figures.drawing.style import Looks
from acts_tools.figures.sheet import PUBLISHED, Curve, Panel

_ROOM = 0.03

_M_NUMBERS = 9
"""On a logarithmic axis there is room for about as many."""


def draw_panel(axes: Any, panel: Panel, looks: Looks, times: Normalize) -> None:
    """Draw a panel, without legend and colour scale."""
    axes.set_title(panel.title)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    if panel.solid:
        draw_solid(axes, panel, times)
        _bound(axes, panel)
        return
    if panel.picture is not None:
        draw_image(axes, panel, panel.picture)
    if panel.contours is not None:
        draw_contours(axes, panel.contours, over_image=panel.picture is not None)
    for curve in panel.curves:
        _draw_curve(axes, curve, panel, looks, times)
    if panel.log_x:
        _scale_m(axes, panel)
    if panel.log_y:
        axes.set_yscale("log")
    if panel.x_names:
        axes.set_xticks(range(1, len(panel.x_names) + 1), panel.x_names)
    elif not panel.log_x and _are_counted(panel.curves):
        axes.xaxis.get_major_locator().set_params(integer=True, min_n_ticks=1)
    if panel.picture is None:
        if panel.equal:
            _bound(axes, panel)
            # With limits of its own a panel is as large as these allow.
            axes.set_aspect("equal", adjustable="datalim" if panel.x_min is None else "box")
        else:
            _limit_y(axes, panel)
            axes.set_xlim(left=panel.x_min, right=panel.x_max)


def _bound(axes: Any, panel: Panel) -> None:
    """The limits of a panel in the plane; where it has none, as what is drawn needs."""
    if panel.x_min is not None or panel.x_max is not None:
        axes.set_xlim(left=panel.x_min, right=panel.x_max)
    if panel.y_min is not None or panel.y_max is not None:
        axes.set_ylim(bottom=panel.y_min, top=panel.y_max)


def _draw_curve(axes: Any, curve: Curve, panel: Panel, looks: Looks, times: Normalize) -> None:
    colour = looks.colour(curve, panel) if curve.at is None else colour_at(curve.at, times)
    axes.plot(curve.x, curve.y, color=colour, label=curve.label or None, **looks.line(curve))
    if curve.low:
        axes.fill_between(curve.x, curve.low, curve.high, color=colour, alpha=0.15, linewidth=0)


def _are_counted(curves: Sequence[Curve]) -> bool:
    """Whether all are points at whole numbers, such as those of runs."""
    return bool(curves) and all(curve.points and all(x == round(x) for x in curve.x) for curve in curves)


def _limit_y(axes: Any, panel: Panel) -> None:
    """The limits of the panel, with room for markers that lie on them."""
    bottom, top = axes.get_ylim()
    bottom = bottom if panel.y_min is None else panel.y_min
    top = top if panel.y_max is None else panel.y_max
    room = 0.0 if panel.log_y else _ROOM * (top - bottom)
    axes.set_ylim(bottom - room * (panel.y_min is not None), top + room * (panel.y_max is None))


def _scale_m(axes: Any, panel: Panel) -> None:
    """A logarithmic axis of M with its own numbers, as many as there is room for."""
    axes.set_xscale("log", base=2)
    numbers = sorted({x for curve in panel.curves if curve.by != PUBLISHED for x in curve.x})
    if numbers:
        apart = max(1.25, (numbers[-1] / numbers[0]) ** (1 / _M_NUMBERS))
        shown = numbers[:1]
        for number in numbers:
            if number >= apart * shown[-1]:
                shown.append(number)
        axes.set_xticks(shown, [f"{number:g}" for number in shown], fontsize=6.5)
        axes.set_xlim(numbers[0] / 1.1, numbers[-1] * 1.1)
    axes.minorticks_off()
