"""Objects to press into the skin: a register of small functions, each the underside of one object.

An object is described by its gap: how far each point of its underside lies above its lowest point, in the object's own
frame (origin at its middle, z up). The shapes are our own, modelled on the paper's list (8 printed shapes, "2
cylinders" to "X"; things of daily use, Fig. S13). To add one, write a function of x and y and register it::

    @register("coin", "daily", depth_m=(0.0003, 0.0015))
    def _coin(x: Field, y: Field) -> Field:
        return prism(disc(x, y, 0.012))
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError

Field = NDArray[np.float64]
"""One number for every point of a grid."""

_EDGE_SLOPE = 4.0
"""Rise over run of the rounded edge of a printed or cut shape."""


@dataclass(frozen=True)
class ContactObject:
    """One object.

    Attributes
    ----------
    name : str
    group : str
        "printed" or "daily".
    depth_m : tuple of float
        Least and greatest depth that it is usually pressed in [m].
    gap_m : callable
        ``gap_m(x_m, y_m)``: height of the underside above its lowest point [m]; same shape as the arguments.
    """

    name: str
    group: str
    depth_m: tuple[float, float]
    gap_m: Callable[[Field, Field], Field]


OBJECTS: dict[str, ContactObject] = {}
"""Every object by its name, in order of definition."""


def register(
    name: str, group: str, *, depth_m: tuple[float, float] = (0.0004, 0.0022)
) -> Callable[[Callable[[Field, Field], Field]], Callable[[Field, Field], Field]]:
    """Enter the decorated gap function into `OBJECTS`.

    Raises
    ------
    SettingsError
        When there is an object of this name already.
    """

    def enter(gap_m: Callable[[Field, Field], Field]) -> Callable[[Field, Field], Field]:
        if name in OBJECTS:
            raise SettingsError(f"object {name!r} is registered twice; choose another name")
        OBJECTS[name] = ContactObject(name, group, depth_m, gap_m)
        return gap_m

    return enter


def object_named(name: str) -> ContactObject:
    """Look an object up.

    Raises
    ------
    SettingsError
        Naming those that exist.
    """
    try:
        return OBJECTS[name]
    except KeyError:
        raise SettingsError(f"object {name!r} does not exist; known are {', '.join(OBJECTS)}") from None


# Signed distances from the edge of flat outlines [m], negative inside.


def disc(x: Field, y: Field, radius: float) -> Field:
    """Disc around the origin."""
    return np.hypot(x, y) - radius


def box(x: Field, y: Field, width: float, height: float) -> Field:
    """Rectangle around the origin."""
    dx, dy = np.abs(x) - width / 2, np.abs(y) - height / 2
    return np.hypot(np.maximum(dx, 0), np.maximum(dy, 0)) + np.minimum(np.maximum(dx, dy), 0)


def ring(x: Field, y: Field, radius: float, width: float) -> Field:
    """Ring around the origin; `radius` to the middle of its band."""
    return np.abs(np.hypot(x, y) - radius) - width / 2


def convex_polygon(x: Field, y: Field, corners: int, radius: float) -> Field:
    """Regular polygon around the origin; `radius` to its corners, the first of them at the top."""
    angles = np.pi / 2 + np.pi / corners + 2 * np.pi * np.arange(corners) / corners
    apothem = radius * np.cos(np.pi / corners)
    sides = np.stack([x * np.cos(a) + y * np.sin(a) for a in angles])
    return np.max(sides, axis=0) - apothem


def bar(x: Field, y: Field, length: float, width: float, angle: float = 0.0) -> Field:
    """Bar around the origin, turned by `angle` [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return box(c * x + s * y, -s * x + c * y, length, width)


def union(*distances: Field) -> Field:
    """Everything that is in one of several outlines."""
    return np.minimum.reduce(distances)


def prism(distance: Field) -> Field:
    """Gap of a flat underside with that outline and a steep, rounded edge."""
    return np.maximum(distance, 0.0) * _EDGE_SLOPE


def ellipsoid(x: Field, y: Field, radius_x: float, radius_y: float, radius_z: float) -> Field:
    """Gap of an ellipsoid resting on its lowest point."""
    square = (x / radius_x) ** 2 + (y / radius_y) ** 2
    return radius_z * np.where(square < 1, 1 - np.sqrt(np.maximum(1 - square, 0.0)), 1 + (square - 1))


# The 8 printed shapes.


@register("two_cylinders", "printed")
def _two_cylinders(x: Field, y: Field) -> Field:
    return prism(union(disc(x - 0.018, y, 0.009), disc(x + 0.018, y, 0.009)))


@register("three_lines", "printed")
def _three_lines(x: Field, y: Field) -> Field:
    return prism(union(*(box(x - offset, y, 0.007, 0.060) for offset in (-0.020, 0.0, 0.020))))


@register("diagonal_line", "printed")
def _diagonal_line(x: Field, y: Field) -> Field:
    return prism(bar(x, y, 0.075, 0.008, np.pi / 4))


@register("three_rings", "printed")
def _three_rings(x: Field, y: Field) -> Field:
    return prism(union(*(ring(x, y, radius, 0.006) for radius in (0.006, 0.020, 0.034))))


@register("triangle", "printed")
def _triangle(x: Field, y: Field) -> Field:
    return prism(convex_polygon(x, y, 3, 0.032))


@register("circle", "printed")
def _circle(x: Field, y: Field) -> Field:
    return prism(disc(x, y, 0.022))


@register("square", "printed")
def _square(x: Field, y: Field) -> Field:
    return prism(box(x, y, 0.042, 0.042))


@register("x", "printed")
def _x(x: Field, y: Field) -> Field:
    return prism(union(bar(x, y, 0.065, 0.010, np.pi / 4), bar(x, y, 0.065, 0.010, -np.pi / 4)))


# Things of daily use.


@register("marble", "daily", depth_m=(0.0008, 0.0040))
def _marble(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.008, 0.008, 0.008)


@register("golf_ball", "daily", depth_m=(0.0008, 0.0040))
def _golf_ball(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.0213, 0.0213, 0.0213)


@register("tennis_ball", "daily", depth_m=(0.0008, 0.0040))
def _tennis_ball(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.0335, 0.0335, 0.0335)


@register("egg", "daily", depth_m=(0.0008, 0.0040))
def _egg(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.029, 0.022, 0.022)


@register("spoon", "daily", depth_m=(0.0006, 0.0030))
def _spoon(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.030, 0.020, 0.009)


@register("fingertip", "daily", depth_m=(0.0006, 0.0030))
def _fingertip(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.014, 0.009, 0.007)


@register("pinch", "daily", depth_m=(0.0006, 0.0030))
def _pinch(x: Field, y: Field) -> Field:
    return np.minimum(
        ellipsoid(x - 0.015, y, 0.009, 0.013, 0.007), ellipsoid(x + 0.015, y - 0.006, 0.009, 0.012, 0.007)
    )


@register("pen", "daily", depth_m=(0.0006, 0.0025))
def _pen(x: Field, y: Field) -> Field:
    return np.maximum(ellipsoid(x, y, 1.0, 0.005, 0.005), prism(box(x, y, 0.110, 0.05)))


@register("bottle_side", "daily", depth_m=(0.0006, 0.0030))
def _bottle_side(x: Field, y: Field) -> Field:
    return np.maximum(ellipsoid(x, y, 1.0, 0.033, 0.033), prism(box(x, y, 0.080, 0.2)))


@register("ruler_edge", "daily")
def _ruler_edge(x: Field, y: Field) -> Field:
    return prism(box(x, y, 0.100, 0.003))


@register("wooden_block", "daily")
def _wooden_block(x: Field, y: Field) -> Field:
    return prism(box(x, y, 0.055, 0.024))


@register("hex_nut", "daily")
def _hex_nut(x: Field, y: Field) -> Field:
    return prism(np.maximum(convex_polygon(x, y, 6, 0.019), -disc(x, y, 0.009)))


@register("coin", "daily", depth_m=(0.0003, 0.0015))
def _coin(x: Field, y: Field) -> Field:
    return prism(disc(x, y, 0.012))


@register("cup_rim", "daily")
def _cup_rim(x: Field, y: Field) -> Field:
    return prism(ring(x, y, 0.036, 0.004))


@register("tape_roll", "daily")
def _tape_roll(x: Field, y: Field) -> Field:
    return prism(ring(x, y, 0.026, 0.013))


@register("key", "daily", depth_m=(0.0003, 0.0015))
def _key(x: Field, y: Field) -> Field:
    bow = np.maximum(disc(x + 0.022, y, 0.012), -disc(x + 0.026, y, 0.004))
    return prism(union(bow, box(x - 0.010, y, 0.042, 0.006), box(x - 0.026, y + 0.005, 0.005, 0.006)))


@register("fork", "daily", depth_m=(0.0004, 0.0020))
def _fork(x: Field, y: Field) -> Field:
    tines = [box(x - 0.010, y - offset, 0.040, 0.0025) for offset in (-0.0105, -0.0035, 0.0035, 0.0105)]
    return prism(union(*tines, box(x + 0.016, y, 0.016, 0.024)))


@register("comb", "daily", depth_m=(0.0004, 0.0020))
def _comb(x: Field, y: Field) -> Field:
    return prism(union(*(disc(x - offset, y, 0.0025) for offset in np.linspace(-0.04, 0.04, 9))))


@register("wrench", "daily")
def _wrench(x: Field, y: Field) -> Field:
    jaw = np.maximum(disc(x - 0.034, y, 0.014), -box(x - 0.044, y, 0.020, 0.012))
    return prism(union(jaw, box(x + 0.008, y, 0.065, 0.010)))


@register("sponge", "daily", depth_m=(0.0010, 0.0035))
def _sponge(x: Field, y: Field) -> Field:
    waves = 0.0012 * (2 + np.sin(x / 0.006 + 1.0) * np.cos(y / 0.008) + np.sin(0.7 * x / 0.006 - y / 0.005))
    return np.maximum(waves - waves.min(), prism(box(x, y, 0.070, 0.045)))


@register("stone", "daily", depth_m=(0.0008, 0.0035))
def _stone(x: Field, y: Field) -> Field:
    body = ellipsoid(x, y, 0.028, 0.020, 0.012)
    bumps = 0.0015 * np.sin(x / 0.005) * np.sin(y / 0.0065 + 0.8)
    gap = body + bumps
    return gap - gap.min()


@register("toy_brick", "daily")
def _toy_brick(x: Field, y: Field) -> Field:
    studs = [disc(x - a, y - b, 0.0024) for a in (-0.012, -0.004, 0.004, 0.012) for b in (-0.004, 0.004)]
    return np.minimum(prism(union(*studs)), prism(box(x, y, 0.032, 0.016)) + 0.0017)
