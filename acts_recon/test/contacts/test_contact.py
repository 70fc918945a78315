# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import math

import numpy as np
import pytest
from blobs_reference import find_blobs
from contact_reference import find_contact
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as st_numpy
from numpy.typing import NDArray
from recon_samples import bump

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, MeasuredForceResponse, force_table
from acts_recon.contacts import Contact, contact_kernels
from acts_recon.contacts.contact import NO_CONTACT
from acts_recon.contacts.grid import Grid, Thresholds

pytestmark = pytest.mark.slow

GEOMETRY = ArrayGeometry(rows=12, cols=9, pitch_m=0.005)
RESPONSE = ForceResponse()
TABLE = force_table(RESPONSE)
# What the kernel looks up, as the reference implementation reads it: exactly the same response between two counts, too.
BY_TABLE = MeasuredForceResponse(TABLE[:-1], np.arange(1024.0))


def by_kernel(
    image: NDArray[np.float32],
    geometry: ArrayGeometry,
    touch_counts: float,
    sigma: NDArray[np.float32] | None = None,
    noise_counts: float = 2.0,
) -> list[float]:
    results = np.zeros(contact_kernels.RESULTS)
    contact_kernels.find_contact(
        image.ravel(),
        np.empty(0, np.float32) if sigma is None else sigma.ravel(),
        Grid.of(geometry, RESPONSE),
        Thresholds(touch_counts, noise_counts, 3.0),
        results,
    )
    return results.tolist()


def assert_kernel_equals_twin(
    image: NDArray[np.float32],
    touch_counts: float,
    sigma: NDArray[np.float32] | None = None,
    noise_counts: float = 2.0,
) -> None:
    found = Contact(True, *by_kernel(image, GEOMETRY, touch_counts, sigma, noise_counts))  # type: ignore[arg-type]
    contact = find_contact(
        image,
        GEOMETRY,
        BY_TABLE,
        touch_counts=touch_counts,
        sigma=sigma,
        noise_counts=noise_counts,
        err_together=3.0,
    )
    assert found.active_taxels == contact.active_taxels
    assert found.peak_counts == contact.peak_counts
    assert found.area_m2 == pytest.approx(contact.area_m2)
    assert found.force_n == pytest.approx(contact.force_n, rel=1e-6)
    assert found.x_m == pytest.approx(contact.x_m, abs=1e-7)
    assert found.y_m == pytest.approx(contact.y_m, abs=1e-7)
    assert found.spread_m == pytest.approx(contact.spread_m, abs=1e-6)
    assert found.x_sd_m == pytest.approx(contact.x_sd_m, rel=1e-4, abs=1e-8)
    assert found.y_sd_m == pytest.approx(contact.y_sd_m, rel=1e-4, abs=1e-8)
    assert found.force_sd_n == pytest.approx(contact.force_sd_n, rel=1e-4, abs=1e-8)
    assert found.area_sd_m2 == pytest.approx(contact.area_sd_m2, rel=1e-4, abs=1e-9)
    assert found.spread_sd_m == pytest.approx(contact.spread_sd_m, rel=1e-3, abs=1e-6)


def test_nothing_pressed_is_all_zero() -> None:
    image = np.full((12, 9), 60, dtype=np.float32)
    assert find_contact(image, GEOMETRY, RESPONSE) == NO_CONTACT == Contact()
    assert by_kernel(image, GEOMETRY, 60.0) == [0.0] * contact_kernels.RESULTS


def test_one_taxel() -> None:
    image = np.zeros((12, 9), dtype=np.float32)
    image[2, 7] = 400
    contact = find_contact(image, GEOMETRY, RESPONSE)
    assert contact.in_contact
    assert contact.x_m == pytest.approx(3 * 0.005)
    assert contact.y_m == pytest.approx(3.5 * 0.005)
    assert contact.force_n == pytest.approx(float(RESPONSE.force_n(400.0)))
    assert contact.peak_counts == 400
    assert contact.area_m2 == pytest.approx(25e-6)
    assert (contact.active_taxels, contact.spread_m) == (1, 0)


def test_the_centre_is_weighted_by_force() -> None:
    forces = np.zeros((12, 9))
    forces[5, 2], forces[5, 6] = 0.1, 0.9
    contact = find_contact(RESPONSE.counts(forces), GEOMETRY, RESPONSE)
    assert contact.x_m == pytest.approx(float(GEOMETRY.x_m(2 * 0.1 + 6 * 0.9)))
    assert contact.force_n == pytest.approx(1.0)
    # Two points at distances 3.6 and 0.4 taxels.
    assert contact.spread_m == pytest.approx(0.005 * math.sqrt(0.1 * 3.6**2 + 0.9 * 0.4**2))


def test_kernel_equals_reference_on_a_bump() -> None:
    assert_kernel_equals_twin(bump(GEOMETRY, 5.3, 4.1).astype(np.float32), 60)


@settings(max_examples=100, deadline=None)
@given(
    st_numpy.arrays(np.float32, (12, 9), elements=st.floats(0, 1023, width=32)),
    st.none() | st_numpy.arrays(np.float32, (12, 9), elements=st.floats(0, 300, width=32)),
    st.integers(0, 1023),
)
def test_kernel_equals_reference_and_all_is_finite(
    image: NDArray[np.float32], sigma: NDArray[np.float32] | None, touch_counts: int
) -> None:
    assert np.isfinite(by_kernel(image, GEOMETRY, touch_counts, sigma)).all()
    contact = find_contact(image, GEOMETRY, RESPONSE, touch_counts=touch_counts)
    numbers = (contact.x_m, contact.y_m, contact.force_n, contact.peak_counts, contact.area_m2, contact.spread_m)
    assert np.isfinite(numbers).all()
    assert_kernel_equals_twin(image, touch_counts, sigma, noise_counts=20.0)


@pytest.mark.parametrize("touch_counts", [0, 37])
def test_kernel_equals_reference_where_a_taxel_may_be_missed(touch_counts: int) -> None:
    image = np.full((12, 9), touch_counts + 1, dtype=np.float32)
    image[0, 0] = 0
    for deviation in (0.5, 6, 6.1667, 7, 30):
        sigma = np.zeros_like(image)
        sigma[0, 0] = deviation
        assert_kernel_equals_twin(image, touch_counts, sigma, noise_counts=20.0)


def test_one_contact_is_as_uncertain_as_the_only_one_in_the_image() -> None:
    image = bump(GEOMETRY, 5.3, 4.1).astype(np.float32)
    sigma = np.full(image.shape, 5, dtype=np.float32)
    contact = find_contact(image, GEOMETRY, RESPONSE, sigma=sigma)
    (blob,) = find_blobs(image, GEOMETRY, RESPONSE, sigma=sigma)
    deviations = contact.x_sd_m, contact.y_sd_m, contact.force_sd_n
    assert deviations == pytest.approx([math.sqrt(variance) for variance in (blob.x_var, blob.y_var, blob.force_var)])
    assert contact.area_sd_m2 == pytest.approx(math.sqrt(blob.taxels_var) * GEOMETRY.taxel_area_m2)
    assert contact.spread_sd_m > 0
    assert find_contact(image, GEOMETRY, RESPONSE).force_sd_n == 0
