# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The virtual board's frame rates are those the authors measured."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from board_process import BoardProcess
from core_library import published_sample_us

from acts_core.sampling import SCHEME_NUMBERS, SamplingConfig

pytestmark = pytest.mark.slow

# Number in curves.csv: the frame rates over M of Fig. 4D.
FIGURE_4D = {"uniform": 9, "random": 10, "adaptive": 11, "raster": 12}
ADAPTIVE_FIGURE_8 = 50


def curve(path: Path, number: int) -> dict[int, float]:
    """Frames per second by M."""
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    return {int(m): rate for curve_id, m, rate in table if curve_id == number}


def rate_hz(scheme: str, m: int) -> float:
    taxels = 1024 if scheme == "raster" else m
    return 1e6 / (taxels * published_sample_us(SamplingConfig(scheme, m=m)))


@pytest.mark.parametrize(("scheme", "margin"), [("uniform", 0.001), ("random", 0.001), ("adaptive", 0.011)])
def test_frame_rates_of_the_paper(scheme: str, margin: float, recording_path: Callable[[str], Path]) -> None:
    published = curve(recording_path("paper/curves.csv"), FIGURE_4D[scheme])
    assert len(published) == 20
    off = {m: rate_hz(scheme, m) / rate - 1 for m, rate in published.items()}
    assert max(map(abs, off.values())) < margin, off


def test_raster_is_the_55_frames_a_second_of_the_paper(recording_path: Callable[[str], Path]) -> None:
    published = set(curve(recording_path("paper/curves.csv"), FIGURE_4D["raster"]).values())
    assert len(published) == 1
    assert rate_hz("raster", 1024) == pytest.approx(published.pop(), rel=0.0001)


def test_the_real_time_sketch_was_a_little_faster_where_frames_are_large(recording_path: Callable[[str], Path]) -> None:
    off = {
        m: rate_hz("adaptive", m) / rate - 1
        for m, rate in curve(recording_path("paper/curves.csv"), ADAPTIVE_FIGURE_8).items()
    }
    assert -0.055 < min(off.values()) < max(off.values()) < 0.02, off


@pytest.mark.parametrize("scheme", sorted(set(SCHEME_NUMBERS) - {"uniform", "raster"}))
def test_more_taxels_take_longer_on_arrays_of_any_size(scheme: str) -> None:
    times = [m * published_sample_us(SamplingConfig(scheme, 64, 64, m)) for m in range(1, 4097)]
    assert np.diff(times).min() > 10
    assert np.diff(times).max() < 30


def test_hybrid_lies_between_its_parts() -> None:
    for m in (10, 55, 200, 512):
        random, hybrid, adaptive = (
            published_sample_us(SamplingConfig(scheme, m=m)) for scheme in ("random", "hybrid", "adaptive")
        )
        assert random - 0.1 < hybrid < adaptive + 0.1
        assert published_sample_us(SamplingConfig("hybrid", m=m, adaptive_share=1.0)) == pytest.approx(adaptive)


@pytest.mark.parametrize(("scheme", "m", "frame_us"), [("uniform", 64, 1127), ("adaptive", 128, 2288)])
def test_a_board_without_rate_cap_keeps_these_times(tmp_path: Path, scheme: str, m: int, frame_us: int) -> None:
    with BoardProcess(tmp_path, "--scheme", scheme, "--m", m, "--rate-hz", 100_000) as board:
        board.open_port()
        frames = board.read_frames(20)
    assert board.start["frame_period_us"] == pytest.approx(frame_us, abs=0.1)
    assert {abs(frame.duration_us - frame_us) <= 1 for frame in frames} == {True}
    first, last = frames[0], frames[-1]
    period_us = (last.board_us - first.board_us) / (last.sequence - first.sequence)
    assert period_us == pytest.approx(frame_us, abs=0.2)
