# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The pressed field: kernel against its reference implementation, centre of pressure, force, size."""

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.sampling import measure_in
from acts_core.sampling.schemes.adaptive import adaptive
from acts_core.skin import ForceResponse
from acts_sim.ball.ball import BallConfig
from acts_sim.ball.ball_contact import BallContact, ContactConfig, depth_m
from acts_sim.ball.ball_kernels import SPREAD_OFFSETS, SPREAD_WEIGHTS, SUBPOINTS
from acts_sim.ball.world import WorldConfig

GEOMETRY = ArrayGeometry()
CONFIG = ContactConfig()
RADIUS_M = BallConfig().radius_m
LOAD_N = BallConfig().mass_kg * 9.80665
RESPONSE = ForceResponse()


def forces_n(
    config: ContactConfig, geometry: ArrayGeometry, radius_m: float, x_m: float, y_m: float, load_n: float
) -> NDArray[np.float64]:
    """Force on every taxel; reference implementation of `acts_sim.ball.ball_kernels.press`.

    Parameters
    ----------
    config : ContactConfig
    geometry : ArrayGeometry
    radius_m : float
        Of the ball.
    x_m, y_m : float
        Position of the ball in the skin's frame [m].
    load_n : float
        Normal force between ball and skin [N].

    Returns
    -------
    np.ndarray [shape=(rows, cols), dtype=float64]
        Forces [N].
    """
    depth = depth_m(config, radius_m, load_n)
    total = np.zeros((geometry.rows, geometry.cols))
    sub = (np.arange(SUBPOINTS) + 0.5) / SUBPOINTS - 0.5
    sub_x, sub_y = sub * geometry.pitch_m, sub * geometry.pitch_y_m
    col_x, row_y = geometry.x_m(np.arange(geometry.cols)), geometry.y_m(np.arange(geometry.rows))
    for offset_x, weight_x in zip(SPREAD_OFFSETS, SPREAD_WEIGHTS, strict=True):
        for offset_y, weight_y in zip(SPREAD_OFFSETS, SPREAD_WEIGHTS, strict=True):
            x = (col_x[:, None] + sub_x + offset_x * config.foam_spread_m) - x_m
            y = (row_y[:, None] + sub_y + offset_y * config.foam_spread_m) - y_m
            rise = depth - (x[None, :, None, :] ** 2 + y[:, None, :, None] ** 2) / (2 * radius_m)
            total += weight_x * weight_y * np.maximum(rise, 0.0).mean(axis=(2, 3))
    return config.foam_stiffness_n_per_m3 * geometry.taxel_area_m2 * total


def contact(config: ContactConfig = CONFIG, geometry: ArrayGeometry = GEOMETRY) -> BallContact:
    return BallContact(config, geometry, RADIUS_M)


def centre_m(field_n: np.ndarray, geometry: ArrayGeometry = GEOMETRY) -> tuple[float, float]:
    x, y = geometry.x_m(np.arange(geometry.cols)), geometry.y_m(np.arange(geometry.rows))
    return float((field_n.sum(axis=0) * x).sum() / field_n.sum()), float(
        (field_n.sum(axis=1) * y).sum() / field_n.sum()
    )


@pytest.mark.parametrize("geometry", [GEOMETRY, ArrayGeometry(20, 33, 0.003, 0.005), ArrayGeometry(1, 1, 0.05)])
def test_the_kernel_equals_its_plain_twin_everywhere(geometry: ArrayGeometry) -> None:
    """Also at and beyond the edges, lightly and heavily loaded."""
    under = contact(geometry=geometry)
    rng = np.random.default_rng(0)
    half_x, half_y = geometry.cols * geometry.pitch_m / 2, geometry.rows * geometry.pitch_y_m / 2
    for _ in range(200):
        x_m, y_m = rng.uniform(-1.3, 1.3) * half_x, rng.uniform(-1.3, 1.3) * half_y
        load_n = 10 ** rng.uniform(-2, 2)
        under.press(x_m, y_m, load_n)
        plain = RESPONSE.counts(forces_n(CONFIG, geometry, RADIUS_M, x_m, y_m, load_n))
        np.testing.assert_allclose(under.counts, plain, rtol=1e-9, atol=1e-9)


def test_the_centre_of_pressure_is_the_ball() -> None:
    """Force weighted, from the counts, within 0.05 taxels wherever the contact is whole."""
    under = contact()
    rng = np.random.default_rng(1)
    for _ in range(500):
        x_m, y_m = rng.uniform(-0.05, 0.05, 2)
        under.press(x_m, y_m, LOAD_N)
        cop_x_m, cop_y_m = centre_m(RESPONSE.force_n(under.counts))
        assert abs(cop_x_m - x_m) < 0.05 * GEOMETRY.pitch_m
        assert abs(cop_y_m - y_m) < 0.05 * GEOMETRY.pitch_m


@pytest.mark.parametrize("load_n", [0.5, 2.0, LOAD_N, 20.0])
def test_the_taxels_carry_the_load(load_n: float) -> None:
    total = forces_n(CONFIG, GEOMETRY, RADIUS_M, 0.0123, -0.0345, load_n).sum()
    assert total == pytest.approx(load_n, rel=0.01)


def test_large_taxels_carry_the_load_wherever_the_ball_is() -> None:
    pitch_m = WorldConfig(pitch_m=0.1).geometry.pitch_m  # the largest
    under = contact(geometry=ArrayGeometry(8, 8, pitch_m))
    rng = np.random.default_rng(3)
    for x_m, y_m in rng.uniform(-1.5 * pitch_m, 1.5 * pitch_m, (200, 2)):
        under.press(x_m, y_m, LOAD_N)
        assert RESPONSE.force_n(under.counts).sum() == pytest.approx(LOAD_N, rel=0.2)


def test_the_footprint_is_about_five_taxels_and_wide_enough_for_the_neighbour_search() -> None:
    circle_m = 2 * np.sqrt(2 * RADIUS_M * depth_m(CONFIG, RADIUS_M, LOAD_N))
    assert 0.020 < circle_m < 0.024
    under = contact()
    for x_m in np.linspace(0, GEOMETRY.pitch_m, 5):
        under.press(float(x_m), 0.0, LOAD_N)
        above = under.counts > 180
        assert 15 <= above.sum() <= 30
        assert 4 <= above.any(axis=0).sum() <= 6
        assert under.counts.max() < 800


def test_adaptive_sampling_finds_the_ball_at_the_centre_and_in_most_other_places() -> None:
    under = contact()
    rng = np.random.default_rng(2)
    found = []
    for x_m, y_m in rng.uniform(-0.055, 0.055, (300, 2)):
        under.press(x_m, y_m, LOAD_N)
        _, counts = adaptive(measure_in(np.rint(under.counts).astype(int)), 32, 32, 55)
        found.append(bool((counts > 180).any()))
    assert np.mean(found) > 0.8
    for x_m, y_m in rng.uniform(-0.003, 0.003, (50, 2)):
        under.press(x_m, y_m, LOAD_N)
        pressed = np.rint(under.counts).astype(int)
        indices, _ = adaptive(measure_in(pressed), 32, 32, 55)
        assert (pressed.ravel()[indices] > 180).sum() == (pressed > 180).sum()


@pytest.mark.parametrize(("softer", "share"), [(1.0, 0.86), (2.0, 0.92)])
def test_adaptive_sampling_misses_the_ball_in_gaps(softer: float, share: float) -> None:
    """The figures of docs/simulation.md: a ball at rest at each second millimetre within 50 mm of the centre."""
    config = ContactConfig(foam_stiffness_n_per_m3=CONFIG.foam_stiffness_n_per_m3 / softer)
    under = BallContact(config, GEOMETRY, RADIUS_M)

    def is_found(x_m: float, y_m: float) -> bool:
        under.press(x_m, y_m, LOAD_N)
        _, counts = adaptive(measure_in(np.rint(under.counts).astype(int)), 32, 32, 55)
        return bool((counts > 180).any())

    places_m = np.linspace(-0.050, 0.050, 51).tolist()
    assert np.mean([is_found(x_m, y_m) for x_m in places_m for y_m in places_m]) == pytest.approx(share, abs=0.005)
    if softer == 1.0:
        for row, col in ((8, 16), (16, 12), (16, 20), (24, 16)):
            assert not is_found(float(GEOMETRY.x_m(col)), float(GEOMETRY.y_m(row)))


def test_a_symmetric_press_gives_a_symmetric_field() -> None:
    under = contact()
    under.press(0.0, 0.0, LOAD_N)
    field = under.counts.copy()
    np.testing.assert_allclose(field, field[::-1], rtol=1e-12)
    np.testing.assert_allclose(field, field[:, ::-1], rtol=1e-12)
    np.testing.assert_allclose(field, field.T, rtol=1e-12)


def test_y_points_up_in_the_picture() -> None:
    under = contact()
    under.press(0.03, 0.03, LOAD_N)
    row, col = np.unravel_index(under.counts.argmax(), under.counts.shape)
    assert row < 16 <= col


def test_a_harder_press_reads_more_and_none_reads_nothing() -> None:
    under = contact()
    sums = []
    for load_n in (0.0, 1.0, 3.0, 9.0):
        under.press(0.01, 0.01, load_n)
        sums.append(under.counts.sum())
    assert sums[0] == 0.0
    assert sums == sorted(sums)
    under.press(0.01, 0.01, 0.0)
    assert not under.counts.any(), "the last press is cleared"


def test_far_off_the_pad_nothing_is_pressed() -> None:
    under = contact()
    under.press(1.0, -3.0, LOAD_N)
    assert not under.counts.any()
