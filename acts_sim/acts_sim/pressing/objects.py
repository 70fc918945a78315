# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects to press into the skin: a registry of small functions, each of the underside of one object.

An object is described by its gap: the height of each point of its underside above its lowest point, in the object's
frame (origin at its centre, z up). The 30 objects are those of the paper's list, in its order (8 printed shapes, "2
cylinders" to "X"; 22 daily objects, "computer mouse" to "tweezers", Fig. S13). The paper names them and shows a
picture; shapes and sizes are those of common objects of these names. To add one, write a function of x and y and
register it::

    @register("coin", "daily", depth_m=(0.0003, 0.0015))
    def _coin(x: Field, y: Field) -> Field:
        return prism(disc(x, y, 0.012))
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from acts_core.registry import named, registering
from acts_sim.pressing.outlines import (
    Field,
    bar,
    box,
    convex_polygon,
    disc,
    ellipsoid,
    lying_cylinder,
    prism,
    ring,
    rounded_box,
    union,
    without,
)


@dataclass(frozen=True)
class ContactObject:
    """One object.

    Attributes
    ----------
    name : str
    group : str
        "printed" or "daily"; "event" for those of fast events only (event_contacts.py).
    depth_m : tuple of float
        Smallest and largest depth of a usual press [m].
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
    """Register the decorated gap function in `OBJECTS`.

    Raises
    ------
    SettingsError
        When there is an object of this name already.
    """
    return registering(name, OBJECTS, "object", lambda gap_m: ContactObject(name, group, depth_m, gap_m))


def object_named(name: str) -> ContactObject:
    """Find an object by its name.

    Raises
    ------
    SettingsError
        When there is none; the message names those that exist.
    """
    return named(name, OBJECTS, "object")


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


# The 22 daily objects.


@register("computer_mouse", "daily", depth_m=(0.0008, 0.0035))
def _computer_mouse(x: Field, y: Field) -> Field:
    """Its back, 110 x 62 mm, and the wheel."""
    wheel = ellipsoid(x - 0.028, y, 0.012, 0.004, 0.010) + 0.0006
    return np.minimum(ellipsoid(x, y, 0.055, 0.031, 0.018), wheel)


@register("art_scissors", "daily")
def _art_scissors(x: Field, y: Field) -> Field:
    """Lying flat, a little open."""
    blades = [bar(x - 0.010, y - 0.010 * slope, 0.082, 0.006, np.arctan(slope)) for slope in (0.22, -0.22)]
    handles = [ring(x + 0.042, y - side * 0.015, 0.0105, 0.005) for side in (1, -1)]
    return prism(union(*blades, *handles))


@register("pliers", "daily")
def _pliers(x: Field, y: Field) -> Field:
    """Lying flat: jaws, joint, handles."""
    jaws = [bar(x - 0.030, y - side * 0.0055, 0.044, 0.006, -side * 0.06) for side in (1, -1)]
    handles = [bar(x + 0.032, y - side * 0.0125, 0.058, 0.010, -side * 0.22) for side in (1, -1)]
    return np.minimum(prism(union(disc(x, y, 0.012), *jaws)), prism(union(*handles)) + 0.0003)


@register("wristwatch", "daily")
def _wristwatch(x: Field, y: Field) -> Field:
    """Its face: a bezel around the glass, the crown, and the strap falling off on both sides."""
    case = np.minimum(prism(ring(x, y, 0.0185, 0.003)), prism(disc(x, y, 0.020)) + 0.0005)
    crown = prism(box(x, y - 0.0215, 0.005, 0.005)) + 0.0008
    strap = prism(box(x, y, 0.090, 0.019)) + 0.0005 + 0.04 * np.maximum(np.abs(x) - 0.020, 0.0)
    return np.minimum.reduce([case, crown, strap])


@register("fidget_spinner", "daily", depth_m=(0.0006, 0.0028))
def _fidget_spinner(x: Field, y: Field) -> Field:
    """Three lobes with a bearing each, around a cap that protrudes."""
    turns = np.pi / 2 + 2 * np.pi * np.arange(3) / 3
    centres = [(0.027 * np.cos(turn), 0.027 * np.sin(turn)) for turn in turns]
    lobes = [disc(x - a, y - b, 0.0145) for a, b in centres]
    holes = [disc(x - a, y - b, 0.005) for a, b in centres]
    body = without(union(disc(x, y, 0.016), *lobes), *holes)
    return np.minimum(prism(disc(x, y, 0.0095)), prism(body) + 0.0008)


@register("rubber_ball", "daily", depth_m=(0.0008, 0.0040))
def _rubber_ball(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.0135, 0.0135, 0.0135)


@register("hex_bar", "daily")
def _hex_bar(x: Field, y: Field) -> Field:
    """Lying on one of its flats; 14 mm across flats."""
    flank = np.maximum(np.abs(y) - 0.0070 / np.sqrt(3), 0.0) * np.sqrt(3)
    return np.maximum(flank, prism(np.abs(x) - 0.045))


@register("aaa_battery", "daily", depth_m=(0.0006, 0.0025))
def _aaa_battery(x: Field, y: Field) -> Field:
    """Lying on its side."""
    return lying_cylinder(x, y, 0.0445, 0.00525)


@register("wrench", "daily")
def _wrench(x: Field, y: Field) -> Field:
    """Lying flat: an open end and a ring."""
    jaw = without(disc(x - 0.036, y, 0.014), bar(x - 0.046, y - 0.003, 0.022, 0.012, 0.26))
    return prism(union(jaw, box(x + 0.002, y, 0.052, 0.010), ring(x + 0.037, y, 0.0085, 0.006)))


@register("bolt_and_nut", "daily", depth_m=(0.0008, 0.0028))
def _bolt_and_nut(x: Field, y: Field) -> Field:
    """M16, upright: the nut, 24 mm across flats, and the bolt's end out of it."""
    return np.minimum(prism(disc(x, y, 0.0075)), prism(convex_polygon(x, y, 6, 0.0139)) + 0.0010)


@register("spoon", "daily", depth_m=(0.0006, 0.0030))
def _spoon(x: Field, y: Field) -> Field:
    """The back of its bowl."""
    return ellipsoid(x, y, 0.030, 0.020, 0.009)


@register("soft_brain", "daily", depth_m=(0.0010, 0.0040))
def _soft_brain(x: Field, y: Field) -> Field:
    """A toy to squeeze, of two folded halves; it flattens where it is pressed."""
    cleft = 0.0030 * np.exp(-((y / 0.0022) ** 2))
    folds = 0.0007 * (1 + np.sin(np.abs(y) / 0.0026 + 1.6 * np.sin(x / 0.0050)) * np.cos(x / 0.0042))
    # Its lowest point is beside the centre.
    return ellipsoid(x, y, 0.036, 0.030, 0.012) + cleft + folds - 0.00076


@register("tennis_ball", "daily", depth_m=(0.0008, 0.0040))
def _tennis_ball(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.0335, 0.0335, 0.0335)


@register("glass_mug", "daily")
def _glass_mug(x: Field, y: Field) -> Field:
    """Its rim."""
    return prism(ring(x, y, 0.037, 0.004))


@register("multitool", "daily")
def _multitool(x: Field, y: Field) -> Field:
    """Folded: two handles beside each other, each with a slot for its blades."""
    slots = [box(x - side * 0.006, y - side * 0.0075, 0.066, 0.005) for side in (1, -1)]
    return prism(without(rounded_box(x, y, 0.098, 0.030, 0.006), *slots))


@register("cologne", "daily")
def _cologne(x: Field, y: Field) -> Field:
    """The base of a flat bottle; its middle is hollow."""
    base = rounded_box(x, y, 0.062, 0.034, 0.010)
    return np.minimum(prism(without(base, base + 0.006)), prism(base) + 0.0025)


@register("glue_bottle", "daily", depth_m=(0.0006, 0.0030))
def _glue_bottle(x: Field, y: Field) -> Field:
    """Lying on its side, its shoulder towards +x."""
    return lying_cylinder(x, y, 0.085, 0.020) + np.maximum(x - 0.010, 0.0) ** 2 / 0.12


@register("nine_volt_battery", "daily", depth_m=(0.0012, 0.0040))
def _nine_volt_battery(x: Field, y: Field) -> Field:
    """Its snaps, a stud and a socket half an inch apart, on a face of 26.5 x 17.5 mm."""
    snaps = union(disc(x - 0.00635, y, 0.00285), ring(x + 0.00635, y, 0.0034, 0.0016))
    return np.minimum(prism(snaps), prism(box(x, y, 0.0265, 0.0175)) + 0.0025)


@register("eraser", "daily")
def _eraser(x: Field, y: Field) -> Field:
    """A block, worn at one end."""
    return prism(rounded_box(x, y, 0.055, 0.022, 0.003)) + np.maximum(x - 0.012, 0.0) ** 2 / 0.15


@register("power_adapter", "daily")
def _power_adapter(x: Field, y: Field) -> Field:
    """The face opposite the prongs, with its USB socket."""
    return prism(without(rounded_box(x, y, 0.046, 0.030, 0.006), box(x, y, 0.0135, 0.0065)))


@register("screwdriver", "daily", depth_m=(0.0006, 0.0028))
def _screwdriver(x: Field, y: Field) -> Field:
    """Lying on the bulge of its handle and on its tip; the shaft between them is higher."""
    handle = np.maximum(ellipsoid(x + 0.028, y, 0.060, 0.010, 0.010), prism(np.abs(x + 0.028) - 0.026))
    shaft = lying_cylinder(x - 0.026, y, 0.064, 0.003) + 0.07 * np.maximum(0.058 - x, 0.0)
    return np.minimum(handle, shaft)


@register("tweezers", "daily")
def _tweezers(x: Field, y: Field) -> Field:
    """Lying on the edges of both arms."""
    arms = [bar(x, y - side * 0.0045, 0.100, 0.003, side * 0.085) for side in (1, -1)]
    return prism(union(*arms, box(x + 0.046, y, 0.014, 0.006)))
