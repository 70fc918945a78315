# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Contacts of one image: kernel and reference implementation, and whether their uncertainty is what it says."""

import math
from typing import Any

import numpy as np
import pytest
from blobs_reference import find_blobs
from contact_reference import find_contact, root_deviation
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy
from numpy.typing import NDArray
from recon_samples import bump, layouts

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, Layout, MeasuredForceResponse, force_table
from acts_recon.contacts import BlobConfig, blob_kernels
from acts_recon.contacts.grid import Grid, Thresholds
from acts_recon.images import Borders, borders_of, slope_table

pytestmark = pytest.mark.slow

GEOMETRY = ArrayGeometry(rows=12, cols=9, pitch_m=0.005, row_pitch_m=0.004)
RESPONSE = ForceResponse()
TABLE = force_table(RESPONSE)
# What the kernel looks up, as the reference implementation reads it: exactly the same response between two counts, too.
BY_TABLE = MeasuredForceResponse(TABLE[:-1], np.arange(1024.0))
FIELDS = ("x_m", "y_m", "force_n", "peak_counts", "x_var", "y_var", "force_var", "taxels_var", "spread_square_var")


def by_kernel(
    image: NDArray[np.floating],
    config: BlobConfig,
    geometry: ArrayGeometry = GEOMETRY,
    *,
    sigma: NDArray[np.floating] | None = None,
    before: NDArray[np.bool_] | None = None,
    borders: Borders | None = None,
) -> tuple[list[tuple[NDArray[np.int32], Any]], int]:
    """Taxels and numbers of every contact, and how many were left out."""
    work = blob_kernels.Work.empty(image.size)
    if before is not None:
        work.state[:] = before.ravel()
    n, dropped = blob_kernels.find_blobs(
        image.ravel().astype(np.float32),
        np.empty(0, np.float32) if sigma is None else sigma.ravel().astype(np.float32),
        Grid.of(geometry, RESPONSE, borders),
        Thresholds(float(config.touch_counts), config.noise_counts, config.err_together),
        float(config.release_counts),
        work,
    )
    blobs, members = work.blobs, work.members
    return [(np.sort(members[blob["first"] : blob["last"]]), blob) for blob in blobs[:n]], dropped


@settings(max_examples=150, deadline=None)
@given(
    layouts(12, 9),
    st_numpy.arrays(np.float32, (12, 9), elements=st.floats(0, 1023, width=32), fill=st.just(0.0)),
    st_numpy.arrays(np.float32, (12, 9), elements=st.floats(0, 50, width=32)),
    st_numpy.arrays(np.bool_, (12, 9)),
    st.integers(1, 900),
    st.integers(0, 60),
    st.booleans(),
)
def test_kernel_equals_reference(
    arranged: Layout | None,
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    before: NDArray[np.bool_],
    touch_counts: int,
    hysteresis_counts: int,
    sigma_known: bool,
) -> None:
    config = BlobConfig(
        touch_counts=touch_counts, hysteresis_counts=min(hysteresis_counts, touch_counts - 1), noise_counts=20.0
    )
    deviations = sigma if sigma_known else None
    borders = borders_of(12, 9, arranged)
    expected = find_blobs(image, GEOMETRY, BY_TABLE, config, sigma=deviations, pressed_before=before, borders=borders)
    found, dropped = by_kernel(image, config, sigma=deviations, before=before, borders=borders)
    # The kernel puts a stronger one that comes late in the place of the weakest.
    found.sort(key=lambda one: int(one[0][0]))
    assert len(found) == len(expected)
    assert dropped == 0 or len(found) == blob_kernels.MAX_BLOBS
    for (taxels, blob), reference in zip(found, expected, strict=True):
        assert np.array_equal(taxels, reference.taxels)
        assert np.unique(borders.rectangle_of[taxels]).tolist() == [reference.patch]
        assert blob["taxels"] == reference.active_taxels
        for field in FIELDS:
            assert blob[field] == pytest.approx(getattr(reference, field), rel=1e-5, abs=1e-9), field
        moments = (blob["xx_m2"], blob["xy_m2"], blob["yy_m2"])
        assert moments == pytest.approx(reference.moments_m2, rel=1e-6, abs=1e-12)
        assert sigma_known or blob["x_var"] == blob["y_var"] == blob["force_var"] == blob["taxels_var"] == 0


def test_one_round_contact_is_the_contact_of_the_image() -> None:
    image = bump(GEOMETRY, 5.3, 4.1).astype(np.float32)
    contact = find_contact(image, GEOMETRY, RESPONSE)
    (blob,) = find_blobs(image, GEOMETRY, RESPONSE)
    assert (blob.x_m, blob.y_m) == pytest.approx((contact.x_m, contact.y_m))
    assert (blob.force_n, blob.peak_counts) == pytest.approx((contact.force_n, contact.peak_counts))
    assert blob.taxels.size == contact.active_taxels
    assert math.sqrt(blob.moments_m2[0] + blob.moments_m2[2]) == pytest.approx(contact.spread_m)


def test_corners_join_and_a_gap_parts() -> None:
    image = np.zeros((12, 9), dtype=np.float32)
    image[2, 2] = image[3, 3] = image[3, 5] = 300
    found, _ = by_kernel(image, BlobConfig())
    assert [taxels.tolist() for taxels, _ in found] == [[20, 30], [32]]


def test_a_pressed_taxel_holds_until_it_is_below_the_hysteresis() -> None:
    image = np.zeros((12, 9), dtype=np.float32)
    image[4, 4] = 55
    before = np.zeros((12, 9), dtype=np.bool_)
    config = BlobConfig(touch_counts=60, hysteresis_counts=10)
    assert by_kernel(image, config, before=before)[0] == []
    before[4, 4] = True
    assert len(by_kernel(image, config, before=before)[0]) == 1
    image[4, 4] = 50
    assert by_kernel(image, config, before=before)[0] == []
    assert BlobConfig(touch_counts=5, hysteresis_counts=10).release_counts == 0


def test_taxels_that_only_the_hysteresis_holds_join_but_do_not_count() -> None:
    image = np.zeros((12, 9), dtype=np.float32)
    image[4, 2] = image[4, 4] = 300
    image[4, 3] = 55
    before = np.zeros((12, 9), dtype=np.bool_)
    assert len(by_kernel(image, BlobConfig(), before=before)[0]) == 2
    before[4, 3] = True
    ((taxels, blob),), _ = by_kernel(image, BlobConfig(), before=before)
    contact = find_contact(image, GEOMETRY, RESPONSE)
    assert taxels.tolist() == [38, 39, 40]
    assert (blob["taxels"], blob["force_n"]) == (2, pytest.approx(contact.force_n))


def test_of_too_many_contacts_the_weakest_are_left_out() -> None:
    geometry = ArrayGeometry(rows=16, cols=16)
    image = np.zeros((16, 16), dtype=np.float32)
    image[::2, ::4] = 100 + np.arange(32).reshape(8, 4)  # 32 contacts of a taxel each, growing
    found, dropped = by_kernel(image, BlobConfig(), geometry)
    assert dropped == 32 - blob_kernels.MAX_BLOBS
    assert sorted(blob["peak_counts"] for _, blob in found) == [100 + i for i in range(16, 32)]
    assert [blob.peak_counts for blob in find_blobs(image, geometry, RESPONSE)] == [100 + i for i in range(16, 32)]


def test_the_force_of_a_saturated_taxel_is_the_least_certain() -> None:
    slope = slope_table(TABLE)
    assert slope.shape == (1024,)
    assert (slope > 0).all()
    assert slope[1023] == slope.max()


def test_guesses_are_less_certain_than_readings_of_the_same_deviation() -> None:
    image = bump(GEOMETRY, 5.3, 4.1).astype(np.float32)
    sigma = np.full((12, 9), 10.0)
    variances = []
    for noise_counts in (10.0, 0.0):
        ((_, blob),), _ = by_kernel(image, BlobConfig(noise_counts=noise_counts, err_together=4.0), sigma=sigma)
        variances.append([float(blob[name]) for name in ("x_var", "y_var", "force_var", "taxels_var")])
    readings, guesses = variances
    assert guesses == pytest.approx([4 * variance for variance in readings])


@pytest.mark.parametrize(("width", "peak", "noise"), [(1.5, 700, 5), (0.6, 300, 5), (2.5, 900, 3), (1.5, 700, 20)])
def test_errors_are_as_large_as_the_standard_deviations_say(width: float, peak: float, noise: float) -> None:
    """Monte Carlo: noise of known size on contacts at random places."""
    rng = np.random.default_rng(3)
    geometry = ArrayGeometry(rows=20, cols=20)
    config = BlobConfig(hysteresis_counts=0, noise_counts=noise)
    row, col = np.indices((20, 20))
    squares: dict[str, list[float]] = {"x_m": [], "y_m": [], "force_n": [], "taxels": [], "spread": []}
    for _ in range(600):
        r, c = rng.uniform(8, 11, 2)
        image = peak * np.exp(-((row - r) ** 2 + (col - c) ** 2) / (2 * width**2))
        # Some taxels were measured, others are guessed: noise differs from taxel to taxel.
        sigma = noise * rng.uniform(0.3, 1.0, image.shape)
        noisy = np.clip(image + sigma * rng.standard_normal(image.shape), 0, 1023)
        ((_, true),), _ = by_kernel(image, config, geometry)
        found, _ = by_kernel(noisy, config, geometry, sigma=sigma)
        blob = max((blob for _, blob in found), key=lambda blob: float(blob["force_n"]))
        spread, true_spread = (math.sqrt(one["xx_m2"] + one["yy_m2"]) for one in (blob, true))
        squares["spread"].append(((spread - true_spread) / root_deviation(spread**2, blob["spread_square_var"])) ** 2)
        for name, values in list(squares.items())[:4]:
            variance = blob["x_var" if name == "x_m" else "y_var" if name == "y_m" else name.split("_")[0] + "_var"]
            values.append(float((blob[name] - true[name]) ** 2 / max(variance, 1e-3 if name == "taxels" else 0)))
    for name in ("x_m", "y_m", "force_n", "spread"):
        assert 0.7 < np.sqrt(np.mean(squares[name])) < 1.3, (name, np.sqrt(np.mean(squares[name])))
    within = np.mean(np.array(squares["taxels"]) <= 4)
    assert within > 0.9, within
