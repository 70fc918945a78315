# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Sharpness of a contact: tips and blunt ends pressed into a foam of its own, and the kernel against NumPy."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import SettingsError
from acts_core.skin import ForceResponse, MeasuredForceResponse, force_table, layout, taxels_named
from acts_recon.images import DeadTaxels
from acts_recon.regions import SharpnessConfig
from acts_recon.regions import sharpness_kernels as kernels
from acts_recon.regions.sharpness import Sharpness
from acts_recon.settings import ReconstructionSettings

FINGER = replace(layout("leap_right").patches[2], first_row=0, end_row=8, first_col=0, end_col=8)
RESPONSE = ForceResponse()
NOISE_COUNTS = 1.5
TOLD = 3.0  # as the reflex has it


@cache
def sharpness() -> Sharpness:
    """Made at its first use: numba compiles then, where no cache is."""
    return Sharpness((FINGER,), force_table(RESPONSE), 8.0, NOISE_COUNTS, SharpnessConfig())


@cache
def spread() -> NDArray[np.float64]:
    """A matrix that spreads a column of points sideways by 1 mm."""
    at_m = np.arange(8 * FINE) * FINGER.pitch_m / FINE
    weights = np.exp(-0.5 * ((at_m[:, None] - at_m) / 0.001) ** 2)
    return weights / weights.sum(axis=1).max()


FINE = 8  # points along a taxel


def felt(radius_m: float, depth_m: float, at: tuple[float, float]) -> NDArray[np.float32]:
    """Counts of a bent finger of 8 x 8 taxels that a round end is pressed into, at a place from the middle of one."""
    step_m = FINGER.pitch_m / FINE
    grid = (np.arange(8 * FINE) + 0.5) * step_m
    x, y = np.meshgrid(grid - (4.5 + at[0]) * FINGER.pitch_m, grid - (3.5 + at[1]) * FINGER.pitch_m)
    inside = radius_m**2 - x**2 - y**2
    deep = depth_m - radius_m + np.sqrt(np.maximum(inside, 0.0)) - 0.5 * x**2 / FINGER.radius_m
    pressure = spread() @ np.where(inside > 0.0, 2.5e7 * np.maximum(deep, 0.0), 0.0) @ spread().T
    forces_n = (pressure * step_m**2).reshape(8, FINE, 8, FINE).sum(axis=(1, 3))
    return np.rint(RESPONSE.counts(forces_n)).astype(np.float32)


def by_numpy(image: NDArray[np.float32]) -> float:
    """The same number, plainly, with every place tried."""
    table = force_table(RESPONSE)
    row, col = np.unravel_index(image.argmax(), image.shape)
    window = image[row - 2 : row + 3, col - 2 : col + 3].astype(int)
    force = table[window]
    variance = ((table[window + 1] - table[window]) * NOISE_COUNTS) ** 2
    relative = 2.0 * SharpnessConfig().sharpness_gain_error ** 2 + variance[2, 2] / force[2, 2] ** 2
    misfit = []
    for shape in range(2):
        levels = sharpness()._level_force_n[0, shape]
        level = max(int(np.searchsorted(levels, force[window > 8].sum(), side="right")) - 1, 0)
        share = sharpness()._share[0, shape, level].astype(float)
        expected = np.maximum(share * (force[2, 2] / share[:, :, 2:3, 2:3]), table[0])
        squares = (force - expected) ** 2 / (variance + relative * expected**2)
        squares[:, :, 2, 2] = 0.0
        misfit.append(squares.sum(axis=(2, 3)).min())
    if misfit[0] >= kernels.MISFIT:
        return 0.0
    return max(0.5 * (min(misfit[1], kernels.MISFIT) - misfit[0]), 0.0)


places = st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))


@settings(max_examples=60, deadline=None)
@given(radius_m=st.floats(0.009, 0.05), depth_m=st.floats(0.0, 0.0025), at=places)
def test_what_is_blunt_is_never_taken_for_a_tip(radius_m: float, depth_m: float, at: tuple[float, float]) -> None:
    assert sharpness().of(felt(radius_m, depth_m, at))[0] < TOLD


@settings(max_examples=40, deadline=None)
@given(at=st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)))
def test_a_tip_is_told_before_it_is_two_millimetres_deep(at: tuple[float, float]) -> None:
    # Where four taxels meet it feels as something blunt does, and is told later.
    assert any(sharpness().of(felt(0.0015, depth_m, at))[0] > TOLD for depth_m in np.arange(0.0008, 0.002, 0.0002))


@cache
def broken(words: str) -> tuple[DeadTaxels, Sharpness]:
    """A finger with dead taxels, and its sharpness."""
    dead = DeadTaxels(taxels_named(words, 8, 8), ArrayGeometry(8, 8))
    table = force_table(RESPONSE)
    return dead, Sharpness((FINGER,), table, 8.0, NOISE_COUNTS, SharpnessConfig(), dead)


@pytest.mark.parametrize("words", ["row=4", "col=5", "3,5"])
@settings(max_examples=30, deadline=None)
@given(at=st.tuples(st.floats(-0.2, 0.2), st.floats(-0.2, 0.2)))
def test_a_tip_beside_dead_taxels_is_told(words: str, at: tuple[float, float]) -> None:
    dead, sharp = broken(words)
    told = []
    for depth_m in np.arange(0.0008, 0.0024, 0.0002):
        image = felt(0.0015, depth_m, at)
        dead.fill(image, None)
        told.append(sharp.of(image)[0] > TOLD)
    assert any(told)


@pytest.mark.parametrize("words", ["row=3", "row=4", "col=5", "row=4 col=5", "3,5 2,4", "3,4"])
@settings(max_examples=60, deadline=None)
@given(radius_m=st.floats(0.009, 0.05), depth_m=st.floats(0.0, 0.0025), at=places)
def test_what_is_blunt_is_never_taken_for_a_tip_beside_dead_taxels(
    words: str, radius_m: float, depth_m: float, at: tuple[float, float]
) -> None:
    dead, sharp = broken(words)
    image = felt(radius_m, depth_m, at)
    dead.fill(image, None)
    assert sharp.of(image)[0] < TOLD


@pytest.mark.parametrize("radius_m", [0.0015, 0.004, 0.009, 0.02])
def test_the_search_finds_what_trying_every_place_finds(radius_m: float) -> None:
    rng = np.random.default_rng(1)
    for depth_m in (0.0004, 0.0007, 0.001, 0.0015):
        exact = felt(radius_m, depth_m, tuple(rng.uniform(-0.5, 0.5, 2)))
        noisy = np.maximum(np.rint(exact + NOISE_COUNTS * rng.standard_normal(exact.shape)), 0.0).astype(np.float32)
        if (noisy > 8).sum() <= kernels.MOST_PRESSED:
            assert sharpness().of(noisy)[0] == pytest.approx(by_numpy(noisy), abs=0.3)


def test_at_the_border_and_where_many_taxels_are_pressed_there_is_no_tip() -> None:
    tip = felt(0.0015, 0.0015, (0.0, 0.0))
    assert sharpness().of(tip)[0] > TOLD
    assert sharpness().of(np.roll(tip, 3, axis=0))[0] > TOLD
    assert sharpness().of(np.roll(tip, 4, axis=0))[0] == 0.0
    assert sharpness().of(tip + 60.0)[0] == 0.0
    assert sharpness().of(np.zeros_like(tip))[0] == 0.0


def test_where_the_force_response_says_no_force_for_what_is_pressed_there_is_no_tip() -> None:
    response = MeasuredForceResponse(np.array([0.0, 1.0, 5.0]), np.array([100.0, 300.0, 900.0]))
    image = np.zeros((8, 8), dtype=np.float32)
    image[3, 4] = 90.0
    assert Sharpness((FINGER,), force_table(response), 60.0, NOISE_COUNTS, SharpnessConfig()).of(image) == [0.0]


def test_a_tip_far_finer_than_the_taxels_is_told() -> None:
    # Pressed beyond the edge of its taxel, where the search looks, too, it would not be felt there at all.
    wide = replace(FINGER, pitch_m=0.005, row_pitch_m=0.005, radius_m=0.0)
    config = SharpnessConfig(sharpness_tip_radius_m=1e-4, sharpness_spread_m=1e-5)
    for beside in (0.0, 400.0):
        image = np.zeros((8, 8), dtype=np.float32)
        image[3, 4], image[3, 5] = 500.0, beside
        assert np.isfinite(Sharpness((wide,), force_table(RESPONSE), 8.0, NOISE_COUNTS, config).of(image)).all()


@pytest.mark.parametrize("radius_m", [-0.005, -0.008, -0.03])
@pytest.mark.parametrize("row_radius_m", [0.0, -0.005, 0.01])
def test_a_hollow_patch_may_be_bent_more_than_what_is_blunt(radius_m: float, row_radius_m: float) -> None:
    small = replace(FINGER, pitch_m=0.0015, row_pitch_m=0.0015, radius_m=radius_m, row_radius_m=row_radius_m)
    found = Sharpness((small,), force_table(RESPONSE), 8.0, NOISE_COUNTS, SharpnessConfig())
    assert (np.diff(found._level_force_n, axis=2) > 0.0).all()
    assert np.isfinite(found._share).all()
    assert (found._share >= 0.0).all()
    assert np.isfinite(found.of(felt(0.0015, 0.0015, (0.0, 0.0)))).all()


@pytest.mark.parametrize("kind", [SharpnessConfig, ReconstructionSettings])
def test_a_tip_is_finer_than_what_is_blunt(kind: type) -> None:
    with pytest.raises(SettingsError, match=r"sharpness_tip_radius_m = 0.004: allowed is below .* \(0.004\)"):
        kind(sharpness_tip_radius_m=0.004, sharpness_blunt_radius_m=0.004)


def test_a_line_is_no_tip() -> None:
    edge = felt(0.0015, 0.0015, (0.0, 0.0))
    edge[:] = edge[:, 4:5].max(axis=0, keepdims=True)
    edge[:] = edge.max() * (np.arange(8) == 4)
    assert sharpness().of(edge)[0] == 0.0


def test_footprints_are_forces_and_their_parts() -> None:
    forces_n, share = sharpness()._level_force_n[0], sharpness()._share[0]
    assert (np.diff(forces_n, axis=1) > 0.0).all()
    assert (share >= 0.0).all()
    total = share.sum(axis=(-2, -1))
    assert (total < 1.0 + 1e-5).all()
    # A tip stays within the window, also of the finger's last places.
    assert (total[0] > 0.99).all()
