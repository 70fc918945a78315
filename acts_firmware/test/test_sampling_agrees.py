"""The core on the board and its Python reference measure the same taxels in the same order."""

from pathlib import Path

import core_library
import numpy as np
import pytest
from core_library import CoreSampler
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.random_taxels import Pcg32
from acts_core.sampling import (
    NEIGHBOURS,
    SCHEMES,
    Sampler,
    SamplingConfig,
    division_order,
    measure_in,
)
from acts_core.uniform import uniform_spacing

SHARED = Path(__file__).resolve().parents[3] / "shared/data"
FRAMES = 3


def compare(config: SamplingConfig, fields: NDArray[np.integer]) -> None:
    reference = Sampler(config)
    with CoreSampler(config) as core:
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
    st.sampled_from(sorted(SCHEMES)),
    st.sampled_from(sorted(NEIGHBOURS)),
    st.integers(0, 1023),
    st.integers(0, 2**64 - 1),
    st.sampled_from(["noise", "contacts", "full"]),
)
def test_on_random_fields(rows: int, cols: int, scheme: str, order: str, threshold: int, seed: int, kind: str) -> None:
    rng = np.random.default_rng(seed)
    m = int(rng.integers(1, rows * cols + 1))
    if scheme == "uniform":  # not every number of taxels makes a grid
        m = -(-rows // int(rng.integers(1, rows + 1))) * -(-cols // int(rng.integers(1, cols + 1)))
    fields = {
        "noise": lambda: rng.integers(0, 1024, (FRAMES, rows, cols)),
        "contacts": lambda: np.stack([blobs(rng, rows, cols) for _ in range(FRAMES)]),
        "full": lambda: np.full((FRAMES, rows, cols), 1023),
    }[kind]()
    compare(SamplingConfig(scheme, rows, cols, m, threshold, order, seed), fields)


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


@pytest.mark.parametrize("m", [36, 49, 55, 64, 160])
def test_uniform_through_all_its_offsets(m: int) -> None:
    s, t = uniform_spacing(32, 32, m)
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


@pytest.mark.parametrize("order", sorted(NEIGHBOURS))
def test_on_recorded_grasps(order: str) -> None:
    path = SHARED / "sdh_weiss/grasps_canvas.npz"
    if not path.is_file():
        pytest.skip(f"{path} is absent: recordings are not part of the project")
    with np.load(path) as archive:
        frames = archive["frames"]
    pressed = frames[frames.max(axis=(1, 2)) > 180]
    compare(SamplingConfig(m=56, neighbour_order=order), pressed[:: max(1, len(pressed) // 150)])


def test_tracking_of_a_recorded_grasp() -> None:
    path = SHARED / "sdh_weiss/grasps_canvas.npz"
    if not path.is_file():
        pytest.skip(f"{path} is absent: recordings are not part of the project")
    with np.load(path) as archive:
        frames = archive["frames"]
    first = int(np.argmax(frames.max(axis=(1, 2)) > 180))
    compare(SamplingConfig("tracking", m=56), frames[max(first - 10, 0) : first + 200])


def test_on_published_frames() -> None:
    path = SHARED / "paper/frames.npz"
    if not path.is_file():
        pytest.skip(f"{path} is absent: the published figures' data are not part of the project")
    with np.load(path) as archive:
        fields = np.clip(archive["frames"], 0, 1023).astype(int)
    for m in (56, 64, 128, 512):
        compare(SamplingConfig(m=m, threshold_counts=50), fields)
