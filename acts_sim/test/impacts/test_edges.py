# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Edges on a skin: where, how long and how hard they press it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from acts_core.skin import ForceResponse
from acts_sim.impacts import SCENE_RATE_HZ, Edge, struck
from acts_sim.pressing import ContactModel, FoamConfig


@pytest.mark.parametrize("angle_rad", [0.0, 0.5, 1.2, 2.4])
def test_an_edge_presses_where_it_lies_as_hard_and_for_as_long_as_it_is_said_to(angle_rad: float) -> None:
    skin = ContactModel(config=FoamConfig(noise_counts=0.0, gain_spread=0.0, subsamples=2))
    edge = Edge(0.012, -0.007, 0.040, 0.008, angle_rad, 8.0, 0.008)
    frames = struck(skin, edge, untouched_s=0.02).frames
    assert len(frames) == round(0.048 * SCENE_RATE_HZ) + 1
    pressed = np.flatnonzero(frames.any(axis=(1, 2))) / SCENE_RATE_HZ
    assert 0.02 < pressed[0] < 0.0205
    assert 0.0275 < pressed[-1] < 0.028
    top = frames[round(0.024 * SCENE_RATE_HZ)]
    np.testing.assert_array_equal(top, frames.max(axis=0))
    force_n = ForceResponse().force_n(top)
    assert force_n.sum() == pytest.approx(8.0, rel=0.03)
    dx, dy = np.meshgrid(skin.geometry.x_m(np.arange(32)) - 0.012, skin.geometry.y_m(np.arange(32)) + 0.007)
    assert (force_n * dx).sum() / force_n.sum() == pytest.approx(0.0, abs=3e-4)
    assert (force_n * dy).sum() / force_n.sum() == pytest.approx(0.0, abs=3e-4)
    # An ellipse's second moment is a fifth of the square of its half axis under half an ellipsoid of pressure.
    along = math.cos(angle_rad) * dx + math.sin(angle_rad) * dy
    across = math.cos(angle_rad) * dy - math.sin(angle_rad) * dx
    apart_m2 = (force_n * (along**2 - across**2)).sum() / force_n.sum()
    assert apart_m2 == pytest.approx((0.020**2 - 0.004**2) / 5, rel=0.05)
