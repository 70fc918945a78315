# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The firmware's sampler on recordings measures what the Python reference measures."""

import math
from itertools import count

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.errors import ArrayError, SettingsError
from acts_core.sampling import NEIGHBOURS, SCHEME_NUMBERS, Measure, Sampler, SamplingConfig, SkinMap
from acts_core.skin import layout
from acts_tools.firmware.board_sampler import BoardSampler, PythonSampler


def measure_while_it_moves(frames: NDArray[np.uint16], position: float, step: float) -> Measure:
    """Measures a little later in the recording each time."""
    number = count()
    last = len(frames) - 1

    def measure(row: int, col: int) -> int:
        at = min(max(position + next(number) * step, 0.0), float(last))
        before = min(int(at), last)
        first, second = (float(frames[f, row, col]) for f in (before, min(before + 1, last)))
        return math.floor(first + (at - before) * (second - first) + 0.5)

    return measure


def blobs(n: int, rows: int, cols: int, seed: int) -> NDArray[np.uint16]:
    """A press that wanders and noise around it."""
    rng = np.random.default_rng(seed)
    row, col = np.indices((rows, cols))
    fields = [
        900 * np.exp(-((row - rng.uniform(0, rows)) ** 2 + (col - rng.uniform(0, cols)) ** 2) / 4)
        + rng.integers(0, 80, (rows, cols))
        for _ in range(n)
    ]
    return np.array(fields).clip(0, 1023).astype(np.uint16)


@settings(max_examples=60, deadline=None)
@given(
    scheme=st.sampled_from(sorted(SCHEME_NUMBERS)),
    neighbour_order=st.sampled_from(sorted(NEIGHBOURS)),
    shape=st.sampled_from([(32, 32), (33, 15), (7, 9)]),
    threshold=st.integers(0, 300),
    seed=st.integers(0, 1000),
    moving=st.booleans(),
)
def test_it_samples_as_the_reference(
    scheme: str, neighbour_order: str, shape: tuple[int, int], threshold: int, seed: int, moving: bool
) -> None:
    rows, cols = shape
    config = SamplingConfig(
        scheme=scheme,
        neighbour_order=neighbour_order,
        rows=rows,
        cols=cols,
        m=36 if rows * cols > 100 and scheme != "uniform" else rows,
        threshold_counts=threshold,
        seed=seed,
    )
    frames = blobs(4, rows, cols, seed)
    # Powers of two, so that adding them up is exact on both sides. The recording ends before the last frame does.
    step = 2.0**-7 if moving else 0.0
    reference, board, python = Sampler(config), BoardSampler(config), PythonSampler(config)
    for number in range(6):
        position = number * 0.625
        expected = reference.frame(measure_while_it_moves(frames, position, step))
        indices, counts = board.frame(frames, position, step)
        np.testing.assert_array_equal(indices, expected[0])
        np.testing.assert_array_equal(counts, expected[1])
        np.testing.assert_array_equal(python.frame(frames, position, step), expected)


def test_with_a_map_of_the_skin_no_patch_is_searched_from_another() -> None:
    config, skin_map = SamplingConfig(scheme="tracking", m=55, threshold_counts=100), SkinMap.of(layout("leap_right"))
    frames = blobs(1, 32, 32, 3)
    reference, board, without = Sampler(config, skin_map), BoardSampler(config, skin_map=skin_map), BoardSampler(config)
    is_as_without = True
    for _ in range(6):
        expected = reference.frame(measure_while_it_moves(frames, 0.0, 0.0))
        found = board.frame(frames, 0.0, 0.0)
        np.testing.assert_array_equal(found, expected)
        is_as_without &= np.array_equal(found, without.frame(frames, 0.0, 0.0))
    assert not is_as_without


def test_a_map_of_another_matrix_is_refused() -> None:
    with pytest.raises(SettingsError, match="refuses a map of 32 x 32"):
        BoardSampler(SamplingConfig(rows=8, cols=8, m=10), skin_map=SkinMap.of(layout("leap_right")))


def test_noise_is_as_large_as_asked_for_and_repeatable() -> None:
    config = SamplingConfig(scheme="raster")
    frames = np.full((1, 32, 32), 500, dtype=np.uint16)
    counts = np.concatenate([BoardSampler(config, 3.0).frame(frames, 0, 0)[1] for _ in range(2)]).astype(float)
    assert counts.mean() == pytest.approx(500, abs=0.5)
    assert counts.std() == pytest.approx(3, rel=0.1)
    np.testing.assert_array_equal(counts[:1024], counts[1024:])
    assert BoardSampler(config, 100.0).frame(np.zeros_like(frames), 0, 0)[1].max() < 500


def test_what_does_not_fit_is_refused() -> None:
    board = BoardSampler(SamplingConfig(rows=8, cols=8, m=10))
    with pytest.raises(ArrayError, match=r"\(n, 8, 8\)"):
        board.frame(np.zeros((3, 8, 9), dtype=np.uint16), 0, 0)
    with pytest.raises(ArrayError):
        board.frame(np.zeros((3, 8, 8), dtype=np.float32), 0, 0)  # type: ignore[arg-type]


def test_an_unbuilt_library_is_named(monkeypatch: pytest.MonkeyPatch) -> None:

    monkeypatch.setenv("AMENT_PREFIX_PATH", "/nowhere")
    with pytest.raises(SettingsError, match=r"libacts_sampler.so .* build the workspace"):
        BoardSampler(SamplingConfig())
