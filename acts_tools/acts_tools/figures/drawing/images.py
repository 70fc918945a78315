# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images, their colour scales, and lines of equal value."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib import patheffects
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter

from acts_tools.figures.sheet import Contours, Panel, Picture

_BAR_INCH = 3.0

_HEIGHTS = (0.2, 0.5, 0.8, 0.35, 0.65)
"""Where along neighbouring lines their numbers stand, so that they do not collide."""


def draw_image(axes: Any, panel: Panel, picture: Picture) -> None:
    """Draw the image of a panel."""
    axes.imshow(
        np.array(picture.values),
        extent=(picture.left, picture.right, picture.bottom, picture.top),
        norm=_scale(picture),
        aspect="equal" if panel.equal or not panel.x_label else "auto",
        interpolation="nearest",
    )
    axes.grid(visible=False)
    if not panel.x_label:
        axes.set_xticks([])
        axes.set_yticks([])


def draw_scales(figure: Any, axes: Sequence[Any], panels: Sequence[Panel]) -> None:
    """Draw the scales of all images: one for all where it is the same, otherwise one beside each."""
    images = [(axis, panel.picture) for axis, panel in zip(axes, panels, strict=True) if panel.picture is not None]
    scales = {(one.unit, one.lowest, one.highest, one.logarithmic) for _, one in images}
    if len(scales) == 1 and images[0][1].lowest is not None and images[0][1].highest is not None:
        _bar(figure, [axis for axis, _ in images], images[0][1])
    else:
        for axis, picture in images:
            _bar(figure, [axis], picture)


def draw_contours(axes: Any, contours: Contours, *, over_image: bool) -> None:
    """Draw lines of equal value with their numbers."""
    colour, around = ("white", "black") if over_image else ("black", "white")
    values = np.array(contours.values)
    lines = axes.contour(contours.x, contours.y, values, levels=contours.levels, colors=colour, linewidths=0.9)
    lowest, highest = min(contours.y), max(contours.y)
    places = []
    for number, segments in enumerate(lines.allsegs):
        if segments:
            longest = max(segments, key=len)
            at = lowest + _HEIGHTS[number % len(_HEIGHTS)] * (highest - lowest)
            places.append(tuple(_on(longest, at)))
    texts = axes.clabel(lines, fontsize=6.5, manual=places)
    for text in texts or lines.labelTexts:
        text.set_rotation(0.0)
        text.set_path_effects([patheffects.withStroke(linewidth=1.5, foreground=around)])


def _on(points: Any, y: float) -> Any:
    """The point of a line at a height; its middle where it does not come there."""
    below = points[:, 1] <= y
    crossing = np.flatnonzero(below[1:] != below[:-1])
    if not crossing.size:
        return points[len(points) // 2]
    first, second = points[crossing[0]], points[crossing[0] + 1]
    return first + (second - first) * (y - first[1]) / (second[1] - first[1])


def _scale(picture: Picture) -> Normalize:
    return (LogNorm if picture.logarithmic else Normalize)(picture.lowest, picture.highest)


def bar_share(figure: Any, axes: Sequence[Any]) -> float:
    """Length of a scale beside some panels, as a share of theirs: as long as a panel is high, about."""
    places = [axis.get_subplotspec() for axis in axes]
    spanned = max(place.rowspan.stop for place in places) - min(place.rowspan.start for place in places)
    return min(0.85, _BAR_INCH * places[0].get_gridspec().nrows / (figure.get_figheight() * spanned))


def _bar(figure: Any, axes: list[Any], picture: Picture) -> None:
    if not picture.unit:
        return
    scale = _scale(picture)
    scale.autoscale_None(np.array(picture.values))
    bar = figure.colorbar(ScalarMappable(scale), ax=axes, shrink=bar_share(figure, axes), label=picture.unit)
    if picture.logarithmic:
        decades = np.log10((scale.vmax or 1.0) / (scale.vmin or 1.0))
        bar.ax.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if decades < 3.0 else (1.0,)))
        bar.ax.yaxis.set_minor_locator(NullLocator())
        bar.ax.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
