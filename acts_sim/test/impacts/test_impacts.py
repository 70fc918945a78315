# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Balls on a skin: what bounces, for how long, how hard, where to, and what the skin reads of it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.skin import ForceResponse
from acts_sim.impacts import (
    BALLS,
    DROP_HEIGHT_M,
    SCENE_RATE_HZ,
    Ball,
    Throw,
    ball_named,
    collide,
    dropped,
    footprint_n,
    scene,
    thrown,
)
from acts_sim.pressing import skin_of


@pytest.mark.parametrize(
    ("name", "touch_s", "rebound"), [("tennis", 0.0087, 0.67), ("rubber", 0.006, 0.8), ("golf", 0.004, 0.75)]
)
def test_balls_touch_and_bounce_as_they_are_said_to(name: str, touch_s: float, rebound: float) -> None:
    throw = dropped(DROP_HEIGHT_M)
    collision = collide(ball_named(name), throw)
    assert collision.duration_s == pytest.approx(touch_s, rel=0.01)
    assert collision.after is not None
    assert collision.after.velocity_m_s[2] / throw.velocity_m_s[2] == pytest.approx(rebound, abs=0.01)


@pytest.mark.parametrize("ball", BALLS.values(), ids=list(BALLS))
def test_impulse_is_the_change_of_momentum(ball: Ball) -> None:
    throw = thrown(2.0, 1.0, 0.6, rolling=0.5, radius_m=ball.radius_m)
    collision = collide(ball, throw)
    assert collision.after is not None
    change = ball.mass_kg * (-collision.after.velocity_m_s[2] - throw.velocity_m_s[2])
    weight = ball.mass_kg * 9.81 * collision.duration_s
    assert collision.impulse_n_s == pytest.approx(change + weight, rel=0.01)
    assert collision.force_n.min() >= 0


def test_a_ball_never_gains_energy_and_friction_stops_slip() -> None:
    ball = ball_named("rubber")
    throw = thrown(3.0, 0.0, 0.5)
    after = collide(ball, throw).after
    assert after is not None
    vx, _, vz = after.velocity_m_s
    moment = ball.inertia * ball.mass_kg * ball.radius_m**2
    energy = ball.mass_kg * (vx**2 + vz**2) + moment * after.spin_rad_s[1] ** 2
    assert energy < ball.mass_kg * 9.0
    assert 0 < vx < throw.velocity_m_s[0]
    # It leaves rolling: what touches has no speed against the skin.
    assert vx - after.spin_rad_s[1] * ball.radius_m == pytest.approx(0, abs=0.02)


def test_a_ball_that_rolls_as_it_flies_is_not_slowed_and_one_with_side_spin_is_turned() -> None:
    ball = ball_named("rubber")
    rolling = collide(ball, thrown(2.0, 0.7, 0.5, rolling=1.0, radius_m=ball.radius_m))
    assert rolling.after is not None
    assert math.hypot(*rolling.after.velocity_m_s[:2]) == pytest.approx(2.0 * math.cos(0.5), rel=0.01)
    way = rolling.x_m[-1] - rolling.x_m[0], rolling.y_m[-1] - rolling.y_m[0]
    assert math.atan2(way[1], way[0]) == pytest.approx(0.7, abs=0.01)
    spun = collide(ball, Throw(velocity_m_s=(1.0, 0.0, -1.0), spin_rad_s=(100.0, 0.0, 0.0)))
    # What touches moves to +y, so friction pushes the ball to -y.
    assert spun.y_m[-1] < -1e-4


def test_the_footprint_carries_the_force_and_grows_with_it() -> None:
    skin, ball = skin_of(np.random.default_rng(1)), ball_named("tennis")
    light, hard = (
        footprint_n(skin, ball, (0.004, -0.003, depth, force)) for depth, force in ((0.001, 3.0), (0.009, 80.0))
    )
    assert light.sum() == pytest.approx(3.0, rel=0.05)
    assert hard.sum() == pytest.approx(80.0, rel=0.02)
    assert (hard > 0.05).sum() > 2 * (light > 0.05).sum()
    geometry = skin.geometry
    x_m = float((hard.sum(axis=0) * geometry.x_m(np.arange(32))).sum() / hard.sum())
    y_m = float((hard.sum(axis=1) * geometry.y_m(np.arange(32))).sum() / hard.sum())
    assert (x_m, y_m) == pytest.approx((0.004, -0.003), abs=1e-4)


def test_a_scene_shows_each_bounce_when_it_is_and_nothing_else() -> None:
    rng = np.random.default_rng(2)
    shown = scene(skin_of(rng), ball_named("golf"), dropped(0.02), bounces=2, untouched_s=0.005, rng=rng)
    assert len(shown.collisions) == 2
    assert shown.collisions[1].time_s[0] == shown.collisions[0].after_s
    touched: NDArray[np.bool_] = np.any(shown.frames > 0, axis=(1, 2))
    at_s = np.arange(len(touched)) / SCENE_RATE_HZ
    within = np.zeros_like(touched)
    for one in shown.collisions:
        within |= (at_s >= one.time_s[0]) & (at_s <= one.time_s[-1])
    assert not touched[~within].any()
    assert touched[within].mean() > 0.85
    peak_n = ForceResponse().force_n(shown.frames).sum(axis=(1, 2)).max()
    assert peak_n == pytest.approx(shown.collisions[0].force_n.max(), rel=0.1)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(("pitches", "bounces"), [(15.9, 2), (16.1, 1)])
def test_a_ball_bounces_again_on_the_whole_of_the_outer_taxels_and_not_beside_them(
    axis: int, pitches: float, bounces: int
) -> None:
    rng = np.random.default_rng(5)
    skin = skin_of(rng)
    at_m = pitches * skin.geometry.pitch_m
    x_m, y_m = (at_m, 0.0) if axis == 0 else (0.0, -at_m)
    shown = scene(skin, ball_named("golf"), dropped(0.02, x_m, y_m), bounces=2, rng=rng)
    assert len(shown.collisions) == bounces


def test_the_same_seed_is_the_same_scene() -> None:
    def one(seed: int) -> np.ndarray:
        rng = np.random.default_rng(seed)
        return scene(skin_of(rng), ball_named("rubber"), dropped(0.1), rng=rng).frames

    assert np.array_equal(one(3), one(3))
    assert not np.array_equal(one(3)[: len(one(4))], one(4)[: len(one(3))])


def test_what_cannot_be_thrown_is_refused() -> None:
    with pytest.raises(SettingsError, match="below 0"):
        Throw(velocity_m_s=(1.0, 0.0, 0.0))
    with pytest.raises(SettingsError, match="above 0 m"):
        dropped(-1.0)
    with pytest.raises(SettingsError, match="radius"):
        thrown(1.0, 0.0, 1.0, rolling=1.0)
    with pytest.raises(SettingsError, match="known are tennis"):
        ball_named("cannon")
    rng = np.random.default_rng(0)
    with pytest.raises(SettingsError, match="bounces = 0"):
        scene(skin_of(rng), ball_named("golf"), dropped(), bounces=0, rng=rng)
