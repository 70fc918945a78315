# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The core on the board and its Python reference measure the same taxels in the same order."""

import math
from collections.abc import Callable
from fractions import Fraction
from itertools import product
from pathlib import Path

import core_library
import numpy as np
import pytest
from core_library import CoreSampler
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from published_spacing import PUBLISHED_SPACING

from acts_core.errors import SettingsError
from acts_core.sampling import NEIGHBOURS, SCHEME_NUMBERS, Sampler, SamplingConfig, SkinMap, measure_in, quota_of
from acts_core.sampling.basis import Pcg32, division_order
from acts_core.sampling.schemes.uniform import uniform_spacing
from acts_core.skin import layout

pytestmark = pytest.mark.slow

FRAMES = 3


def compare(config: SamplingConfig, fields: NDArray[np.integer], skin_map: SkinMap | None = None) -> None:
    reference = Sampler(config, skin_map)
    with CoreSampler(config, skin_map) as core:
        for field in fields:
            expected_indices, expected_counts = reference.frame(measure_in(field))
            indices, counts = core.frame(field)
            assert indices.tolist() == expected_indices.tolist()
            assert counts.tolist() == expected_counts.tolist()


def blobs(rng: np.random.Generator, rows: int, cols: int) -> NDArray[np.int64]:
    """A field with a few contacts and noise."""
    row, col = np.mgrid[:rows, :cols]
    field = rng.integers(0, 60, (rows, cols)).astype(float)
    for _ in range(rng.integers(0, 4)):
        centre_row, centre_col = rng.uniform(0, rows), rng.uniform(0, cols)
        radius = rng.uniform(0.5, 8)
        field += 1200 * np.exp(-((row - centre_row) ** 2 + (col - centre_col) ** 2) / (2 * radius**2))
    return np.clip(field, 0, 1023).astype(np.int64)


@settings(max_examples=400, deadline=None)
@given(
    st.integers(1, 64),
    st.integers(1, 64),
    st.sampled_from(sorted(SCHEME_NUMBERS)),
    st.sampled_from(sorted(NEIGHBOURS)),
    st.integers(0, 1023),
    st.integers(0, 2**64 - 1),
    st.sampled_from(["noise", "contacts", "full"]),
    st.floats(0.0001, 1.0),
)
def test_on_random_fields(
    rows: int, cols: int, scheme: str, order: str, threshold: int, seed: int, kind: str, share: float
) -> None:
    rng = np.random.default_rng(seed)
    m = int(rng.integers(1, rows * cols + 1))
    if scheme == "uniform":  # not every number of taxels makes a grid
        m = -(-rows // int(rng.integers(1, rows + 1))) * -(-cols // int(rng.integers(1, cols + 1)))
    fields = {
        "noise": lambda: rng.integers(0, 1024, (FRAMES, rows, cols)),
        "contacts": lambda: np.stack([blobs(rng, rows, cols) for _ in range(FRAMES)]),
        "full": lambda: np.full((FRAMES, rows, cols), 1023),
    }[kind]()
    config = SamplingConfig(scheme, rows, cols, m, threshold, order, seed, search_share=share, adaptive_share=share)
    compare(config, fields)


def any_map(rng: np.random.Generator, rows: int, cols: int) -> SkinMap:
    """Wires that run anyhow under patches of any shape, as many pictures as the number of taxels has divisors."""
    taxels = rows * cols
    sizes = [side for side in range(1, 65) if taxels % side == 0 and taxels // side <= 64]
    picture_rows = int(rng.choice(sizes))
    row, col = np.mgrid[:picture_rows, : taxels // picture_rows]
    patches = (row // rng.integers(1, 20)) * int(rng.integers(1, 5)) + col // rng.integers(1, 20)
    if rng.random() < 0.3:
        patches = rng.integers(0, 16, row.shape)
    order = rng.permutation(taxels) if rng.random() < 0.5 else np.arange(taxels)
    no_skin = int(rng.choice([255, 0, 3, 15]))
    return SkinMap(
        picture_rows, taxels // picture_rows, tuple(order.tolist()), tuple((patches.ravel() % 16).tolist()), no_skin
    )


@settings(max_examples=200, deadline=None)
@given(
    st.integers(1, 64),
    st.integers(1, 64),
    st.sampled_from(["adaptive", "tracking", "hybrid", "random"]),
    st.sampled_from(sorted(NEIGHBOURS)),
    st.integers(0, 1023),
    st.integers(0, 2**64 - 1),
    st.floats(0.0001, 1.0),
)
def test_on_any_skin(rows: int, cols: int, scheme: str, order: str, threshold: int, seed: int, share: float) -> None:
    rng = np.random.default_rng(seed)
    skin_map = any_map(rng, rows, cols)
    m = int(rng.integers(1, rows * cols + 1))
    # Contacts of the skin, as the matrix has them.
    pictures = [blobs(rng, skin_map.rows, skin_map.cols).ravel() for _ in range(FRAMES)]
    fields = np.zeros((FRAMES, rows * cols), dtype=np.int64)
    fields[:, list(skin_map.taxels)] = pictures
    config = SamplingConfig(scheme, rows, cols, m, threshold, order, seed, search_share=share, adaptive_share=share)
    compare(config, fields.reshape(FRAMES, rows, cols), skin_map)


@settings(max_examples=200, deadline=None)
@given(st.integers(1, 64), st.integers(1, 64), st.integers(0, 2**32 - 1))
def test_fixed_on_any_skin(rows: int, cols: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    config = SamplingConfig(
        "fixed",
        rows,
        cols,
        m=int(rng.integers(1, rows * cols + 1)),
        fixed_row=int(rng.integers(rows)),
        fixed_col=int(rng.integers(cols)),
        fixed_taxels=int(rng.choice([0, 1, int(rng.integers(rows * cols)), 4096])),
    )
    fields = rng.integers(0, 1024, (FRAMES, rows, cols))
    compare(config, fields, None if rng.random() < 0.3 else any_map(rng, rows, cols))


@pytest.mark.parametrize("name", ["insole", "glove", "leap_right"])
@pytest.mark.parametrize("scheme", ["adaptive", "tracking", "hybrid", "uniform"])
def test_on_the_layouts_that_come_with_us(name: str, scheme: str) -> None:
    rng = np.random.default_rng(5)
    shape = layout(name)
    fields = np.stack([shape.matrix(blobs(rng, shape.rows, shape.cols)) for _ in range(10)])
    compare(SamplingConfig(scheme, m=64, threshold_counts=60), fields, SkinMap.of(shape))


@pytest.mark.parametrize("m", [1, 10, 55, 64, 1024])
@pytest.mark.parametrize("order", sorted(NEIGHBOURS))
def test_adaptive_on_the_published_array(m: int, order: str) -> None:
    rng = np.random.default_rng(m)
    compare(SamplingConfig(m=m, neighbour_order=order), np.stack([blobs(rng, 32, 32) for _ in range(20)]))


@settings(max_examples=150, deadline=None)
@given(
    st.integers(1, 40),
    st.integers(1, 40),
    st.floats(0.0001, 1.0),
    st.integers(0, 1023),
    st.integers(0, 2**32 - 1),
    st.sampled_from(["noise", "sliding", "coming and going"]),
)
def test_tracking_on_changing_fields(rows: int, cols: int, share: float, threshold: int, seed: int, kind: str) -> None:
    rng = np.random.default_rng(seed)
    m = int(rng.integers(1, min(rows * cols, 200) + 1))
    frames = 25
    contact, other = blobs(rng, rows, cols), blobs(rng, rows, cols)
    fields = {
        "noise": lambda: rng.integers(0, 1024, (frames, rows, cols)),
        "sliding": lambda: np.stack([np.roll(contact, (i // 4, i // 3), axis=(0, 1)) for i in range(frames)]),
        "coming and going": lambda: np.stack([(contact, 0 * contact, other)[i // 3 % 3] for i in range(frames)]),
    }[kind]()
    config = SamplingConfig("tracking", rows, cols, m, threshold, seed=seed, search_share=share)
    assert core_library.quota_of(share, m) == config.search_quota
    compare(config, fields)


@settings(max_examples=300, deadline=None)
@given(st.floats(0.0001, 1.0), st.integers(1, 4096))
def test_quotas(share: float, m: int) -> None:
    quota = core_library.quota_of(share, m)
    assert 1 <= quota <= m
    assert quota == SamplingConfig("tracking", 64, 64, m, search_share=share).search_quota
    assert quota == SamplingConfig("hybrid", 64, 64, m, adaptive_share=share).adaptive_quota


@pytest.mark.parametrize("hundredths", range(1, 101))
def test_quotas_of_decimal_shares_are_exact(hundredths: int) -> None:
    share = hundredths / 100
    sizes = range(1, 4097)
    exact = [math.ceil(Fraction(str(share)) * m) for m in sizes]
    assert [quota_of(share, m) for m in sizes] == exact
    assert [core_library.quota_of(share, m) for m in sizes] == exact


@pytest.mark.parametrize("m", [*PUBLISHED_SPACING, 55])
def test_uniform_through_all_its_offsets(m: int) -> None:
    s, t = uniform_spacing(32, 32, m)
    assert core_library.uniform_spacing(32, 32, m) == (s, t) == PUBLISHED_SPACING.get(m, (s, t))
    compare(SamplingConfig(scheme="uniform", m=m), np.zeros((s * t + 1, 32, 32), dtype=int))


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 64), st.integers(1, 64))
def test_division_order(rows: int, cols: int) -> None:
    assert core_library.division_order(rows, cols).tolist() == division_order(rows, cols).tolist()


def test_uniform_spacing_of_every_m() -> None:
    for rows, cols in ((32, 32), (15, 15), (16, 64), (33, 15)):
        for m in range(1, rows * cols + 1, 3):
            given_by_core = core_library.uniform_spacing(rows, cols, m)
            if given_by_core is None:
                with pytest.raises(SettingsError):
                    uniform_spacing(rows, cols, m)
            else:
                assert given_by_core == uniform_spacing(rows, cols, m)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**64 - 1), st.integers(0, 2**32), st.one_of(st.just(0), st.integers(1, 2**32 - 1)))
def test_random_numbers(seed: int, stream: int, bound: int) -> None:
    random = Pcg32(seed, stream)
    expected = [random.below(bound) if bound else random.next() for _ in range(20)]
    assert core_library.random_numbers(seed, stream, bound, 20) == expected


def test_every_shape_up_to_64_x_64() -> None:
    schemes = sorted(SCHEME_NUMBERS)
    field = np.random.default_rng(0).integers(0, 400, (64, 64))
    for number, (rows, cols) in enumerate(product(range(1, 65), repeat=2)):
        scheme = schemes[number % len(schemes)]
        m = -(-rows // 3) * -(-cols // 3) if scheme == "uniform" else min(rows * cols, 40)
        compare(SamplingConfig(scheme, rows, cols, m, seed=number), field[None, :rows, :cols])


def frames_of(path: Path) -> NDArray[np.integer]:
    with np.load(path) as archive:
        return archive["frames"]


def canvas(path: Path) -> NDArray[np.integer]:
    """100 frames in a row around the hardest press of a recording of grasps or slips, and 50 spread over all."""
    frames = frames_of(path)
    hardest = int(frames.sum(axis=(1, 2), dtype=np.int64).argmax())
    first = max(hardest - 50, 0)
    return np.concatenate((frames[first : first + 100], frames[:: len(frames) // 50]))


def published(path: Path) -> NDArray[np.integer]:
    return np.clip(frames_of(path), 0, 1023).astype(int)


def insole(path: Path) -> NDArray[np.integer]:
    return frames_of(path)[::60, 0] // 2  # 11 bit


FIELDS = {
    "sdh_weiss/grasps_canvas.npz": canvas,
    "sdh_weiss/slip_canvas.npz": canvas,
    "paper/frames.npz": published,
    "insole/pairs.npz": insole,
}


@pytest.mark.parametrize("scheme", sorted(SCHEME_NUMBERS))
@pytest.mark.parametrize("recorded", FIELDS)
def test_on_recorded_fields(recorded: str, scheme: str, recording_path: Callable[[str], Path]) -> None:
    fields = FIELDS[recorded](recording_path(recorded))
    rows, cols = fields.shape[1:]
    m = -(-rows // 4) * -(-cols // 4) if scheme == "uniform" else 56
    searches = scheme in ("adaptive", "hybrid")
    for order in sorted(NEIGHBOURS) if searches else ["columns"]:
        for threshold in (50, 180):
            compare(SamplingConfig(scheme, rows, cols, m, threshold, order, seed=5), fields)


@pytest.mark.parametrize("m", [128, 512])
@pytest.mark.parametrize("scheme", ["adaptive", "hybrid", "tracking"])
def test_large_frames_of_the_published_figures(m: int, scheme: str, recording_path: Callable[[str], Path]) -> None:
    fields = published(recording_path("paper/frames.npz"))
    for order in sorted(NEIGHBOURS):
        compare(SamplingConfig(scheme, m=m, threshold_counts=50, neighbour_order=order), fields)
