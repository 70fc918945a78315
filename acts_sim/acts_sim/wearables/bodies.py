# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parts of a body that press a worn skin, and how deep they do over time. Shapes and times are ours."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from acts_sim.pressing import ContactObject, Field, ellipsoid

Depth = Callable[[float], float]
"""Depth [m] by the time since the first touch [s]."""

_GROUP = "body"
_LEAVE_S = 0.06
_SWAY, _SWAY_HZ = 0.05, 3.0


def _fingertips(x: Field, y: Field) -> Field:
    tips = [ellipsoid(x - offset, y, 0.009, 0.014, 0.007) for offset in (-0.018, 0.0, 0.018)]
    return np.minimum.reduce(tips)


def _finger(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.009, 0.022, 0.008)


def _palm(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.040, 0.030, 0.015)


def _cushion(half_width_m: float, half_length_m: float) -> Callable[[Field, Field], Field]:
    """A part of a sole: its middle is flat, its edge is reached at 6 mm of depth."""

    def gap(x: Field, y: Field) -> Field:
        return 0.006 * ((x / half_width_m) ** 2 + (y / half_length_m) ** 2) ** 2

    return gap


FINGERTIPS = ContactObject("fingertips", _GROUP, (0.0025, 0.0045), _fingertips)
FINGER = ContactObject("finger", _GROUP, (0.002, 0.004), _finger)
PALM = ContactObject("palm", _GROUP, (0.002, 0.004), _palm)
HEEL = ContactObject("heel", _GROUP, (0.005, 0.007), _cushion(0.027, 0.033))
MIDFOOT = ContactObject("midfoot", _GROUP, (0.001, 0.002), _cushion(0.022, 0.060))
FOREFOOT = ContactObject("forefoot", _GROUP, (0.004, 0.006), _cushion(0.038, 0.030))
TOES = ContactObject("toes", _GROUP, (0.002, 0.004), _cushion(0.025, 0.020))


def tapped(depth_m: float, duration_s: float) -> Depth:
    """In and out again: half a sine wave."""
    return lambda since_s: depth_m * max(math.sin(math.pi * since_s / duration_s), 0.0)


def held(depth_m: float, slowing_s: float, until_s: float) -> Depth:
    """Comes at a speed of depth over `slowing_s`, slows down, is held with a small sway, and leaves until the end."""

    def depth(since_s: float) -> float:
        coming = 1.0 - math.exp(-since_s / slowing_s)
        sway = 1.0 + _SWAY * math.sin(2 * math.pi * _SWAY_HZ * since_s)
        left = min(max((until_s - since_s) / _LEAVE_S, 0.0), 1.0)
        # Eased: a hand neither begins nor ends to leave at once.
        return depth_m * coming * sway * (3 * left**2 - 2 * left**3)

    return depth


def rolled(depth_m: float, duration_s: float) -> Depth:
    """A part of a sole that the weight rolls over."""
    return lambda since_s: depth_m * max(math.sin(math.pi * since_s / duration_s), 0.0) ** 1.5
