# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Contacts of a skin in the robot's frame."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.transforms import Transform
from acts_skins.contacts.placing import Placement, Touch

TOUCH = Touch(
    number=7,
    age_s=0.5,
    position_m=(0.01, 0.02, 0.0),
    velocity_m_s=(0.1, 0.0, 0.0),
    force_n=3.0,
    peak_counts=500.0,
    area_m2=1e-4,
    active_taxels=5,
    spread_m=0.004,
    position_sd_m=(0.003, 0.001, 0.0),
    velocity_sd_m_s=(0.2, 0.1, 0.0),
    force_sd_n=0.3,
    area_sd_m2=1e-5,
    spread_sd_m=1e-3,
)


def test_a_skin_on_the_side_is_pushed_sideways() -> None:
    # Turned by a quarter about x: the skin's y is up, its z points to -y.
    placed = Placement(Transform.from_rpy((1.0, 2.0, 3.0), (math.pi / 2, 0.0, 0.0))).place(TOUCH)
    assert placed.position_m == pytest.approx((1.01, 2.0, 3.02))
    assert placed.velocity_m_s == pytest.approx((0.1, 0.0, 0.0))
    assert placed.normal == pytest.approx((0.0, -1.0, 0.0))
    assert placed.force_n == pytest.approx((0.0, 3.0, 0.0))
    assert placed.position_sd_m == pytest.approx((0.003, 0.0, 0.001), abs=1e-12)
    assert placed.touch.number == 7


ANGLES = st.floats(-4.0, 4.0)


@given(st.tuples(ANGLES, ANGLES, ANGLES))
def test_deviations_are_those_of_the_turned_covariance(rpy_rad: tuple[float, float, float]) -> None:
    transform = Transform.from_rpy((0.0, 0.0, 0.0), rpy_rad)
    placed = Placement(transform).place(TOUCH)
    rotation = transform.rotation()
    covariance = rotation @ np.diag(np.square(TOUCH.position_sd_m)) @ rotation.T
    np.testing.assert_allclose(placed.position_sd_m, np.sqrt(np.diag(covariance)), atol=1e-12)
    assert math.hypot(*placed.force_n) == pytest.approx(TOUCH.force_n)
    assert np.dot(placed.force_n, placed.normal) == pytest.approx(-TOUCH.force_n)


@pytest.mark.parametrize("number", [math.nan, math.inf])
def test_numbers_that_are_none_are_noticed_wherever_they_stand(number: float) -> None:
    assert TOUCH.can_be()
    assert not replace(TOUCH, force_n=number).can_be()
    assert not replace(TOUCH, position_m=(0.0, number, 0.0)).can_be()
    assert not replace(TOUCH, spread_sd_m=number).can_be()
