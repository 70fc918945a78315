# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Contacts with numbers: that the kernels do what the reference implementation says, whatever contacts do."""

import numpy as np
import pytest
from blob_track_reference import BlobTrackerReference
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, MeasuredForceResponse, force_table
from acts_recon.contacts import BlobConfig, BlobTracker

pytestmark = pytest.mark.slow

GEOMETRY = ArrayGeometry(rows=20, cols=24, pitch_m=0.005, row_pitch_m=0.004)
RESPONSE = ForceResponse()
# What the kernel looks up, as the reference implementation reads it: exactly the same response between two counts, too.
BY_TABLE = MeasuredForceResponse(force_table(RESPONSE)[:-1], np.arange(1024.0))
CONFIG = BlobConfig(bridge_s=0.01, memory_s=0.05)

Frame = tuple[NDArray[np.float32], NDArray[np.float32] | None, float]


@pytest.fixture(scope="module")
def tracker() -> BlobTracker:
    return BlobTracker(GEOMETRY, BY_TABLE, CONFIG)


def compare(tracker: BlobTracker, frames: list[Frame]) -> int:
    """Follow the same contacts with both; how often some were part of others."""
    tracker.reset()
    reference = BlobTrackerReference(GEOMETRY, BY_TABLE, CONFIG)
    first = tracker._memory.next_number[0] - 1
    time_s, merged = 0.0, 0
    for frame, (image, sigma, dt_s) in enumerate(frames):
        time_s += dt_s
        found = tracker.step(image, time_s, sigma)
        assert tracker.dropped == 0
        expected = reference.step(image, time_s, dt_s if frame else 0.0, sigma)
        assert [(blob.number - first, blob.merged) for blob in found] == [
            (blob.number, blob.merged) for blob in expected
        ]
        for blob, wanted in zip(found, expected, strict=True):
            assert np.array(blob[2:]) == pytest.approx(np.array(wanted[2:]), rel=1e-5, abs=1e-7)
            merged += blob.merged > 0
    return merged


def presses(seed: int, contacts: int, frames: int) -> list[Frame]:
    """Round presses that wander, meet, pass one another, and come and go; now and then frames are lost."""
    rng = np.random.default_rng(seed)
    row, col = np.indices((GEOMETRY.rows, GEOMETRY.cols))
    place = rng.uniform(3, 17, (contacts, 2))
    speed = rng.normal(0, 0.25, (contacts, 2))
    width, newtons = rng.uniform(0.7, 1.6, contacts), rng.uniform(0.5, 3, contacts)
    away = np.zeros(contacts, dtype=int)
    made = []
    for _ in range(frames):
        # Back from the edge.
        speed = np.where(place < 2, abs(speed), np.where(place > (17, 21), -abs(speed), speed))
        place = place + speed
        lift = rng.random(contacts) < 0.02
        away = np.where(lift, rng.integers(1, 20, contacts), np.maximum(away - 1, 0))
        force = sum(
            (
                newtons[i] * np.exp(-((row - place[i, 0]) ** 2 + (col - place[i, 1]) ** 2) / (2 * width[i] ** 2))
                for i in range(contacts)
                if not away[i]
            ),
            np.zeros(row.shape),
        )
        image = RESPONSE.counts(force).astype(np.float32)
        sigma = rng.uniform(1, 8, row.shape).astype(np.float32) if rng.random() < 0.7 else None
        made.append(
            (image, sigma, float(rng.choice([1e-3, 1e-3, 1e-3, 1e-3, 0.0, 4e-3, 0.2], p=[0.22] * 4 + [0.04] * 3)))
        )
    return made


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1), st.integers(1, 5))
def test_kernels_equal_the_reference_on_presses_that_meet_and_part(
    tracker: BlobTracker, seed: int, contacts: int
) -> None:
    compare(tracker, presses(seed, contacts, 80))


def test_presses_of_the_comparison_do_meet(tracker: BlobTracker) -> None:
    assert sum(compare(tracker, presses(seed, 4, 80)) for seed in range(3)) > 20  # measured: 45


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1))
def test_kernels_equal_the_reference_on_anything(tracker: BlobTracker, seed: int) -> None:
    """Images that have nothing to do with one another, of few and of many taxels."""
    rng = np.random.default_rng(seed)
    frames: list[Frame] = []
    for _ in range(12):
        pressed = rng.random((GEOMETRY.rows // 4, GEOMETRY.cols // 4)) < rng.uniform(0, 0.35)
        image = np.kron(pressed, np.ones((4, 4))) * rng.uniform(0, 600, (GEOMETRY.rows, GEOMETRY.cols))
        frames.append((image.astype(np.float32), None, float(rng.choice([1e-3, 5e-3]))))
    compare(tracker, frames)
