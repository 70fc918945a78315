# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How deep a rod with a round end presses the foam, from any side."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_sim.hand.solid_kernels import tip_depth

LENGTH_M = 0.04

Vector = NDArray[np.float64]


def is_inside(radius_m: float, at_m: Vector) -> bool:
    """Whether a point is in the rod, which ends at the origin."""
    x, y, z = at_m.tolist()
    return z >= -LENGTH_M and math.hypot(x, y, max(z + radius_m, 0.0)) < radius_m


def reach_m(radius_m: float, at_m: Vector, into: Vector) -> float:
    """How far the rod goes on beyond a point of it, by halving."""
    low_m, high_m = 0.0, 2 * LENGTH_M
    while high_m - low_m > 1e-9:
        middle_m = 0.5 * (low_m + high_m)
        low_m, high_m = (middle_m, high_m) if is_inside(radius_m, at_m + middle_m * into) else (low_m, middle_m)
    return low_m


SHARE = st.floats(-1.0, 1.0)


@given(
    radius_m=st.floats(0.0015, 0.02),
    place=st.tuples(SHARE, SHARE, st.floats(-1.0, 0.1)),
    slant_rad=st.floats(0.0, math.pi),
    turn_rad=st.floats(0.0, math.tau),
)
def test_a_rod_is_as_deep_in_the_skin_as_it_reaches_along_its_normal(
    radius_m: float, place: tuple[float, float, float], slant_rad: float, turn_rad: float
) -> None:
    at_m = np.array(place) * (radius_m, radius_m, LENGTH_M)
    out = np.array(
        [
            math.sin(slant_rad) * math.cos(turn_rad),
            math.sin(slant_rad) * math.sin(turn_rad),
            -math.cos(slant_rad),
        ]
    )
    depth_m = tip_depth(radius_m, LENGTH_M, *at_m.tolist(), *out.tolist())
    into_m, out_m = (reach_m(radius_m, at_m, way) if is_inside(radius_m, at_m) else 0.0 for way in (-out, out))
    if into_m > out_m + 1e-6:
        assert depth_m == 0.0
    elif into_m < out_m - 1e-6:
        assert depth_m == pytest.approx(into_m, abs=1e-7)


def test_what_comes_from_behind_the_skin_does_not_press() -> None:
    assert tip_depth(0.008, LENGTH_M, 0.0, 0.0, -0.001, 0.0, 0.0, -1.0) == pytest.approx(0.001)
    assert tip_depth(0.008, LENGTH_M, 0.0, 0.0, -0.001, 0.0, 0.0, 1.0) == 0.0


def test_the_side_of_a_rod_presses_as_well() -> None:
    for turned_rad in (-0.1, 0.0, 0.1):
        out = (-math.cos(turned_rad), 0.0, math.sin(turned_rad))
        assert tip_depth(0.008, LENGTH_M, 0.007, 0.0, -0.020, *out) == pytest.approx(0.001 / math.cos(turned_rad))


@pytest.mark.parametrize("slant_rad", [0.0, 0.6, 1.2])
def test_a_ball_presses_a_slanting_skin_as_it_presses_a_level_one(slant_rad: float) -> None:
    """A point a millimetre deep under the middle of the contact, and one beside it."""
    radius_m, depth_m, beside_m = 0.012, 0.001, 0.003
    out = np.array([math.sin(slant_rad), 0.0, -math.cos(slant_rad)])
    along = np.array([math.cos(slant_rad), 0.0, math.sin(slant_rad)])
    under_m = np.array([0.0, 0.0, -radius_m]) - (radius_m - depth_m) * out
    beside = under_m + beside_m * along
    expected_m = depth_m - radius_m + math.sqrt(radius_m**2 - beside_m**2)
    found_m = [tip_depth(radius_m, LENGTH_M, *point.tolist(), *out.tolist()) for point in (under_m, beside)]
    assert found_m == pytest.approx([depth_m, expected_m], abs=1e-9)
