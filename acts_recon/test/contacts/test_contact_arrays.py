# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images that are no such arrays: refused before a kernel sees them; those in another order in memory are taken."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from odd_arrays import KINDS, ORDERS, in_another_order, nothing_compiled, of_another_kind

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import ForceResponse
from acts_recon.contacts import BlobTracker, ContactFinder
from acts_recon.images import Borders, borders_of

GEOMETRY = ArrayGeometry(8, 9)

Find = Callable[[Any, Any], object]


def picture() -> list[Any]:
    """An image with two contacts, and its sigma."""
    image = np.zeros((GEOMETRY.rows, GEOMETRY.cols), dtype=np.float32)
    image[1:3, 1:4], image[5:8, 6:9] = 300, 500
    return [image, np.full_like(image, 3)]


def finder() -> Find:
    finds = ContactFinder(GEOMETRY, ForceResponse(), 60.0)
    return lambda image, sigma: finds.find(_flat(image), _flat(sigma))


def tracker() -> Find:
    tracks = BlobTracker(GEOMETRY)
    tracks.step(picture()[0], 0.0)
    return lambda image, sigma: tracks.step(image, 0.001, sigma)


def _flat(image: Any) -> Any:
    """As `ContactFinder` takes it, where it is an image, and in the same order."""
    is_image = isinstance(image, np.ndarray) and image.shape == (GEOMETRY.rows, GEOMETRY.cols)
    return image.ravel() if is_image else image


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("position", [0, 1])
@pytest.mark.parametrize("made", [finder, tracker])
def test_images_of_another_kind_are_refused_and_leave_no_trace(
    made: Callable[[], Find], position: int, kind: str
) -> None:
    find, undisturbed = made(), made()
    images = picture()
    # No sigma is allowed.
    images[position] = of_another_kind(images[position], "object" if position and kind == "None" else kind)
    with nothing_compiled(), pytest.raises(ArrayError, match=f"{('image', 'sigma')[position]} .*needed is"):
        find(*images)
    assert find(*picture()) == undisturbed(*picture())


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("position", [0, 1])
def test_flat_images_in_another_order_are_taken_and_nothing_is_compiled(position: int, order: str) -> None:
    finds = ContactFinder(GEOMETRY, ForceResponse(), 60.0)
    images = [image.ravel() for image in picture()]
    expected = finds.find(*images)
    images[position] = in_another_order(images[position], order)
    with nothing_compiled():
        assert finds.find(*images) == expected


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("position", [0, 1])
def test_images_that_are_read_only_are_taken_and_other_orders_are_refused(position: int, order: str) -> None:
    find, plain = tracker(), tracker()
    images = picture()
    images[position] = in_another_order(images[position], order)
    with nothing_compiled():
        if images[position].flags.c_contiguous:
            assert find(*images) == plain(*picture())
        else:
            with pytest.raises(ArrayError, match="C-contiguous"):
                find(*images)
    assert find(*picture()) == plain(*picture())


@pytest.mark.parametrize("time_s", [np.nan, np.inf, -np.inf, 1e18])
def test_times_that_cannot_be_are_refused_and_leave_no_trace(time_s: float) -> None:
    tracks, undisturbed = BlobTracker(GEOMETRY), BlobTracker(GEOMETRY)
    image = picture()[0]
    for number in range(4):
        if number == 2:
            with pytest.raises(ArrayError, match="needed are finite times"):
                tracks.step(image, time_s)
        assert tracks.step(image, 1e-3 * number) == undisturbed.step(image, 1e-3 * number)


def test_whole_seconds_are_times_and_nothing_is_compiled() -> None:
    tracks = BlobTracker(GEOMETRY)
    with nothing_compiled():
        assert [blob.age_s for time_s in (3, 4) for blob in tracks.step(picture()[0], time_s)] == [0, 0, 1, 1]


@pytest.mark.parametrize("rows_and_cols", [(4, 4), (9, 8), (64, 64), (7, 9), (8, 10)])
@pytest.mark.parametrize(
    "made",
    [
        lambda borders: ContactFinder(GEOMETRY, ForceResponse(), 60.0, borders=borders),
        lambda borders: BlobTracker(GEOMETRY, borders=borders),
    ],
)
def test_borders_of_another_picture_are_refused(
    made: Callable[[Borders], object], rows_and_cols: tuple[int, int]
) -> None:
    rows, cols = rows_and_cols
    with pytest.raises(ArrayError, match=f"borders of a picture of {rows} x {cols}: this one is 8 x 9"):
        made(borders_of(rows, cols))
    made(borders_of(8, 9))
