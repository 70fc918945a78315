# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Strokes that a letter is drawn with, in arc length: lines and elliptic arcs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import cos, hypot, pi, sin
from typing import NamedTuple, Protocol

import numpy as np

from acts_core.errors import SettingsError

Point = tuple[float, float]

# Of the width of a letter.
_BOW_WIDTH = 0.65


class PathPoint(NamedTuple):
    """A point of a path [m], its unit tangent, and the curvature vector d2r/ds2 [1/m]."""

    x_m: float
    y_m: float
    tangent_x: float
    tangent_y: float
    curvature_x: float
    curvature_y: float


class Stroke(Protocol):
    """A smooth path without corners."""

    @property
    def length_m(self) -> float:
        """Arc length [m]; 0 for a stroke that stays where it is."""

    def at(self, s_m: float) -> PathPoint:
        """The point at an arc length, 0 to `length_m` [m]."""


@dataclass(frozen=True)
class Line:
    """Straight from one point to another [m]."""

    start: Point
    end: Point

    @property
    def length_m(self) -> float:
        """Arc length [m]."""
        return hypot(self.end[0] - self.start[0], self.end[1] - self.start[1])

    def at(self, s_m: float) -> PathPoint:
        """The point at an arc length [m]."""
        length = self.length_m
        if length == 0.0:
            return PathPoint(*self.start, 0.0, 0.0, 0.0, 0.0)
        tx, ty = (self.end[0] - self.start[0]) / length, (self.end[1] - self.start[1]) / length
        return PathPoint(self.start[0] + s_m * tx, self.start[1] + s_m * ty, tx, ty, 0.0, 0.0)


class Arc:
    """Part of an ellipse whose axes lie along x and y.

    Parameters
    ----------
    centre : (float, float)
        [m]
    half_width_m, half_height_m : float
        Half axes along x and y [m].
    start_rad, end_rad : float
        Angle of the parametrisation (cos, sin); it falls where the arc runs clockwise.
    """

    _POINTS = 2001

    def __init__(
        self, centre: Point, half_width_m: float, half_height_m: float, start_rad: float, end_rad: float
    ) -> None:
        if half_width_m <= 0.0 or half_height_m <= 0.0 or start_rad == end_rad:
            raise SettingsError("an arc needs two half axes above 0 and two different angles")
        self._centre = centre
        self._a, self._b = half_width_m, half_height_m
        self._direction = 1.0 if end_rad > start_rad else -1.0
        # Arc length by the midpoint rule; between the nodes it is next to linear in the angle.
        angles = np.linspace(start_rad, end_rad, self._POINTS)
        middles = 0.5 * (angles[1:] + angles[:-1])
        pieces = np.hypot(self._a * np.sin(middles), self._b * np.cos(middles)) * np.abs(np.diff(angles))
        self._angles, self._lengths = angles, np.concatenate([[0.0], np.cumsum(pieces)])

    @property
    def length_m(self) -> float:
        """Arc length [m]."""
        return float(self._lengths[-1])

    def at(self, s_m: float) -> PathPoint:
        """The point at an arc length [m]."""
        angle = float(np.interp(s_m, self._lengths, self._angles))
        c, s = cos(angle), sin(angle)
        dx, dy = -self._a * s, self._b * c
        rate = hypot(dx, dy)
        tx, ty = self._direction * dx / rate, self._direction * dy / rate
        # Curvature a b / rate^3, towards the inside: to the left of the tangent where the angle grows.
        bend = self._direction * self._a * self._b / rate**3
        return PathPoint(self._centre[0] + self._a * c, self._centre[1] + self._b * s, tx, ty, -bend * ty, bend * tx)


def circle(radius_m: float) -> list[Stroke]:
    """Once round the centre, against the clock, from the point on the x axis."""
    return [Arc((0.0, 0.0), radius_m, radius_m, 0.0, 2.0 * pi)]


def letter(name: str, height_m: float, width_m: float) -> list[Stroke]:
    """Strokes of N, B or I, centred on the origin; the ball rests at the end of each.

    Parameters
    ----------
    name : str
        "N", "B" or "I".
    height_m, width_m : float
        Of the letter [m]; I has no width.

    Raises
    ------
    SettingsError
        For another letter.
    """
    right, top = width_m / 2, height_m / 2
    if name == "N":
        return _lines([(-right, -top), (-right, top), (right, -top), (right, top)])
    if name == "I":
        return _lines([(0.0, -top), (0.0, top)])
    if name == "B":
        # Two half ellipses; as wide as N their tips would be too sharp for a ball to take at speed.
        bow, reach = height_m / 4, _BOW_WIDTH * width_m
        stem = -reach / 2
        return [
            *_lines([(stem, -top), (stem, top)]),
            Arc((stem, bow), reach, bow, pi / 2, -pi / 2),
            Arc((stem, -bow), reach, bow, pi / 2, -pi / 2),
        ]
    raise SettingsError(f"letter {name!r}: there are N, B and I")


def _lines(points: Sequence[Point]) -> list[Stroke]:
    return [Line(start, end) for start, end in pairwise(points)]
