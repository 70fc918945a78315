# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When the page looks for images: how long each has waited, and how many looks that takes."""

from __future__ import annotations

import math
from bisect import bisect_right

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_view.web.pace import Pace

PERIOD_S = 1 / 30


def looks(*streams: NDArray[np.float64], until_s: float = 60.0) -> tuple[list[float], list[float]]:
    """The times of the looks, and for how long the last image that each of them found had waited [s]."""
    pace, now_s, last = Pace(PERIOD_S), 0.0, [0] * len(streams)
    times_s, waits_s = [], []
    while now_s < until_s:
        found = [bisect_right(stream, now_s) for stream in streams]
        waited_s = [
            now_s - float(stream[n - 1]) if n > before else math.nan
            for stream, n, before in zip(streams, found, last, strict=True)
        ]
        last = found
        times_s.append(now_s)
        waits_s += sorted(one for one in waited_s if not math.isnan(one))[:1]
        now_s += PERIOD_S + pace.later_s(waited_s)
    return times_s, waits_s


def images(rate_hz: float, late_s: float = 0.0, *, first_s: float = 0.02) -> NDArray[np.float64]:
    """Times of images that come with the next frame of 1 kHz, and up to so much later."""
    due_s = first_s + np.arange(int(60 * rate_hz)) / rate_hz
    return np.sort(np.ceil(due_s * 1000) / 1000 + np.random.default_rng(1).uniform(0, late_s, due_s.size))


@pytest.mark.parametrize("rate_hz", [29.4, 29.9, 30.0])
@pytest.mark.parametrize("first_s", [0.0, 0.011, 0.022])
def test_an_image_is_found_shortly_after_it_has_come(rate_hz: float, first_s: float) -> None:
    """Looked for at a pace of their own, images waited for 17 ms in the median, and up to 33."""
    times_s, waits_s = looks(images(rate_hz, 0.001, first_s=first_s))
    assert np.median(waits_s) < 0.004
    assert np.percentile(waits_s, 99) < 0.008
    assert len(waits_s) >= 0.99 * 60 * rate_hz
    assert len(times_s) <= 1.15 * 60 * 30


def test_late_images_are_looked_for_again() -> None:
    times_s, waits_s = looks(images(29.9, 0.012))
    assert np.median(waits_s) < 0.006
    assert np.percentile(waits_s, 99) < 0.016
    assert len(waits_s) >= 0.98 * 60 * 29.9
    assert len(times_s) <= 2 * 60 * 30


def test_of_several_skins_each_image_is_found() -> None:
    """The looks follow the last of the images that came."""
    _, waits_s = looks(images(29.9, 0.001), images(29.9, 0.001, first_s=0.03))
    assert np.median(waits_s) < 0.004


@pytest.mark.parametrize("rate_hz", [1000.0, 100.0])
def test_a_faster_stream_is_looked_at_about_as_often(rate_hz: float) -> None:
    times_s, _ = looks(images(rate_hz))
    assert 0.98 * 60 * 30 <= len(times_s) <= 1.15 * 60 * 30


@pytest.mark.parametrize("rate_hz", [10.0, 1.0])
def test_slow_images_cost_a_few_looks_more(rate_hz: float) -> None:
    times_s, waits_s = looks(images(rate_hz))
    assert len(waits_s) == 60 * rate_hz
    assert len(times_s) <= 60 * (30 + 3 * rate_hz)


def test_what_is_not_known_to_have_waited_leaves_the_pace_alone() -> None:
    """As without images, with a middleware that does not tell, or where the clock was set meanwhile."""
    pace = Pace(PERIOD_S)
    assert [pace.later_s(waited_s) for waited_s in ([], [math.nan], [-1.0], [1e6])] == [0.0] * 4


def test_the_next_look_is_never_before_this_one() -> None:
    pace = Pace(0.002)
    waits_s = [*np.linspace(0.0, 0.002, 9), math.nan, math.nan]
    assert all(-0.002 <= pace.later_s([one]) <= 0.0002 for one in waits_s)
