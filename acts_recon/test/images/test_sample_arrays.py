# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Samples and images that are no such arrays: refused before a kernel sees them; those in another order are taken."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from odd_arrays import KINDS, ORDERS, in_another_order, nothing_compiled, of_another_kind

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_recon.fusion import FusionEstimator
from acts_recon.images import BaselineSubtraction, DeadTaxels, PlacedSamples
from acts_recon.methods import METHODS, Method, Recovery, SkinSetup

GEOMETRY = ArrayGeometry(9, 13)
INDICES = np.arange(3, 100, 3, dtype=np.uint16)
COUNTS = (400 + 5 * INDICES).astype(np.uint16)

Take = Callable[[Any, Any], NDArray[Any]]


def subtraction() -> Take:
    subtracts = BaselineSubtraction(GEOMETRY.size)
    subtracts.set(np.full(GEOMETRY.size, 10, dtype=np.float32), np.ones(GEOMETRY.size, dtype=np.bool_))
    return subtracts.apply


def placed() -> Take:
    samples = PlacedSamples(GEOMETRY, None)
    return lambda indices, counts: np.stack(samples.of(indices, counts))


def fusion() -> Take:
    estimator = FusionEstimator(GEOMETRY)
    estimator.step(INDICES, COUNTS, 0.0, 0.0)
    return lambda indices, counts: estimator.step(indices, counts, 1e-3, 1e-4)


def refusals() -> list[tuple[Callable[[], Take], str]]:
    """What does not fit comes back from `subtraction` as it is, see test_baseline_subtraction."""
    sizes = ("empty", "short", "long")
    return [(made, kind) for made in ENTRIES for kind in KINDS if made is not subtraction or kind not in sizes]


ENTRIES = (subtraction, placed, fusion)


@pytest.mark.parametrize("position", [0, 1])
@pytest.mark.parametrize(("made", "kind"), refusals())
def test_samples_of_another_kind_are_refused_and_leave_no_trace(
    made: Callable[[], Take], kind: str, position: int
) -> None:
    take, undisturbed = made(), made()
    samples: list[Any] = [INDICES, COUNTS]
    samples[position] = of_another_kind(samples[position], kind)
    with nothing_compiled(), pytest.raises(ArrayError, match="needed are"):
        take(*samples)
    np.testing.assert_array_equal(take(INDICES, COUNTS), undisturbed(INDICES, COUNTS))


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("position", [0, 1])
@pytest.mark.parametrize("made", ENTRIES)
def test_samples_in_another_order_are_taken_and_nothing_is_compiled(
    made: Callable[[], Take], position: int, order: str
) -> None:
    take, plain = made(), made()
    samples = [INDICES, COUNTS]
    samples[position] = in_another_order(samples[position], order)
    with nothing_compiled():
        found = take(*samples)
    np.testing.assert_array_equal(found, plain(INDICES, COUNTS))


def test_whole_seconds_are_times_and_nothing_is_compiled() -> None:
    of_int, of_float = FusionEstimator(GEOMETRY), FusionEstimator(GEOMETRY)
    with nothing_compiled():
        of_int.step(INDICES, COUNTS, 3, 0)
    np.testing.assert_array_equal(of_int.image, of_float.step(INDICES, COUNTS, 3.0, 0.0))


def some_dead() -> DeadTaxels:
    dead = np.zeros((GEOMETRY.rows, GEOMETRY.cols), dtype=np.bool_)
    dead[4, 6] = dead[8, 12] = True
    return DeadTaxels(dead, GEOMETRY)


@pytest.mark.parametrize("kind", [*KINDS, "slice", "reversed", "Fortran", "read-only"])
@pytest.mark.parametrize("name", ["image", "sigma"])
def test_estimates_are_written_into_nothing_but_an_image(name: str, kind: str) -> None:
    dead = some_dead()
    images: dict[str, Any] = {
        each: np.full((GEOMETRY.rows, GEOMETRY.cols), 300, np.float32) for each in ("image", "sigma")
    }
    before = {each: image.copy() for each, image in images.items()}
    if name == "sigma" and kind == "None":
        kind = "object"  # no sigma is allowed
    odd = of_another_kind(images[name], kind) if kind in KINDS else in_another_order(images[name], kind)
    with nothing_compiled(), pytest.raises(ArrayError, match=f"{name} "):
        dead.fill(**{**images, name: odd})
    for each, image in images.items():
        np.testing.assert_array_equal(image, before[each])
    dead.fill(**images)
    assert images["image"][4, 6] != 300


@pytest.mark.parametrize(
    ("dead", "words"),
    [
        (np.zeros((9, 12), np.bool_), r"shape \(9, 12\), bool: needed is \(9, 13\), bool"),
        (np.zeros((64, 64), np.bool_), r"shape \(64, 64\)"),
        (np.zeros(117, np.bool_), r"shape \(117,\)"),
        (np.zeros((9, 13), np.uint8), "uint8"),
        ([[False] * 13] * 9, "dead is list"),
    ],
)
def test_dead_taxels_of_another_matrix_are_refused(dead: Any, words: str) -> None:
    with pytest.raises(ArrayError, match=words):
        DeadTaxels(dead, GEOMETRY)


@pytest.mark.parametrize("kind", [*(kind for kind in KINDS if kind != "None"), "slice", "Fortran"])
@pytest.mark.parametrize("name", ["image", "sigma", "age_s", "measured"])
def test_a_method_whose_images_are_of_another_kind_is_refused(name: str, kind: str) -> None:
    skin = SkinSetup(GEOMETRY)
    method: Method = METHODS["fusion"](skin, None)
    right = getattr(method, name)
    odd = of_another_kind(right, kind) if kind in KINDS else in_another_order(right, kind)
    setattr(method, name, odd)
    with pytest.raises(ArrayError, match=rf"Fusion\.{name} .*needed is"):
        Recovery(method, skin)
