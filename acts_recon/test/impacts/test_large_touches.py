# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Large touches on the skins of a body: steps, and heel and toes as one."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_recon.impacts import Impact, ImpactDetector, Kind
from acts_recon.settings import ReconstructionSettings

PERIOD_S = 1.1e-3


def told_of_images(name: str, pressed: dict[tuple[int, int, int, int], tuple[int, int]], **own: float) -> list[Impact]:
    """What is told of rectangles of a layout's picture: first row, row behind the last, columns; when pressed [ms]."""
    settings = ReconstructionSettings(layout=name, method="per_frame", touch_counts=25, **own)
    arranged = settings.arranged()
    detector = settings.impact_detector(settings.recovery())
    told: list[Impact] = []
    for number in range(300):
        image = np.zeros((arranged.rows, arranged.cols), dtype=np.float32)
        for (top, bottom, left, right), (first, end) in pressed.items():
            if first <= number < end:
                image[top:bottom, left:right] = 300
        told += detector.step(100.0 + number * 1e-3, 1e-3, image)
    return told


@pytest.mark.parametrize(
    ("name", "own", "kind"),
    [
        ("square", {}, Kind.STEP),
        ("insole", {}, Kind.STEP),
        ("arm", {}, Kind.TAP),
        ("arm", {"impact_step_m2": 0.001}, Kind.STEP),
        ("insole", {"impact_step_m2": 0.5}, Kind.TAP),
    ],
)
def test_a_large_touch_is_a_step_unless_nobody_steps_on_the_skin(name: str, own: dict[str, float], kind: Kind) -> None:
    told = told_of_images(name, {(4, 22, 2, 14): (50, 200)}, **own)
    assert [one.kind for one in told if one.is_over] == [kind]


def test_heel_and_toes_are_one_touch_on_an_insole_alone() -> None:
    heel_and_toes = {(2, 10, 3, 12): (50, 200), (22, 30, 3, 12): (60, 190)}
    assert [one.is_over for one in told_of_images("insole", heel_and_toes)] == [False, True]
    assert [one.is_over for one in told_of_images("arm", heel_and_toes)] == [False, False, True, True]


@pytest.mark.parametrize("rows", [(15, 16), (14, 17)])
@pytest.mark.parametrize("cols", [(2, 22), (3, 31)])
def test_an_edge_that_touches_at_its_ends_first_is_one_touch(rows: tuple[int, int], cols: tuple[int, int]) -> None:
    """A long contact reaches as far as it is long: its ends were told to be over as taps while it pressed there."""
    left, right = (*rows, cols[0], cols[0] + 8), (*rows, cols[1] - 8, cols[1])
    told = told_of_images("square", {left: (50, 200), right: (50, 200), (*rows, *cols): (60, 200)})
    (over,) = [one for one in told if one.is_over]
    assert over.duration_s == pytest.approx(0.14, abs=0.012)
    joined = [one for one in told if one.joined]
    assert {one.joined for one in joined} == {over.number}
    assert {one.number for one in told} == {over.number, *(one.number for one in joined)}


@pytest.mark.parametrize("row", [8, 12])
def test_a_tap_beside_an_edge_is_over_by_itself(row: int) -> None:
    told = told_of_images("square", {(20, 22, 2, 30): (50, 200), (row, row + 2, 2, 4): (60, 70)})
    assert [(one.is_over, one.joined) for one in told if one.number == 2] == [(False, 0), (True, 0)]


def told_of_grid(shape: NDArray[np.bool_], frames: int) -> list[Impact]:
    """What is told of a shape that presses for so many frames of 1.1 ms, each of which measures a grid that moves."""
    rows, cols = np.indices(shape.shape)
    counts, nothing = np.where(shape, np.float32(400), np.float32(0)), np.zeros(shape.shape, dtype=np.float32)
    detector = ImpactDetector(ArrayGeometry(*shape.shape))
    measured, age_s = nothing.copy(), np.full_like(nothing, np.inf)
    told: list[Impact] = []
    for number in range(frames + 250):
        pressed = counts if 150 <= number < 150 + frames else nothing
        now = (rows % 4 == number // 4 % 4) & (cols % 4 == number % 4)
        age_s += np.float32(PERIOD_S)
        age_s[now], measured[now] = PERIOD_S / 2, pressed[now]
        # As the image is recovered: whole, as soon as a taxel of it has been measured, and until it is found free.
        image = counts if measured.any() else nothing
        told += detector.step(10.0 + number * PERIOD_S, PERIOD_S, image, np.full_like(image, 2), age_s, measured)
    return told


def shaped(name: str) -> NDArray[np.bool_]:
    shape = np.zeros((32, 32), dtype=bool)
    shape[17, 3 : 15 if name == "short edge" else 29] = True
    shape[3:17, 3] = name == "corner"
    return shape.T.copy() if name == "upright edge" else shape


SHAPES = ("short edge", "edge", "upright edge", "corner")


@pytest.mark.parametrize("name", SHAPES)
def test_an_edge_that_rests_is_over_once_where_frames_measure_a_grid_that_moves(name: str) -> None:
    """Taxels beside it, within a disc of its area, were taken for its own: free ones ended it again and again."""
    told = told_of_grid(shaped(name), 350)
    assert [(one.is_over, one.kind) for one in told] == [(False, Kind.UNKNOWN), (True, Kind.PRESS)]
    assert told[1].duration_s == pytest.approx(350 * PERIOD_S, abs=0.02)


@pytest.mark.parametrize("name", SHAPES)
def test_an_edge_that_knocks_is_over_soon(name: str) -> None:
    told = told_of_grid(shaped(name), 12)
    assert [(one.is_over, one.kind) for one in told] == [(False, Kind.UNKNOWN), (True, Kind.IMPACT)]
    assert told[1].duration_s < 0.03
