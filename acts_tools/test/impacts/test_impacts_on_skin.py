# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Impacts on the simulated skin, through sampling and fusion: what is told of them, and of what is none."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.sampling import SamplingConfig
from acts_recon.contacts import BlobConfig
from acts_recon.fusion import FusionConfig, FusionEstimator
from acts_recon.impacts import UNKNOWN_DIRECTION_SD_RAD, Impact, ImpactDetector, Kind
from acts_sim.impacts import SCENE_RATE_HZ, Scene, ball_named, dropped, scene, thrown
from acts_sim.pressing import (
    EVENT_RATE_HZ,
    PRESS_RATE_HZ,
    ContactModel,
    event_recordings,
    object_named,
    press_over_time,
    skin_of,
)
from acts_tools.firmware.board_sampler import BoardSampler

GEOMETRY = ArrayGeometry()
SAMPLE_S = 17.877e-6


def told(frames: NDArray[np.uint16], rate_hz: float, m: int = 64, noise: float = 3.0) -> Iterator[tuple[float, Impact]]:
    """When what is told of frames that are sampled as a board does."""
    sampler = BoardSampler(SamplingConfig(scheme="tracking", m=m, threshold_counts=15), noise)
    fusion = FusionEstimator(GEOMETRY, FusionConfig(noise_counts=noise))
    detector = ImpactDetector(GEOMETRY, blobs=BlobConfig(touch_counts=50, noise_counts=noise))
    period_s = m * SAMPLE_S
    at_s = 0.0
    while (at_s + period_s) * rate_hz < len(frames) - 1:
        indices, counts = sampler.frame(frames, at_s * rate_hz, SAMPLE_S * rate_hz)
        at_s += period_s
        fusion.step(indices, counts, at_s, period_s)
        for impact in detector.step(at_s, period_s, fusion.image, fusion.sigma, fusion.age_s, fusion.measured):
            yield at_s, impact


def thrown_ball(seed: int, direction_rad: float | None) -> Scene:
    rng = np.random.default_rng(seed)
    ball = ball_named("tennis" if direction_rad is None else "rubber")
    throw = dropped()
    if direction_rad is not None:
        throw = thrown(2.0, direction_rad, 0.5, rolling=0.5, radius_m=ball.radius_m)
    return scene(skin_of(rng), ball, throw, untouched_s=0.04, rng=rng)


@pytest.mark.parametrize("m", [42, 128])
def test_a_bounce_is_told_in_the_first_frame_that_sees_it_and_once_more_when_it_is_over(m: int) -> None:
    shown = thrown_ball(1, None)
    truth = shown.collisions[0]
    (begun_at_s, begun), (over_at_s, over) = told(shown.frames, SCENE_RATE_HZ, m)
    assert (begun.is_over, begun.kind) == (False, Kind.UNKNOWN)
    assert begun_at_s - truth.time_s[0] < 2.5 * m * SAMPLE_S
    assert over_at_s - truth.time_s[-1] < 0.003 + 3 * m * SAMPLE_S
    assert over.number == begun.number
    assert (over.is_over, over.kind, over.bounced) == (True, Kind.IMPACT, True)
    assert over.onset_s == pytest.approx(truth.time_s[0], abs=4 * over.onset_sd_s)
    assert over.duration_s == pytest.approx(truth.duration_s, abs=m * SAMPLE_S)
    assert over.frames >= 0.7 * truth.duration_s / (m * SAMPLE_S)
    assert over.peak_n == pytest.approx(truth.force_n.max(), abs=3 * over.peak_sd_n)
    assert over.impulse_n_s == pytest.approx(truth.impulse_n_s, abs=3 * over.impulse_sd_n_s)
    assert math.hypot(over.x_m, over.y_m) < 0.002
    assert len(over.time_s) == len(over.force_n) == len(over.path_x_m) == len(over.path_y_m)
    # A straight drop comes from nowhere.
    assert math.hypot(*over.velocity_m_s) < 0.5


@pytest.mark.parametrize("direction_rad", [-2.0, 0.3, 3.1])
def test_the_direction_of_a_ricochet_is_told_with_its_uncertainty(direction_rad: float) -> None:
    shown = thrown_ball(2, direction_rad)
    over = [impact for _, impact in told(shown.frames, SCENE_RATE_HZ) if impact.is_over]
    (only,) = over
    error = math.remainder(only.direction_rad - direction_rad, 2 * math.pi)
    assert abs(error) < math.radians(5)
    assert abs(error) < 4 * only.direction_sd_rad
    assert math.radians(0.1) < only.direction_sd_rad < math.radians(5)


def kinds(frames: NDArray[np.uint16], rate_hz: float) -> list[Kind]:
    return [impact.kind for _, impact in told(frames, rate_hz) if impact.is_over]


def test_a_press_a_slide_and_a_tap_are_no_impacts() -> None:
    press = press_over_time(ContactModel(seed=3), object_named("rubber_ball"))
    slower = np.concatenate([press[:20], np.repeat(press[20:60], 3, axis=0), press[60:]])
    untouched = np.zeros_like(press[:10])
    assert kinds(np.concatenate((slower, untouched)), PRESS_RATE_HZ) == [Kind.PRESS]
    assert kinds(np.concatenate((press[:35], press[-15:], untouched)), PRESS_RATE_HZ) == [Kind.TAP]
    (slide,) = event_recordings("slide_0.5_m_s", 1, 1)
    gone = np.zeros((200, 32, 32), dtype=np.uint16)
    assert kinds(np.concatenate((slide, gone)), EVENT_RATE_HZ) == [Kind.SLIDE]


def test_a_step_is_told_from_a_press_by_its_size() -> None:
    at = np.arange(600) / 1000.0
    force = np.clip(np.minimum(at - 0.02, 0.5 - at) / 0.08, 0, 1)
    sole = np.zeros((32, 32))
    sole[4:28, 8:20] = 400
    frames = np.rint(force[:, None, None] * sole).astype(np.uint16)
    assert kinds(frames, 1000.0) == [Kind.STEP]


def test_what_lands_and_stays_is_an_impact_that_did_not_bounce() -> None:
    at = np.arange(400) / 4000.0
    force = np.where(at < 0.02, 0, np.where(at < 0.029, np.sin((at - 0.02) / 0.009 * np.pi * 0.9), 0.2))
    bag = np.zeros((32, 32))
    bag[12:19, 12:19] = 700
    frames = np.rint(np.clip(force, 0, 1)[:, None, None] * bag).astype(np.uint16)
    over = [impact for _, impact in told(frames, 4000.0) if impact.is_over]
    assert [(impact.kind, impact.bounced) for impact in over] == [(Kind.IMPACT, False)]


def test_an_untouched_noisy_skin_tells_nothing() -> None:
    assert not list(told(np.zeros((1500, 32, 32), dtype=np.uint16), 1000.0))


def test_two_impacts_far_apart_are_two_and_each_bounce_is_one() -> None:
    rng = np.random.default_rng(4)
    skin, golf = skin_of(rng), ball_named("golf")
    left, right = (
        scene(skin, golf, dropped(0.05, x_m, 0.0), bounces=2, untouched_s=before_s, rng=rng).frames
        for x_m, before_s in ((-0.04, 0.03), (0.04, 0.032))
    )
    n = min(len(left), len(right))
    over = [impact for _, impact in told(np.maximum(left[:n], right[:n]), SCENE_RATE_HZ) if impact.is_over]
    assert sorted(round(impact.x_m * 100) for impact in over) == [-4, -4, 4, 4]
    assert len({impact.number for impact in over}) == 4


def test_without_samples_the_image_alone_tells_of_a_touch_but_not_of_its_direction() -> None:
    detector = ImpactDetector(GEOMETRY)
    press = np.zeros((32, 32), dtype=np.float32)
    press[10:14, 10:14] = 500
    over = []
    for number in range(30):
        image = press if 5 <= number < 12 else np.zeros_like(press)
        over += [one for one in detector.step(1e-3 * number, 1e-3, image) if one.is_over]
    (only,) = over
    assert (only.kind, only.frames, only.direction_sd_rad) == (Kind.IMPACT, 7, UNKNOWN_DIRECTION_SD_RAD)
    assert only.duration_s == pytest.approx(0.007, abs=0.0011)


def test_after_a_jump_of_the_clock_all_begins_anew() -> None:
    detector = ImpactDetector(GEOMETRY)
    press = np.zeros((32, 32), dtype=np.float32)
    press[10:14, 10:14] = 500
    assert [one.number for one in detector.step(5.0, 1e-3, press)] == [1]
    assert [one.number for one in detector.step(1.0, 1e-3, press)] == [2]
    assert [one.number for one in detector.step(9.0, 1e-3, press)] == [3]
