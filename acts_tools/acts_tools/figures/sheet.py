# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a figure shows: panels of curves and images, as plain numbers that are drawn, and written as JSON and CSV."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from typing import Any

from acts_core.errors import RecordingError

PUBLISHED, SAME, OURS, TRUTH, OTHERS = "published", "paper's method here", "ours", "truth", "other work"
"""Whose a curve is: read from the paper, of the paper's method on our data, of our method, known exactly, cited."""


@dataclass(frozen=True)
class Curve:
    """A curve.

    Attributes
    ----------
    label : str
    x, y : list of float
    by : str
        `PUBLISHED`, `SAME`, `OURS`, `TRUTH` or `OTHERS`; sets the style of the line.
    scheme : str
        Scheme of sampling, or a colour of matplotlib such as "C0"; empty, or a scheme without a colour of its own
        (`drawing/style.py`), for the next colour.
    low, high : list of float
        Interval of each y; empty for none.
    points : bool
        Points only, without a line.
    beside : str
        Of a published curve, the label of the curve in the same panel that it is compared with; empty for none.
    at : float or None
        Value of a scale that the panel names, as a time: sets the colour, and the height in a solid.
    """

    label: str
    x: list[float]
    y: list[float]
    by: str = OURS
    scheme: str = ""
    low: list[float] = field(default_factory=list)
    high: list[float] = field(default_factory=list)
    points: bool = False
    beside: str = ""
    at: float | None = None


@dataclass(frozen=True)
class Picture:
    """An image.

    Attributes
    ----------
    values : list of list of float
        Rows from top to bottom.
    unit : str
        Of the values; empty for no colour bar.
    left, right, bottom, top : float
        Of the image's edges on the axes.
    logarithmic : bool
        Scale of the colours.
    lowest, highest : float or None
        Values of the ends of the colour scale; None for those of the image.
    """

    values: list[list[float]]
    unit: str = ""
    left: float = 0.0
    right: float = 32.0
    bottom: float = 32.0
    top: float = 0.0
    logarithmic: bool = False
    lowest: float | None = None
    highest: float | None = None


@dataclass(frozen=True)
class Contours:
    """Lines of equal value on a grid, drawn over a picture or alone.

    Attributes
    ----------
    x, y : list of float
        Of the grid's columns and rows.
    values : list of list of float
        One row for each y.
    levels : list of float
    """

    x: list[float]
    y: list[float]
    values: list[list[float]]
    levels: list[float]


@dataclass(frozen=True)
class Panel:
    """One diagram of a figure.

    Attributes
    ----------
    title : str
        Different from those of the figure's other panels.
    x_label, y_label : str
        Empty on an image without axes.
    curves : list of Curve
    picture : Picture or None
    contours : Contours or None
    log_x, log_y : bool
    y_min, y_max : float or None
    by : str
        `PUBLISHED` if all of it is; else empty.
    equal : bool
        The same length for a unit on both axes.
    x_min, x_max : float or None
    x_names : list of str
        What stands at 1, 2, ... of the x axis; empty for numbers.
    at_label : str
        What `at` of the curves is; empty where they have none.
    solid : bool
        Closed curves above one another, at the heights `at`, with the surface through them.
    """

    title: str
    x_label: str = ""
    y_label: str = ""
    curves: list[Curve] = field(default_factory=list)
    picture: Picture | None = None
    contours: Contours | None = None
    log_x: bool = False
    log_y: bool = False
    y_min: float | None = None
    y_max: float | None = None
    by: str = ""
    equal: bool = False
    x_min: float | None = None
    x_max: float | None = None
    x_names: list[str] = field(default_factory=list)
    at_label: str = ""
    solid: bool = False

    def without_published(self) -> Panel:
        """The same panel without published curves."""
        return replace(self, curves=[curve for curve in self.curves if curve.by != PUBLISHED])


def with_curves(panels: Sequence[Panel], more: dict[str, list[Curve]]) -> list[Panel]:
    """The panels with further curves, which are drawn first and so lie below.

    Raises
    ------
    RecordingError
        When there is no panel of a title.
    """
    titles = [panel.title for panel in panels]
    for title in more:
        if title not in titles:
            raise RecordingError(f"published curves for a panel {title!r}; the panels are {titles}")
    return [replace(panel, curves=[*more.get(panel.title, []), *panel.curves]) for panel in panels]


def to_json(panels: Sequence[Panel]) -> list[dict[str, Any]]:
    """Panels as plain numbers; what is empty is left out where that is its default."""
    return [_filled(asdict(panel)) for panel in panels]


def from_json(entries: Sequence[dict[str, Any]]) -> list[Panel]:
    """Panels from the plain numbers of `to_json`."""
    return [
        Panel(
            **{
                **entry,
                "curves": [Curve(**{"label": "", **curve}) for curve in entry.get("curves", [])],
                "picture": Picture(**entry["picture"]) if "picture" in entry else None,
                "contours": Contours(**entry["contours"]) if "contours" in entry else None,
            }
        )
        for entry in entries
    ]


# What has no default.
_NEEDED = ("title", "label", "x", "y", "values", "levels")


def _filled(entry: dict[str, Any]) -> dict[str, Any]:
    kept: dict[str, Any] = {}
    for name, value in entry.items():
        if name == "curves":
            kept[name] = [_filled(curve) for curve in value]
        elif isinstance(value, dict):
            kept[name] = _filled(value)
        elif name in _NEEDED or not (value is None or value is False or value in ("", [])):
            kept[name] = value
    return kept


Row = tuple[str, str, str, float, float, float | None, float | None]
"""Of the CSV file: panel, curve, whose, x, y, low, high; of an image panel, row, "picture", column, value."""

_PIXELS_MAX = 10_000
"""An image of more pixels is not written to the CSV file, where each takes a line."""


def rows(panels: Sequence[Panel]) -> list[Row]:
    """All numbers as rows of the CSV file."""
    return [row for panel in panels for part in (_of_curves, _of_picture, _of_contours) for row in part(panel)]


def _of_curves(panel: Panel) -> list[Row]:
    found: list[Row] = []
    for curve in panel.curves:
        nothing = [None] * len(curve.x)
        columns = (curve.x, curve.y, curve.low or nothing, curve.high or nothing)
        found += [(panel.title, curve.label, curve.by, *one) for one in zip(*columns, strict=True)]
    return found


def large_images(panels: Sequence[Panel]) -> dict[str, list[list[float]]]:
    """Images that are too large for the CSV file, by the titles of their panels."""
    return {
        panel.title: panel.picture.values
        for panel in panels
        if panel.picture is not None and len(panel.picture.values) * len(panel.picture.values[0]) > _PIXELS_MAX
    }


def _of_picture(panel: Panel) -> list[Row]:
    values = panel.picture.values if panel.picture is not None else []
    if large_images([panel]):
        return [(panel.title, "in the npz file; columns, rows", "picture", len(values[0]), len(values), None, None)]
    return [
        (panel.title, str(number), "picture", col, value, None, None)
        for number, row in enumerate(values)
        for col, value in enumerate(row)
    ]


def _of_contours(panel: Panel) -> list[Row]:
    lines = panel.contours
    if lines is None:
        return []
    return [
        (panel.title, f"{y:g}", "contours", x, value, None, None)
        for y, row in zip(lines.y, lines.values, strict=True)
        for x, value in zip(lines.x, row, strict=True)
    ]
