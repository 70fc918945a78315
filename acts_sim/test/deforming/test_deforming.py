# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Soft bodies on a skin: where they touch, for how long, and what the skin reads of it."""

from __future__ import annotations

import numpy as np
import pytest

from acts_core.errors import SettingsError
from acts_sim.deforming import BODIES, Body, SoftContact, body_named, soft_contact
from acts_sim.impacts import SCENE_RATE_HZ
from acts_sim.pressing import skin_of


def met(name: str, seed: int = 1) -> SoftContact:
    rng = np.random.default_rng(seed)
    return soft_contact(skin_of(rng), body_named(name), rng)


def area_m2(corners: np.ndarray) -> float:
    x, y = corners.T
    return float(x @ np.roll(y, -1) - np.roll(x, -1) @ y) / 2


@pytest.mark.parametrize(("name", "touch_s"), [("tennis", 0.008), ("block", 0.010), ("balloon", 0.030)])
def test_bodies_touch_for_as_long_as_they_are_said_to_and_where_their_outline_is(name: str, touch_s: float) -> None:
    shown = met(name)
    assert shown.end_s - shown.begin_s == pytest.approx(touch_s)
    touched = np.flatnonzero(shown.frames.any(axis=(1, 2))) / SCENE_RATE_HZ
    assert shown.begin_s <= touched[0] <= touched[-1] <= shown.end_s
    assert touched[-1] - touched[0] > 0.8 * touch_s
    for time_s in (shown.begin_s - 0.001, shown.end_s + 0.001):
        assert shown.outline_m(time_s).shape == (0, 2)
    areas = [area_m2(shown.outline_m(shown.begin_s + share * touch_s)) for share in (0.1, 0.3, 0.5, 0.9)]
    assert 0 < areas[0] < areas[1] < areas[2]
    assert areas[3] == pytest.approx(areas[0], rel=1e-6)
    middle = shown.frames[round((shown.begin_s + touch_s / 2) * SCENE_RATE_HZ)].astype(float)
    geometry = skin_of(np.random.default_rng(0)).geometry
    half = middle > 0.5 * np.median(middle[middle > 50])
    assert half.sum() * geometry.pitch_m**2 == pytest.approx(areas[2], rel=0.35)
    corners = shown.outline_m(shown.begin_s + touch_s / 2)
    x_m = float(middle.sum(axis=0) @ geometry.x_m(np.arange(32))) / middle.sum()
    y_m = float(middle.sum(axis=1) @ geometry.y_m(np.arange(32))) / middle.sum()
    assert corners[:, 0].min() < x_m < corners[:, 0].max()
    assert corners[:, 1].min() < y_m < corners[:, 1].max()


@pytest.mark.parametrize("body", BODIES.values(), ids=list(BODIES))
def test_there_is_pressure_inside_of_the_outline_and_none_outside(body: Body) -> None:
    x_m, y_m = body.outline_m(0.5 * body.depth_m).T
    inside, outside = (body.pressure_pa(share * x_m, share * y_m, 0.5 * body.depth_m) for share in (0.97, 1.03))
    assert (inside > 0).all()
    assert (outside == 0).all()


def test_the_same_seed_is_the_same_contact() -> None:
    assert np.array_equal(met("block", 3).frames, met("block", 3).frames)
    assert met("block", 3).angle_rad != met("block", 4).angle_rad
    with pytest.raises(SettingsError, match="known are tennis, block, balloon"):
        body_named("brick")
