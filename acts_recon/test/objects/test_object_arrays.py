# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames and images that are no such arrays: classifiers refuse them before a kernel sees them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from odd_arrays import KINDS, ORDERS, in_another_order, nothing_compiled, of_another_kind

from acts_core.errors import ArrayError
from acts_recon.objects import Classification, Classifier, ImageClassifier, ObjectLibrary, build_object_library

ROWS, COLS = 8, 9


def library() -> ObjectLibrary:
    return build_object_library(np.random.default_rng(3).integers(0, 1000, (6, ROWS, COLS)), list("aabbcc"))


Step = Callable[..., Classification]


def samples() -> tuple[Step, list[Any]]:
    indices = np.arange(1, 60, 2, dtype=np.uint16)
    return Classifier(library()).step, [indices, (12 * indices).astype(np.uint16)]


def images() -> tuple[Step, list[Any]]:
    classifier = ImageClassifier(library())
    image = np.random.default_rng(4).integers(0, 1000, (ROWS, COLS)).astype(np.float32)
    sigma, age_s = np.full_like(image, 3), np.full_like(image, 0.002)
    return lambda *fields: classifier.step(fields[0], fields[1], fields[2], 0.001), [image, sigma, age_s]


ENTRIES = [(samples, 0), (samples, 1), (images, 0), (images, 1), (images, 2)]
"""And which of their arrays."""


def told(found: Classification) -> tuple[int, float, list[float]]:
    return found.best, found.confidence, found.residuals.tolist()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("made", "position"), ENTRIES)
def test_arrays_of_another_kind_are_refused_and_leave_no_trace(
    made: Callable[[], tuple[Step, list[Any]]], position: int, kind: str
) -> None:
    (step, right), (undisturbed, _) = made(), made()
    odd = list(right)
    odd[position] = of_another_kind(right[position], kind)
    with nothing_compiled(), pytest.raises(ArrayError, match="needed"):
        step(*odd)
    assert told(step(*right)) == told(undisturbed(*right))


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(("made", "position"), ENTRIES)
def test_nothing_is_compiled_for_arrays_in_another_order(
    made: Callable[[], tuple[Step, list[Any]]], position: int, order: str
) -> None:
    (step, right), (plain, _) = made(), made()
    odd = list(right)
    odd[position] = in_another_order(right[position], order)
    with nothing_compiled():
        # Of images the order has always been told.
        if made is images and not odd[position].flags.c_contiguous:
            with pytest.raises(ArrayError, match="needed is a C-contiguous"):
                step(*odd)
            odd = right
        assert told(step(*odd)) == told(plain(*right))


@pytest.mark.parametrize(
    ("indices", "counts", "words"),
    [([5, 7, 5], [1, 2, 3], "index 5 occurs twice"), ([5, 7], [1, 1024], "count 1024: the board reads 0 to 1023")],
)
def test_frames_that_no_board_reads_are_refused(indices: list[int], counts: list[int], words: str) -> None:
    with pytest.raises(ArrayError, match=words):
        Classifier(library()).step(np.array(indices, dtype=np.uint16), np.array(counts, dtype=np.uint16))


def test_periods_of_any_number_are_taken_and_nothing_is_compiled() -> None:
    classifiers = ImageClassifier(library()), ImageClassifier(library())
    image, sigma, age_s = images()[1]
    periods_s: tuple[Any, ...] = (np.float32(0.5), 1)
    with nothing_compiled():
        found = [told(classifiers[0].step(image, sigma, age_s, period_s)) for period_s in periods_s]
    assert found == [told(classifiers[1].step(image, sigma, age_s, period_s)) for period_s in (0.5, 1.0)]
