# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Each touch that has begun is over once, whatever the images are of."""

from __future__ import annotations

import math

import numpy as np
import pytest
from told_impacts import SAMPLE_S, Array, bump, told_of

from acts_core.array import ArrayGeometry
from acts_core.sampling import SamplingConfig
from acts_core.skin import ForceResponse, MeasuredForceResponse
from acts_recon.impacts import UNKNOWN_DIRECTION_SD_RAD, Impact, ImpactConfig, ImpactDetector, Kind
from acts_recon.impacts.footprint_fit import fit_footprint
from acts_recon.impacts.onset_fit import follow_back
from acts_recon.impacts.samples import RecentSamples
from acts_recon.impacts.touch import Touch
from acts_recon.settings import ReconstructionSettings

# A taxel that reads 100 counts before it is pressed.
FLAT = MeasuredForceResponse(np.array([0.0, 1.0, 5.0]), np.array([100.0, 300.0, 900.0]))


@pytest.mark.parametrize("scheme", ["tracking", "adaptive"])
@pytest.mark.parametrize("m", [55, 128])
def test_a_bounce_beside_a_body_that_rests_is_over(scheme: str, m: int) -> None:
    """It stood among those that are a part of another: its taxels read pressed for a moment, as the other does."""
    ball = 700 * bump(32, 32, 10, 8, 2.0)
    body = 400 * bump(32, 32, 10, 22, 1.5)
    onset_s, contact_s = 0.2, 0.008

    def pressure(time_s: float) -> Array:
        since_s = time_s - onset_s
        return body + (ball * math.sin(math.pi * since_s / contact_s) if 0 < since_s < contact_s else 0.0)

    settings = ReconstructionSettings(touch_counts=25)
    told = told_of(settings, SamplingConfig(scheme, 32, 32, m, threshold_counts=25), pressure, 0.3)
    x_m = float(ArrayGeometry().x_m(8))
    balls = [one for one in told if abs(one.x_m - x_m) < 0.02 and one.onset_s > 100.15]
    assert [one.is_over for one in balls] == [False, True]
    assert (balls[1].number, balls[1].kind) == (balls[0].number, Kind.IMPACT)
    assert balls[1].onset_s == pytest.approx(100.0 + onset_s, abs=0.0015)


@pytest.mark.parametrize("lost_from_s", [0.202, 0.204, 0.206, 0.208])
@pytest.mark.parametrize("lost_for_s", [0.03, 0.08, 0.15])
def test_a_bounce_is_an_impact_also_where_the_frames_after_it_are_lost(lost_from_s: float, lost_for_s: float) -> None:
    ball = 700 * bump(32, 32, 10, 8, 2.0)
    onset_s, contact_s = 0.2, 0.008

    def pressure(time_s: float) -> Array:
        since_s = time_s - onset_s
        return ball * (math.sin(math.pi * since_s / contact_s) if 0 < since_s < contact_s else 0.0)

    settings = ReconstructionSettings(touch_counts=25)
    sampling = SamplingConfig("tracking", 32, 32, 64, threshold_counts=25)
    told = told_of(settings, sampling, pressure, 0.45, (lost_from_s, lost_from_s + lost_for_s))
    assert [(one.is_over, one.kind) for one in told] == [(False, Kind.UNKNOWN), (True, Kind.IMPACT)]


@pytest.mark.parametrize(("scheme", "m"), [("hybrid", 55), ("random", 55), ("random", 128), ("adaptive", 55)])
def test_what_rests_for_long_is_over_once(scheme: str, m: int) -> None:
    """Where a frame measured none of it but its rim, it was taken for gone."""
    palm, finger = 500 * bump(32, 32, 20, 16, 4.0), 400 * bump(32, 32, 6, 8, 1.5)

    def pressure(time_s: float) -> Array:
        return min(max((time_s - 0.2) / 0.03, 0.0), 1.0) * (palm + finger) * (time_s < 2.0)

    settings = ReconstructionSettings(touch_counts=25)
    told = told_of(settings, SamplingConfig(scheme, 32, 32, m, threshold_counts=25), pressure, 2.2)
    over = [one for one in told if (one.is_over and one.onset_s > 100.25) or one.duration_s > 0.1]
    assert [one.duration_s for one in over] == pytest.approx([1.8] * len(over), abs=0.03)
    assert {one.kind for one in over} <= {Kind.PRESS, Kind.STEP}
    assert len(over) == (1 if scheme == "adaptive" else 2)  # with few samples the two lie near enough to be one


@pytest.mark.parametrize(("scheme", "m"), [("tracking", 55), ("hybrid", 55), ("random", 128), ("adaptive", 55)])
def test_each_touch_that_begins_is_over_or_joins_another(scheme: str, m: int) -> None:
    """A palm begins in several places that grow together: those that did were never told of again."""
    palm, finger = 500 * bump(32, 32, 20, 16, 4.0), 400 * bump(32, 32, 6, 8, 1.5)

    def pressure(time_s: float) -> Array:
        return min(max((time_s - 0.2) / 0.03, 0.0), 1.0) * (palm + finger) * (time_s < 0.5)

    settings = ReconstructionSettings(touch_counts=25)
    told = told_of(settings, SamplingConfig(scheme, 32, 32, m, threshold_counts=25), pressure, 0.6)
    ends = {one.number: one for one in told if one.is_over or one.joined}
    begun = [one.number for one in told if not (one.is_over or one.joined)]
    assert sorted(begun) == sorted(ends)
    assert len(told) == 2 * len(begun)
    joined = [one for one in ends.values() if one.joined]
    assert joined or scheme == "adaptive"  # with few samples the palm begins in one place
    for one in joined:
        assert (one.is_over, one.kind) == (False, Kind.UNKNOWN)
        assert ends[one.joined].onset_s + ends[one.joined].duration_s >= one.onset_s + one.duration_s
        assert 0.0 <= one.duration_s < 0.05


@pytest.mark.parametrize(("scheme", "m"), [("tracking", 64), ("adaptive", 64), ("random", 64), ("raster", 1024)])
@pytest.mark.parametrize("width", [0.8, 4.0])
def test_what_rests_when_frames_begin_to_come_has_not_begun_then(scheme: str, m: int, width: float) -> None:
    """It was told to have begun with the first frame, exact to a third of a millisecond."""
    body = 400 * bump(32, 32, 10, 22, width)
    settings = ReconstructionSettings(touch_counts=25)
    sampling = SamplingConfig(scheme, 32, 32, m, threshold_counts=25)
    assert told_of(settings, sampling, lambda time_s: body * (time_s < 0.3), 0.4) == []


@pytest.mark.parametrize(("scheme", "m"), [("tracking", 64), ("adaptive", 64), ("raster", 1024)])
def test_what_touches_while_nothing_comes_for_long_is_told_no_second_time(scheme: str, m: int) -> None:
    body = 400 * bump(32, 32, 10, 22, 1.5)
    settings = ReconstructionSettings(touch_counts=25)
    sampling = SamplingConfig(scheme, 32, 32, m, threshold_counts=25)

    def pressure(time_s: float) -> Array:
        return body * (0.2 < time_s < 1.1 or 1.2 < time_s < 1.3)

    told = told_of(settings, sampling, pressure, 1.4, (0.3, 0.9))
    # Of the first nobody knows when it was over; the next is told as ever.
    assert [(one.is_over, one.kind) for one in told] == [
        (False, Kind.UNKNOWN),
        (False, Kind.UNKNOWN),
        (True, Kind.TAP),
    ]
    assert [one.onset_s for one in told] == pytest.approx([100.2, 101.2, 101.2], abs=0.02)


@pytest.mark.parametrize("began_s", [0.30, 0.32, 0.34, 0.36])
def test_a_tap_that_one_frame_of_a_large_array_sees_is_no_impact(began_s: float) -> None:
    settings = ReconstructionSettings(rows=64, cols=64, touch_counts=25)
    recovery = settings.recovery()
    detector = settings.impact_detector(recovery)
    finger, taxels = 400 * bump(64, 64, 30, 30, 2.0).ravel(), np.arange(4096, dtype=np.uint16)
    frame_s = taxels.size * SAMPLE_S
    told: list[Impact] = []
    for number in range(10):
        time_s = number * frame_s + (taxels + 1) * SAMPLE_S
        share = np.clip(np.minimum(time_s - began_s, began_s + 0.08 - time_s) / 0.01, 0.0, 1.0)
        end_s = 100.0 + float(time_s[-1])
        recovery.step(taxels, np.rint(finger * share).astype(np.uint16), end_s, frame_s)
        told += detector.step(end_s, frame_s, recovery.image, recovery.sigma, recovery.age_s, recovery.measured)
    assert [(one.is_over, one.kind, one.bounced) for one in told] == [
        (False, Kind.UNKNOWN, False),
        (True, Kind.TAP, False),
    ]


@pytest.mark.parametrize(("rows", "cols"), [(1, 32), (32, 1)])
def test_on_a_single_row_of_taxels_no_direction_is_known(rows: int, cols: int) -> None:
    middle = (rows - 1) / 2, (cols - 1) / 2

    def pressure(time_s: float) -> Array:
        share = (time_s - 0.05) / 0.008
        if not 0 < share < 1:
            return np.zeros((rows, cols))
        row, col = (at + 2.4 * share * (size > 1) for at, size in zip(middle, (rows, cols), strict=True))
        return 700 * math.sin(math.pi * share) * bump(rows, cols, row, col, 2.5)

    settings = ReconstructionSettings(rows=rows, cols=cols, touch_counts=25)
    begun, over = told_of(settings, SamplingConfig("raster", rows, cols, 32), pressure, 0.1)
    assert (begun.is_over, over.is_over, over.kind) == (False, True, Kind.IMPACT)
    assert (over.velocity_m_s, over.velocity_sd_m_s) == ((0.0, 0.0), (0.0, 0.0))
    assert over.direction_sd_rad == UNKNOWN_DIRECTION_SD_RAD
    assert over.peak_n > 0
    assert np.isfinite([*over.time_s, *over.force_n, *over.path_x_m, *over.path_y_m]).all()


def told_of_a_square(detector: ImpactDetector, counts: float) -> list[Impact]:
    """What is told of images with a touch of 4 x 4 taxels, from 100.050 s on for 150 ms."""
    told: list[Impact] = []
    for number in range(300):
        image = np.zeros((32, 32), dtype=np.float32)
        if 50 <= number < 200:
            image[10:14, 10:14] = counts
        told += detector.step(100.0 + number * 1e-3, 1e-3, image)
    return told


def test_a_long_touch_in_images_alone_is_told() -> None:
    """Without single samples a touch is not followed back to before its first frame."""
    told = told_of_a_square(ImpactDetector(ArrayGeometry()), 300.0)
    assert [(one.is_over, one.kind) for one in told] == [(False, Kind.UNKNOWN), (True, Kind.TAP)]
    assert told[1].onset_s == pytest.approx(100.050, abs=0.0015)
    assert told[1].duration_s == pytest.approx(0.150, abs=0.003)


def test_a_touch_of_which_the_force_response_says_no_force_is_told() -> None:
    told = told_of_a_square(ImpactDetector(ArrayGeometry(), FLAT), 90.0)
    assert [(one.is_over, one.kind) for one in told] == [(False, Kind.UNKNOWN), (True, Kind.TAP)]
    assert told[1].x_m == pytest.approx(ArrayGeometry().x_m(11.5))


def test_a_touch_is_followed_back_where_a_force_response_is_flat() -> None:
    samples = RecentSamples(ArrayGeometry(8, 8), FLAT, 60.0, 1.5, 1.0)
    measured, age_s = np.zeros((8, 8), dtype=np.float32), np.full((8, 8), np.inf, dtype=np.float32)
    age_s[4, 4] = 0.0
    # One of them fell out.
    for number, counts in enumerate([0, 0, 40, 70, 120, 0, 250, 350, 450, 550, 600, 600]):
        measured[4, 4] = counts
        samples.add(100.0 + 0.01 * number, 1e-3, measured, age_s)
    x_m, y_m = (float(at(4)) for at in (ArrayGeometry(8, 8).x_m, ArrayGeometry(8, 8).y_m))
    rise = samples.rise(100.0, 100.2, x_m, y_m, 0, measured, 0.001)
    assert rise is not None
    followed = follow_back(rise)
    assert followed is not None
    assert np.isfinite(followed).all()


def test_what_is_kept_of_frames_whose_stamps_stand_still_is_bounded() -> None:
    """As of a node that leaves them 0: each frame was kept for good."""
    samples = RecentSamples(ArrayGeometry(64, 64), FLAT, 60.0, 1.5, 1.0)
    untouched = np.zeros((64, 64), dtype=np.float32)
    for _ in range(600):
        samples.add(100.0, 1e-3, untouched, untouched)
    kept = samples.untouched_s(0.0, 0.0, 0, 99.0, 101.0).size
    # Those of the newest frames.
    assert 16 * 100 < kept < 21 * 300
    # Where they go on again, so does this.
    for number in range(600):
        samples.add(100.5 + 0.01 * number, 1e-3, untouched, untouched)
    assert samples.untouched_s(0.0, 0.0, 0, 99.0, 110.0).size == pytest.approx(kept / 254 * 101, rel=0.02)


@pytest.mark.parametrize(("pitch_m", "row_pitch_m"), [(0.005, 0.005), (0.010, 0.002), (0.002, 0.010)])
def test_taxels_around_a_place_are_as_many_whatever_their_pitches(pitch_m: float, row_pitch_m: float) -> None:
    geometry = ArrayGeometry(12, 12, pitch_m, row_pitch_m)
    samples = RecentSamples(geometry, FLAT, 60.0, 1.5, 1.0)
    untouched = np.zeros((12, 12), dtype=np.float32)
    samples.add(100.0, 1e-3, untouched, untouched)
    x_m, y_m = float(geometry.x_m(6)), float(geometry.y_m(6))
    assert samples.untouched_s(x_m, y_m, 0, 99.0, 101.0).size == 21


def test_a_touch_begins_once_also_where_frames_are_longer_apart_than_an_impact_lasts() -> None:
    detector = ReconstructionSettings(touch_counts=25).impact_detector(ReconstructionSettings().recovery())
    told: list[Impact] = []
    for number in range(30):
        image = np.zeros((32, 32), dtype=np.float32)
        image[16, 16] = 300.0 * (10 <= number < 20)
        told += detector.step(0.2 * number, 0.1, image, None, np.zeros_like(image), image)
    assert [(one.number, one.is_over) for one in told] == [(1, False), (1, True)]


def test_of_a_long_impact_in_many_frames_none_is_left_out() -> None:
    """Of 0.4 s at 2 kHz only the first 512 frames were kept, and the force was taken to fall from there on."""
    detector = ImpactDetector(ArrayGeometry(), config=ImpactConfig(impact_longest_s=0.5, impact_rise_s=0.5))
    period_s, force = 5e-4, ForceResponse()
    told: list[Impact] = []
    impulse_n_s = 0.0
    for number in range(1000):
        share = (number - 50) / 800
        image = np.zeros((32, 32), dtype=np.float32)
        # It is hardest late.
        image[10:14, 10:14] = np.rint(900 * share**0.5) if 0 < share < 1 else 0.0
        pressed = float(image[10, 10])
        impulse_n_s += 16 * float(force.force_n(pressed)) * period_s * (pressed > 60)
        told += detector.step(100.0 + number * period_s, period_s, image)
    begun, over = told
    assert (begun.is_over, over.is_over, over.kind) == (False, True, Kind.IMPACT)
    assert over.time_s[-1] - over.time_s[0] == pytest.approx(over.duration_s, abs=2e-3)
    assert over.impulse_n_s == pytest.approx(impulse_n_s, rel=0.02)


def test_two_forces_that_are_next_to_equal_tell_no_onset() -> None:
    force_n = np.array([0.2, np.nextafter(0.2, 1.0)])
    with np.errstate(all="raise"):
        onset_s, onset_sd_s = Touch(1, 0, 1.0, 0.999).onset(np.zeros(0), (np.array([1.0, 1.001]), force_n))
    assert (onset_s, onset_sd_s) == pytest.approx((0.9995, 0.001 / math.sqrt(12)))


def test_samples_of_one_moment_tell_no_footprint() -> None:
    rows, cols = np.indices((4, 4), dtype=np.float64).reshape(2, 16)
    # As near each other as two numbers can be at the time of today.
    time_s = 1.7e9 + np.arange(16) % 2 * np.spacing(1.7e9)
    x_m, y_m = 0.005 * cols, 0.005 * rows
    assert fit_footprint(time_s, x_m, y_m, np.ones(16), np.full(16, 0.1), np.arange(16), 2, 2.5e-5) is None


@pytest.mark.parametrize("since_s", [0.0, 1.7e9])
@pytest.mark.parametrize("span_s", [1e-4, 1e-3])
def test_no_variance_of_a_velocity_is_below_0(span_s: float, since_s: float) -> None:
    """Where one taxel reads all of the force, nothing is known of a velocity: its deviation was not a number."""
    rows, cols = np.indices((5, 5), dtype=np.float64).reshape(2, 25)
    force_n, noise_n = np.full(25, 0.01), np.full(25, 6e-4)
    force_n[12], noise_n[12] = 30.0, 4.6
    time_s = since_s + np.linspace(0.0, span_s, 25)
    fitted = fit_footprint(time_s, 4.4e-3 * cols, 4.4e-3 * rows, force_n, noise_n, np.arange(25), 1, 1.9e-5)
    assert fitted is not None
    assert np.diag(fitted.covariance).min() >= 0.0
    assert not math.isnan(fitted.direction_sd_rad)


def test_a_touch_joins_none_that_is_no_touch() -> None:
    """What an image shows without a sample is no touch, and nothing goes on as that."""
    detector = ReconstructionSettings(touch_counts=25).impact_detector(ReconstructionSettings().recovery())
    told: list[Impact] = []
    for number in range(30):
        image, age_s = (np.full((32, 32), value, dtype=np.float32) for value in (0.0, 1.0))
        measured = np.zeros((32, 32), dtype=np.float32)
        age_s[0, 0] = age_s[16, 16] = 0.0
        if 10 <= number < 20:
            image[16, 16] = measured[16, 16] = 300.0
        if number == 15:
            age_s[16, 16] = 0.001
            image[4:28, 14:32] = 300.0
        told += detector.step(100.0 + 1e-3 * number, 5e-4, image, None, age_s, measured)
    assert [(one.number, one.is_over, one.joined) for one in told] == [(1, False, 0), (1, True, 0)]


@pytest.mark.parametrize("same", [10, 11, 15])
def test_a_touch_begins_and_goes_on_in_a_frame_of_the_time_of_the_one_before(same: int) -> None:
    """So stamps are that lie a nanosecond apart, as of a driver whose estimate of the delay becomes shorter."""
    detector = ReconstructionSettings(touch_counts=25).impact_detector(ReconstructionSettings().recovery())
    told: list[Impact] = []
    for number in range(30):
        image = np.zeros((32, 32), dtype=np.float32)
        image[16, 16] = 300.0 * (10 <= number < 20)
        time_s = 1.7e9 + 1e-3 * (number - (number == same))
        told += detector.step(time_s, 5e-4, image, None, np.zeros_like(image), image)
    assert [(one.number, one.is_over) for one in told] == [(1, False), (1, True)]
    assert 1e-4 < told[0].onset_sd_s < 1e-3
