# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tangential motion and slip on patches of skin: made patterns whose motion is known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_recon.slip import SlipConfig, SlipDetector
from acts_recon.slip.motion import RIDGE, Motion
from acts_recon.slip.motion_kernels import normal_equations, solve

pytestmark = pytest.mark.slow

SIDE = 8
PITCH_M = 0.003


def press(row: float, col: float, width: float = 1.5, counts: float = 600.0, side: int = SIDE) -> NDArray[np.float32]:
    rows, cols = np.indices((side, side))
    return np.asarray(counts * np.exp(-((rows - row) ** 2 + (cols - col) ** 2) / (2 * width**2)), np.float32)


def motion_between(
    reference: NDArray[np.float32],
    image: NDArray[np.float32],
    noise_counts: float = 1.5,
    is_dead: NDArray[np.bool_] | None = None,
) -> Motion | None:
    """By the kernels; None where nothing presses."""
    matrix = np.zeros((4, 5))
    dead = np.zeros(image.shape, dtype=np.bool_) if is_dead is None else is_dead
    squares, count = normal_equations(reference, image, dead, matrix)
    return Motion(*solve(matrix, np.zeros((4, 4)), squares, count, noise_counts, RIDGE)) if count else None


def by_lstsq(
    reference: NDArray[np.float32], image: NDArray[np.float32], is_live: NDArray[np.bool_] | None = None
) -> NDArray[np.float64]:
    """The same least squares as arrays: shift along columns and rows, gain, growth."""
    kept = np.ones(image.size, dtype=np.bool_) if is_live is None else is_live.ravel()
    before, after = reference.astype(float), image.astype(float)
    mean = (before + after) / 2
    down, right = np.gradient(mean)
    rows, cols = np.indices(mean.shape)
    weight = np.maximum(mean, 0.0) ** 2
    row, col = (rows * weight).sum() / weight.sum(), (cols * weight).sum() / weight.sum()
    lines = np.stack([before, right, down, (cols - col) * right + (rows - row) * down], -1).reshape(-1, 4)
    solution = np.linalg.lstsq(lines[kept], (after - before).ravel()[kept], rcond=None)[0]
    return np.array([-solution[1], -solution[2], 1.0 + solution[0], -solution[3]])


@given(st.integers(0, 10**6), st.integers(3, 16), st.integers(3, 16))
def test_the_kernel_is_the_least_squares_that_it_says(seed: int, rows: int, cols: int) -> None:
    rng = np.random.default_rng(seed)
    reference = rng.uniform(0, 900, (rows, cols)).astype(np.float32)
    image = (reference + rng.normal(0, 20, (rows, cols))).astype(np.float32)
    motion = motion_between(reference, image)
    assert motion is not None
    expected = by_lstsq(reference, image)
    found = np.array([motion.cols, motion.rows, motion.gain, motion.growth])
    np.testing.assert_allclose(found, expected, atol=1e3 * RIDGE * (1 + np.abs(expected).max()))


@pytest.mark.parametrize("shift", [0.02, 0.1, 0.3])
@pytest.mark.parametrize("angle_deg", [0, 37, 90, 200])
def test_a_small_shift_is_measured(shift: float, angle_deg: int) -> None:
    right, down = shift * np.cos(np.radians(angle_deg)), shift * np.sin(np.radians(angle_deg))
    motion = motion_between(press(3.4, 3.7), press(3.4 + down, 3.7 + right))
    assert motion is not None
    assert motion.cols == pytest.approx(right, abs=0.06 * shift)
    assert motion.rows == pytest.approx(down, abs=0.06 * shift)
    assert motion.gain == pytest.approx(1.0, abs=0.02)


def test_force_and_width_are_told_from_motion() -> None:
    motion = motion_between(press(3.4, 3.7), press(3.4, 3.7, width=1.56, counts=690.0))
    assert motion is not None
    assert motion.distance_taxels < 0.01
    assert motion.gain == pytest.approx(1.15, abs=0.02)
    assert motion.growth == pytest.approx(0.04, abs=0.01)


def test_its_standard_deviation_is_that_of_many_tries() -> None:
    rng = np.random.default_rng(1)
    clean, errors, deviations = press(3.4, 3.7), [], []
    for _ in range(400):
        a, b = (clean + rng.normal(0, 4.0, clean.shape).astype(np.float32) for _ in range(2))
        motion = motion_between(a, b, noise_counts=4.0)
        assert motion is not None
        errors.append((motion.cols, motion.rows))
        deviations.append(motion.sd_taxels)
    seen = np.sqrt(np.square(errors).sum(axis=1).mean())
    assert np.median(deviations) == pytest.approx(seen, rel=0.25)


def test_nothing_is_said_where_nothing_presses() -> None:
    empty = np.zeros((SIDE, SIDE), np.float32)
    assert motion_between(empty, empty) is None


def test_equal_pressure_all_over_shows_no_motion() -> None:
    flat = np.full((SIDE, SIDE), 300.0, np.float32)
    motion = motion_between(flat, flat + 1.0)
    assert motion is not None
    assert not motion.distance_taxels > 5 * motion.sd_taxels


@pytest.mark.parametrize(
    ("rows", "cols", "noise", "words"), [(2, 8, 1.0, "2 x 8"), (8, 8, 0.0, "noise_counts = 0"), (8, 8, np.nan, "nan")]
)
def test_patches_and_noise_that_cannot_be_are_refused(rows: int, cols: int, noise: float, words: str) -> None:
    with pytest.raises(ArrayError, match=words):
        SlipDetector(rows, cols, PITCH_M, noise_counts=noise)


def test_images_of_another_kind_are_refused() -> None:
    detector = SlipDetector(SIDE, SIDE, PITCH_M)
    image = press(3, 3)
    for wrong in (image[:-1], image.astype(np.float64)):
        with pytest.raises(ArrayError, match="float32"):
            detector.step(0.0, wrong)  # type: ignore[arg-type]


@pytest.mark.parametrize("pitch_m", [0.0, -0.003, np.nan, np.inf])
def test_a_pitch_that_cannot_be_is_refused(pitch_m: float) -> None:
    with pytest.raises(ArrayError, match="pitch_m"):
        SlipDetector(SIDE, SIDE, pitch_m)


@pytest.mark.parametrize(("time_s", "count"), [(np.nan, 0.0), (np.inf, 0.0), (0.5, np.nan), (0.5, np.inf)])
def test_times_and_counts_that_are_no_numbers_are_refused_and_leave_no_trace(time_s: float, count: float) -> None:
    detector, undisturbed, image = (*(SlipDetector(SIDE, SIDE, PITCH_M) for _ in range(2)), press(3, 3))
    wrong = image.copy()
    wrong[2, 5] += count
    for frame in range(200):
        if frame == 100:
            with pytest.raises(ArrayError, match="finite"):
                detector.step(time_s, wrong)
        assert detector.step(0.005 * frame, image) == undisturbed.step(0.005 * frame, image)


def first_slip(images: list[NDArray[np.float32]], rate_hz: float, config: SlipConfig | None = None) -> int | None:
    """Number of the first image at which slip is told."""
    detector = SlipDetector(SIDE, SIDE, PITCH_M, config)
    for k, image in enumerate(images):
        if detector.step(k / rate_hz, image).slipping:
            return k
    return None


def noisy(image: NDArray[np.float32], rng: np.random.Generator) -> NDArray[np.float32]:
    return (image + rng.normal(0, 1.5, image.shape)).astype(np.float32)


@pytest.mark.parametrize("speed_m_s", [0.01, 0.03, 0.1])
def test_slip_is_noticed_soon_after_the_first_fifth_of_a_millimetre(speed_m_s: float) -> None:
    rng = np.random.default_rng(2)
    begin = 150

    def at(k: int) -> NDArray[np.float32]:
        moved = max(k - begin, 0) * 1e-3 * speed_m_s / PITCH_M
        return noisy(press(3.4, 2.5 + moved), rng)

    told = first_slip([at(k) for k in range(begin + 60)], 1000.0)
    assert told is not None
    moved_m = (told - begin) * 1e-3 * speed_m_s
    assert told >= begin
    assert moved_m <= 0.0002 + 0.005 * speed_m_s  # 0.2 mm, and 5 ms


def test_a_grip_that_closes_tightens_and_holds_is_no_slip() -> None:
    rng = np.random.default_rng(3)

    def at(k: int) -> NDArray[np.float32]:
        share = min(k / 400, 1.0)
        return noisy(press(3.4, 3.7, width=0.9 + 0.6 * share, counts=700.0 * share), rng)

    assert first_slip([at(k) for k in range(3000)], 1000.0) is None


def test_a_slow_recording_is_watched_frame_by_frame() -> None:
    images = [press(3.4, 3.0 + 0.2 * max(k - 10, 0)) for k in range(20)]
    told = first_slip(images, 31.0)
    assert told is not None
    assert 11 <= told <= 12


def test_after_a_step_back_of_time_it_begins_anew() -> None:
    detector = SlipDetector(SIDE, SIDE, PITCH_M)
    for k in range(100):
        detector.step(k * 1e-3, press(3.4, 3.7))
    assert detector.step(0.0, press(3.4, 5.7)).motion is None
    assert not detector.step(0.001, press(3.4, 5.7)).slipping


def test_after_a_pause_it_begins_anew() -> None:
    detector = SlipDetector(SIDE, SIDE, PITCH_M)
    for k in range(100):
        detector.step(k * 1e-3, press(3.4, 3.7))
    assert detector.step(0.7, press(3.4, 5.7)).motion is None
    assert not detector.step(0.701, press(3.4, 5.7)).slipping


@pytest.mark.parametrize("gap_s", [0.1, 0.2, 0.3, 0.45])
@pytest.mark.parametrize("rate_hz", [1000.0, 250.0])
def test_creep_is_no_slip_after_a_gap_but_slip_is(gap_s: float, rate_hz: float) -> None:
    def is_told(speed_m_s: float) -> bool:
        detector, rng, told = SlipDetector(SIDE, SIDE, PITCH_M), np.random.default_rng(5), False
        for time_s in np.arange(0.0, 1.0, 1.0 / rate_hz).tolist():
            if not 0.3 < time_s < 0.3 + gap_s:
                image = noisy(press(3.4, 2.5 + time_s * speed_m_s / PITCH_M), rng)
                told |= detector.step(time_s, image).slipping and time_s > 0.3
        return told

    assert not is_told(0.001)
    assert is_told(0.006)


@pytest.mark.parametrize("before", [0, 100])
def test_creep_is_no_slip_after_a_gap_that_follows_the_first_image_of_a_touch(before: int) -> None:
    """`before` images of nothing come before it: without any nothing says how quickly images come."""

    def is_told(moved_m: float) -> bool:
        detector, rng = SlipDetector(SIDE, SIDE, PITCH_M), np.random.default_rng(5)
        for number in range(before):
            detector.step(1e-3 * number, noisy(press(3.4, 2.5, counts=0.0), rng))
        detector.step(1e-3 * before, noisy(press(3.4, 2.5), rng))
        return detector.step(1e-3 * before + 0.3, noisy(press(3.4, 2.5 + moved_m / PITCH_M), rng)).slipping

    assert not is_told(0.3e-3)
    assert is_told(1.8e-3)


def test_of_slow_images_the_second_of_a_touch_may_be_slip() -> None:
    detector = SlipDetector(SIDE, SIDE, PITCH_M)
    told = [detector.step(k / 5.0, press(3.4, 3.0, counts=0.0)).slipping for k in range(3)]
    told += [detector.step(k / 5.0, press(3.4, 3.0 + 0.08 * (k - 3))).slipping for k in (3, 4)]
    assert told == [False] * 4 + [True]


def test_a_lost_frame_of_a_slow_recording_hides_no_slip() -> None:
    detector, told = SlipDetector(SIDE, SIDE, PITCH_M), []
    for k in (0, 1, 2, 3, 4, 5, 7):
        told.append(detector.step(k / 9.0, press(3.4, 3.0 + 0.08 * max(k - 5, 0))).slipping)
    assert told == [False] * 6 + [True]


def test_an_image_of_the_time_of_the_one_before_begins_nothing_anew() -> None:
    """So stamps are that lie a nanosecond apart."""
    detector = SlipDetector(SIDE, SIDE, PITCH_M)
    found = [detector.step(1.7e9 + 1e-3 * number, press(3.5, 3.0 + 0.01 * number)) for number in range(80)]
    same = detector.step(1.7e9 + 1e-3 * 79, press(3.5, 3.8))
    after = detector.step(1.7e9 + 1e-3 * 80, press(3.5, 3.8))
    assert [slip.slipping for slip in (found[-1], same, after)] == [True] * 3
