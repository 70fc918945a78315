# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Dead taxels: their samples are left out, and what presses there is estimated from the taxels around."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from pressed_frames import press
from recon_samples import layouts

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError, SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_core.skin import Layout, layout, taxels_named
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.images import DeadTaxels, borders_of
from acts_recon.images.dead_taxels import LENGTH_TAXELS, NOISE_SHARE
from acts_recon.settings import ReconstructionSettings

SIDE = 16
FRAMES = 50


def kriging(
    dead: NDArray[np.bool_], image: NDArray[np.float32], sigma: NDArray[np.float32], arranged: Layout | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The reference: estimates and deviations of dead taxels by their definition; elsewhere as given."""
    rows, cols = dead.shape
    rectangle_of = borders_of(rows, cols, arranged).rectangle_of.reshape(dead.shape)
    filled, deviations = image.astype(float), sigma.astype(float)
    for row, col in np.argwhere(dead):
        near = [
            (r, c)
            for r in range(max(row - 3, 0), min(row + 4, rows))
            for c in range(max(col - 3, 0), min(col + 4, cols))
            if not dead[r, c] and rectangle_of[r, c] == rectangle_of[row, col]
        ]
        if not near:
            continue
        place, live = np.array([row, col]), np.array(near)
        between = np.exp(-((live[:, None] - live) ** 2).sum(2) / (2 * LENGTH_TAXELS**2))
        to_dead = np.exp(-((live - place) ** 2).sum(1) / (2 * LENGTH_TAXELS**2))
        weights = np.linalg.inv(between + NOISE_SHARE * np.eye(len(live))) @ to_dead
        counts, sigmas = image[tuple(live.T)].astype(float), sigma[tuple(live.T)].astype(float)
        beside = [place for place in near if max(abs(place[0] - row), abs(place[1] - col)) == 1]
        for row_step, col_step in ((0, 1), (0, -1), (1, 0), (-1, 0)):
            way = [(row + row_step * k, col + col_step * k) for k in (1, 2, 3)]
            beside += [place for place in way if place in near][:1]
        most = 2 * max(image[place] for place in beside or near)
        filled[row, col] = np.rint(np.clip(weights @ counts, 0, min(most, 1023)))
        unknown = (1 - weights @ to_dead) * counts.max() ** 2
        deviations[row, col] = np.sqrt((weights**2) @ (sigmas**2) + unknown)
        if 1 - weights @ to_dead > 0.5:
            deviations[row, col] = max(deviations[row, col], sigma[row, col])
    return filled, deviations


@settings(deadline=None)
@given(st.data())
def test_estimates_are_those_of_the_reference_and_live_taxels_stay(data: st.DataObject) -> None:
    rows, cols = data.draw(st.integers(1, 9)), data.draw(st.integers(1, 9))
    arranged = data.draw(layouts(rows, cols))
    rng = np.random.default_rng(data.draw(st.integers(0, 2**32 - 1)))
    in_matrix = rng.random((rows, cols)) < data.draw(st.sampled_from([0.05, 0.3, 0.9]))
    image = rng.integers(0, 1024, (rows, cols)).astype(np.float32)
    sigma = rng.uniform(0, 300, (rows, cols)).astype(np.float32)
    dead = in_matrix if arranged is None else in_matrix.ravel()[arranged.taxels]
    expected, deviations = kriging(dead, image, sigma, arranged)
    taxels = DeadTaxels(in_matrix, ArrayGeometry(rows, cols), arranged)
    filled = image.copy()
    taxels.fill(filled, None)
    with_sigma = image.copy()
    taxels.fill(with_sigma, sigma)
    np.testing.assert_array_equal(filled, with_sigma)
    np.testing.assert_array_equal(filled[~dead], image[~dead])
    # Where an estimate lies half-way between two counts, single precision may round it to the other.
    np.testing.assert_allclose(filled, expected, atol=1)
    np.testing.assert_allclose(sigma, deviations, rtol=1e-3, atol=0.05)


def frame(number: int, image: NDArray[np.uint16], indices: NDArray[np.uint16] | None = None) -> SampleFrame:
    """A frame of all taxels, or of those of some indices."""
    rows, cols = image.shape
    if indices is None:
        indices = np.arange(image.size, dtype=np.uint16)
    return SampleFrame(number, 20_000 * number, 18_000, Scheme.RASTER, rows, cols, 0, indices, image.ravel()[indices])


def recovered(image: NDArray[np.uint16], dead_taxels: str, method: str = "fusion") -> FrameRecovery:
    """A skin that is pressed like this for some frames."""
    rows, cols = image.shape
    recovery = FrameRecovery(ReconstructionSettings(rows=rows, cols=cols, dead_taxels=dead_taxels, method=method))
    for number in range(1, FRAMES + 1):
        recovery.step(frame(number, image), 20_000_000 * number)
    return recovery


@pytest.mark.parametrize("method", ["fusion", "per_frame"])
def test_a_contact_across_a_dead_row_is_one_where_it_is(method: str) -> None:
    words = "row=7"
    truth = press(6.3, 8.2, 1.6, 700, (SIDE, SIDE))
    broken = np.where(taxels_named(words, SIDE, SIDE), np.uint16(0), truth)
    sound, told, untold = recovered(truth, "", method), recovered(broken, words, method), recovered(broken, "", method)
    assert (len(sound.blobs), len(told.blobs), len(untold.blobs)) == (1, 1, 2)
    pitch_m = sound.recovery.geometry.pitch_m
    off, off_untold = (
        np.hypot(of.contact.x_m - sound.contact.x_m, of.contact.y_m - sound.contact.y_m) / pitch_m
        for of in (told, untold)
    )
    assert off < 0.05
    assert off_untold > 0.1
    assert told.contact.force_n == pytest.approx(sound.contact.force_n, rel=0.08)
    assert untold.contact.force_n < 0.85 * sound.contact.force_n


def test_what_is_estimated_is_less_sure_than_what_is_measured() -> None:
    recovery = recovered(press(7.5, 7.5, 1.6, 700, (SIDE, SIDE)), "row=7").recovery
    assert recovery.sigma is not None
    confidence = recovery.confidence()
    assert confidence is not None
    assert recovery.sigma[7, 7] > 10 * recovery.sigma[6, 7]
    assert confidence[7, 7] < confidence[6, 7]
    # Far from all touch there is nothing to be unsure of.
    assert recovery.sigma[7, 0] < 10


@pytest.mark.parametrize("last", [7, 9, 12])
def test_what_is_far_from_all_live_taxels_is_not_known(last: int) -> None:
    words = " ".join(f"row={row}" for row in range(5, last + 1))
    recovery = recovered(np.zeros((SIDE, SIDE), dtype=np.uint16), words).recovery
    confidence = recovery.confidence()
    assert confidence is not None
    assert confidence[(5 + last) // 2, 7] < 10
    assert confidence[4, 7] > 240


@pytest.mark.parametrize("words", ["col=8", "row=3 col=8", "col=8 col=9"])
def test_nothing_is_estimated_beyond_live_taxels_that_read_nothing(words: str) -> None:
    """A small contact three taxels from a dead column was told twice: weights are above 0 again at that distance."""
    dead = taxels_named(words, SIDE, SIDE)
    taxels = DeadTaxels(dead, ArrayGeometry(SIDE, SIDE))
    image = np.zeros((SIDE, SIDE), dtype=np.float32)
    image[9:11, 5] = 900
    image[:, 8:10][dead[:, 8:10]] = 500
    taxels.fill(image, None)
    assert image[:, 6:].max() == 0.0


def test_a_stuck_taxel_is_no_contact() -> None:
    image = np.zeros((SIDE, SIDE), dtype=np.uint16)
    image[4, 9] = 800
    assert recovered(image, "").contact.in_contact
    recovery = recovered(image, "4,9")
    assert not recovery.contact.in_contact
    assert not recovery.recovery.image.any()


def test_taxels_of_another_patch_say_nothing() -> None:
    image = np.zeros((32, 32), dtype=np.uint16)
    arranged = layout("leap_right")
    patch = arranged.patches[0]
    beside = patch.of(np.arange(1024).reshape(32, 32))
    image.ravel()[np.setdiff1d(np.arange(1024), arranged.taxels.ravel()[beside.ravel()])] = 500
    row, col = np.unravel_index(int(arranged.taxels.ravel()[beside[0, 0]]), (32, 32))
    recovery = FrameRecovery(ReconstructionSettings(layout="leap_right", dead_taxels=f"{row},{col}"))
    recovery.step(frame(1, image), 20_000_000)
    assert not patch.of(recovery.recovery.image).any()
    assert recovery.recovery.image.any()


def test_a_frame_of_dead_taxels_alone_is_refused_and_the_next_one_counts() -> None:
    image = press(8, 8, 1.6, 700, (SIDE, SIDE))
    recovery = FrameRecovery(ReconstructionSettings(rows=SIDE, cols=SIDE, dead_taxels="row=2"))
    of_row = np.arange(2 * SIDE, 3 * SIDE, dtype=np.uint16)
    with pytest.raises(ArrayError, match="only dead taxels were measured, index 32 first"):
        recovery.step(frame(1, image, of_row), 20_000_000)
    assert recovery.step(frame(2, image), 40_000_000) == 0
    assert recovery.contact.in_contact
    assert recovery.every is not None
    assert len(recovery.every.indices) == SIDE * (SIDE - 1)


def test_a_baseline_of_a_dead_taxel_that_jumps_renews_no_contact() -> None:
    image = press(11, 8, 1.6, 700, (SIDE, SIDE))
    image[2] = 500
    sound = np.ones(SIDE * SIDE, dtype=np.bool_)
    noise, counts = np.full(SIDE * SIDE, 2.0, dtype=np.float32), np.zeros((SIDE, SIDE), dtype=np.float32)
    numbers = []
    for words in ("row=2", ""):
        recovery = FrameRecovery(ReconstructionSettings(rows=SIDE, cols=SIDE, dead_taxels=words))
        for number in range(1, FRAMES + 1):
            counts[2] = 500 * (number > FRAMES // 2)
            recovery.set_baseline(counts.ravel(), noise, sound)
            recovery.step(frame(number, image), 20_000_000 * number)
        numbers.append([blob.number for blob in recovery.blobs])
    assert numbers[0] == [1]
    assert numbers[1] != [1]


def test_a_dead_taxel_that_is_measured_several_times_is_left_out_each_time() -> None:
    image = press(8, 8, 1.6, 700, (SIDE, SIDE))
    recovery = FrameRecovery(ReconstructionSettings(rows=SIDE, cols=SIDE, dead_taxels="8,8"))
    indices = np.array([8 * SIDE + 8, 8 * SIDE + 9, 8 * SIDE + 8, 8 * SIDE + 9], dtype=np.uint16)
    recovery.step(frame(1, image, indices)._replace(scheme=Scheme.FIXED), 20_000_000)
    assert recovery.every is not None
    assert recovery.frame is not None
    assert recovery.every.indices.tolist() == [8 * SIDE + 9] * 2
    assert recovery.frame.indices.tolist() == [8 * SIDE + 9]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("row=16", "dead_taxels: 'row=16' is outside of an array of 16 x 16"),
        ("3;4", "dead_taxels: '3;4' names no taxels: allowed are row=R"),
        (" ".join(f"row={row}" for row in range(SIDE)), "these are all taxels; leave out those that work"),
    ],
)
def test_what_cannot_be_is_refused_as_a_setting(words: str, told: str) -> None:
    with pytest.raises(SettingsError) as refused:
        ReconstructionSettings(rows=SIDE, cols=SIDE, dead_taxels=words)
    assert told in str(refused.value)
