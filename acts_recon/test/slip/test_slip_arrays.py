# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Images and counts that are no such arrays: refused before a kernel sees them; those in another order are taken."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from odd_arrays import KINDS, ORDERS, in_another_order, nothing_compiled, of_another_kind

from acts_core.array import ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.skin import ForceResponse, SkinPatch, layout
from acts_recon.images import DeadTaxels
from acts_recon.regions import Regions
from acts_recon.slip import SlipConfig, SlipDetector, SlipWatch

SIDE = 32
CONFIG = SlipConfig(slip_window_s=0.004)
GLOVE = layout("glove")
FRAMES = 12

Step = Callable[[float, Any, Any, Any], Any]


def image_at(frame: int) -> NDArray[np.float32]:
    """What presses all of the skin, with a pattern that moves."""
    rows, cols = np.indices((SIDE, SIDE))
    return np.asarray(300 + 200 * np.sin(0.8 * cols - 0.3 * frame) * np.cos(0.9 * rows), dtype=np.float32)


def watch() -> Step:
    watches = SlipWatch(SIDE, SIDE, [SkinPatch("one", 0, 16, 0, 32), SkinPatch("two", 16, 32, 0, 32)], CONFIG)
    return watches.step


def detector() -> Step:
    detects = SlipDetector(SIDE, SIDE, 0.003, CONFIG)
    return lambda time_s, image, counts, age_s: detects.step(time_s, image)


def regions() -> Step:
    finds = Regions(GLOVE, ForceResponse(), slip=CONFIG, slip_rate_hz=0.0)
    return lambda time_s, image, counts, age_s: list(finds.step(time_s, image))


def measured() -> Step:
    finds = Regions(GLOVE, ForceResponse(), slip=CONFIG, slip_rate_hz=0.0)
    return lambda time_s, image, counts, age_s: list(finds.step(time_s, image_at(0), image, age_s))


def given(frame: int) -> list[Any]:
    image = image_at(frame)
    return [image, np.array([image[:16].sum(), image[16:].sum()], dtype=np.float64), np.zeros_like(image)]


ENTRIES = [(watch, 0), (watch, 1), (watch, 2), (detector, 0), (regions, 0), (measured, 0), (measured, 2)]
"""And which of their arrays: image, counts, age_s."""


def run(step: Step, at_frame: int, change: Callable[[list[Any]], list[Any]]) -> list[Any]:
    """All results, where the arrays of a frame are changed."""
    return [step(1e-3 * frame, *(change if frame == at_frame else list)(given(frame))) for frame in range(FRAMES)]


@pytest.mark.parametrize("kind", [*KINDS, "not a number", "infinite"])
@pytest.mark.parametrize(("made", "position"), ENTRIES)
def test_arrays_of_another_kind_are_refused_and_leave_no_trace(
    made: Callable[[], Step], position: int, kind: str
) -> None:
    step, undisturbed = made(), made()
    for frame in range(FRAMES):
        arrays = given(frame)
        if frame == 8:
            odd, right = given(frame), arrays[position]
            if kind in KINDS:
                # No measured and no age_s are allowed.
                is_allowed = kind == "None" and (made is measured or position == 2)
                odd[position] = of_another_kind(right, "object" if is_allowed else kind)
            else:
                odd[position].flat[-1] = np.nan if kind == "not a number" or position == 2 else np.inf
            with nothing_compiled(), pytest.raises(ArrayError, match=r"needed|must be"):
                step(1e-3 * frame, *odd)
        assert step(1e-3 * frame, *arrays) == undisturbed(1e-3 * frame, *arrays)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(("made", "position"), ENTRIES)
def test_arrays_in_another_order_are_taken_and_nothing_is_compiled(
    made: Callable[[], Step], position: int, order: str
) -> None:
    def change(arrays: list[Any]) -> list[Any]:
        arrays[position] = in_another_order(arrays[position], order)
        return arrays

    step, plain = made(), made()
    expected = run(plain, 8, list)
    with nothing_compiled():
        assert run(step, 8, change) == expected


def test_whole_seconds_are_times_and_nothing_is_compiled() -> None:
    of_int, of_float = watch(), watch()
    with nothing_compiled():
        assert of_int(3, *given(0)) == of_float(3.0, *given(0))


@pytest.mark.parametrize("bounds", [(0, 9, 0, 8), (0, 8, 0, 9), (0, 64, 0, 64), (-3, 5, 0, 8), (0, 8, -3, 5)])
def test_patches_beyond_the_image_are_refused(bounds: tuple[int, int, int, int]) -> None:
    with pytest.raises(ArrayError, match=r"patch beyond of rows .*: the image is 8 x 8"):
        SlipWatch(8, 8, [SkinPatch("within", 0, 8, 0, 8), SkinPatch("beyond", *bounds)])


@pytest.mark.parametrize("side", [8, 33, 64])
def test_dead_taxels_of_another_image_are_refused(side: int) -> None:
    is_dead = np.zeros((side, side), dtype=np.bool_)
    is_dead[-1, -1] = True
    dead = DeadTaxels(is_dead, ArrayGeometry(side, side))
    for made in (
        lambda: SlipWatch(SIDE, SIDE, [SkinPatch("one", 0, SIDE, 0, SIDE)], dead=dead),
        lambda: Regions(GLOVE, ForceResponse(), dead=dead),
    ):
        with pytest.raises(ArrayError, match=f"dead taxels of {side} x {side}: the image is 32 x 32"):
            made()
