# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Colours, lines and markers of curves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.colors import is_color_like
from matplotlib.rcsetup import cycler

from acts_tools.figures.sheet import OTHERS, OURS, PUBLISHED, SAME, TRUTH, Curve, Panel

_SCHEMES = {
    "adaptive": "tab:blue",
    "uniform": "tab:orange",
    "random": "tab:green",
    "raster": "tab:gray",
    "tracking": "tab:red",
    "hybrid": "tab:purple",
    "truth": "black",
}

_CYCLE = (
    "tab:blue",
    "tab:orange",
    "tab:green",
    "tab:purple",
    "tab:brown",
    "tab:pink",
    "tab:olive",
    "tab:cyan",
    "#1a2a6c",
    "#e6b800",
    "#00695c",
    "#c2185b",
)
"""Of curves that belong to no scheme, and C0, C1, ...: as many as a figure needs, none of them that of `tracking`."""

_FREE = tuple(colour for colour in _CYCLE if colour not in _SCHEMES.values())
"""Of curves of a scheme that has no colour of its own: no other scheme's."""

_MARKERS = "os^Dv<>PXph*"

STYLE: dict[str, Any] = {
    "font.size": 8,
    "axes.grid": True,
    "axes.prop_cycle": cycler(color=_CYCLE),
    "grid.alpha": 0.25,
    "legend.fontsize": 6.5,
    "image.cmap": "viridis",
}

# A thinner line lies above a thicker one, so that both are seen where they are the same.
_LINES: dict[str, dict[str, Any]] = {
    OURS: {"linestyle": "-", "linewidth": 2.0, "marker": "s", "markersize": 3.0, "zorder": 2.0},
    SAME: {"linestyle": "-", "linewidth": 1.0, "marker": "o", "markersize": 2.5, "zorder": 2.1},
    OTHERS: {"linestyle": "-.", "linewidth": 1.0, "zorder": 2.2},
    PUBLISHED: {"linestyle": ":", "linewidth": 1.3, "zorder": 2.3},
    TRUTH: {"linestyle": "--", "linewidth": 1.0, "zorder": 2.4},
}
_POINTS: dict[str, dict[str, Any]] = {
    OURS: {"marker": "s", "markersize": 3.0, "zorder": 2.2},
    SAME: {"marker": "o", "markersize": 4.5, "zorder": 2.1},
    OTHERS: {"markersize": 5.0},
    PUBLISHED: {"marker": "x", "markersize": 4.0, "zorder": 2.3},
    TRUTH: {"marker": "D", "markersize": 4.0, "zorder": 2.0},
}
_MARKED_MAX = 40
"""A line of more points has no markers."""


def _own_colour(curve: Curve) -> str:
    """That of its scheme, or the colour that it gives; empty for a scheme that has none, as one that was added."""
    given = _SCHEMES.get(curve.scheme, curve.scheme)
    return given if is_color_like(given) else ""


class Looks:
    """How each curve of a figure looks; curves of one label look alike in all panels.

    Parameters
    ----------
    panels : sequence of Panel
    """

    def __init__(self, panels: Sequence[Panel]) -> None:
        self._numbers: dict[str, int] = {}
        for panel in panels:
            for curve in panel.curves:
                if not _own_colour(curve) and not curve.beside:
                    self._numbers.setdefault(curve.label, len(self._numbers))

    def colour(self, curve: Curve, panel: Panel) -> str:
        """Of its scheme, of the curve that it is compared with, or the next of the cycle."""
        own = _own_colour(curve)
        if own:
            return own
        for other in panel.curves:
            if curve.beside and other.label == curve.beside:
                return self.colour(other, panel)
        cycle = _FREE if curve.scheme else _CYCLE
        return cycle[self._numbers.get(curve.label, 0) % len(cycle)]

    def line(self, curve: Curve) -> dict[str, Any]:
        """Settings of its line, without the colour."""
        if curve.points:
            marker = _MARKERS[self._numbers.get(curve.label, 0) % len(_MARKERS)]
            return {"marker": marker, **_POINTS[curve.by], "linestyle": "none"}
        line = dict(_LINES[curve.by])
        if len(curve.x) > _MARKED_MAX or curve.at is not None:
            line.pop("marker", None)
        return line
