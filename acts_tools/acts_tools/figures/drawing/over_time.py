# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Closed lines that each have a time: in its colour, or above one another as a surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator

from acts_recon.outlines import Outline, surface_of
from acts_tools.figures.drawing.images import bar_share
from acts_tools.figures.sheet import Panel

_COLOURS = "viridis"


def scale_of(panels: Sequence[Panel]) -> Normalize:
    """From the first to the last time of a figure."""
    times = [curve.at for panel in panels for curve in panel.curves if curve.at is not None]
    return Normalize(min(times, default=0.0), max(times, default=1.0))


def colour_at(at: float, scale: Normalize) -> Any:
    """Colour of a time."""
    return colormaps[_COLOURS](scale(at))


def draw_time_scale(figure: Any, axes: Sequence[Any], panels: Sequence[Panel], scale: Normalize) -> None:
    """One scale beside the panels whose curves have times."""
    shown = [axis for axis, panel in zip(axes, panels, strict=True) if panel.at_label]
    if shown:
        label = next(panel.at_label for panel in panels if panel.at_label)
        figure.colorbar(ScalarMappable(scale, _COLOURS), ax=shown, shrink=bar_share(figure, shown), label=label)


def draw_solid(axes: Any, panel: Panel, scale: Normalize) -> None:
    """The closed curves of a panel at the heights of their times, and the surface through them."""
    curves = [curve for curve in panel.curves if curve.at is not None]
    # A surface has no unit of its own: here x and y are those of the panel, and z is the time.
    rings = [
        Outline(number, curve.at or 0.0, np.array(curve.x[:-1]), np.array(curve.y[:-1]))
        for number, curve in enumerate(curves)
    ]
    if len(rings) > 1:
        surface = surface_of(rings, 1.0)
        x, y, z = surface.points_m.T
        axes.plot_trisurf(
            x,
            y,
            z + rings[0].time_s,
            triangles=surface.triangles,
            cmap=_COLOURS,
            norm=scale,
            alpha=0.35,
            linewidth=0,
        )
    for curve in curves:
        axes.plot(curve.x, curve.y, curve.at, color=colour_at(curve.at or 0.0, scale), linewidth=0.8)
    axes.set_zlim(scale.vmin, scale.vmax)
    axes.set_zlabel(panel.at_label, labelpad=-2)
    axes.tick_params(labelsize=6, pad=-2)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4))
    axes.xaxis.labelpad = axes.yaxis.labelpad = -4
    # The label of z is cut off otherwise.
    axes.set_box_aspect(None, zoom=0.85)
