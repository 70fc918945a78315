# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How fast the skin changes: single steps by hand, a run against the reference implementation."""

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_recon.objects.rate_of_change import _LONGEST_S, _NOISE_COUNTS, _SHORTEST_S, RateOfChange

SURE = np.zeros((2, 2), dtype=np.float32)


def rate_of_change(
    before: NDArray[np.floating],
    image: NDArray[np.floating],
    since_s: NDArray[np.floating],
    fresh: NDArray[np.bool_],
    touch_counts: float,
) -> float:
    """Root mean square of the rates of change of the taxels that are or were pressed [counts/s]; 0 without any.

    Parameters
    ----------
    before, image : np.ndarray [dtype=float]
        What was measured last, and now [counts].
    since_s : np.ndarray [dtype=float]
        Time between the two measurements [s].
    fresh : np.ndarray [dtype=bool]
        Which taxels were measured now.
    touch_counts : float
        Above it a taxel is pressed.
    """
    pressed = fresh & (np.maximum(image, before) > touch_counts)
    change = np.abs(image - before)[pressed]
    rates = np.where(change > _NOISE_COUNTS, change / np.clip(since_s[pressed], _SHORTEST_S, _LONGEST_S), 0)
    return float(np.sqrt(np.mean(np.square(rates, dtype=np.float64)))) if rates.size else 0.0


def test_old_values_are_doubted_while_others_change() -> None:
    changing = RateOfChange(2, 2, touch_counts=15)
    age_s = np.array([[0.0, 0.05], [0.05, np.inf]], dtype=np.float32)
    quiet = changing.step(np.zeros((2, 2), np.float32), SURE, age_s, 0.001)
    assert not quiet.any()
    image = np.array([[100, 0], [0, 0]], dtype=np.float32)
    inflated_sigma = changing.step(image, SURE, np.array([[0.0, 0.051], [0.051, np.inf]], np.float32), 0.001)
    assert inflated_sigma[0, 0] == 0
    # 100 counts in 1 ms, of which a frame takes over a part.
    assert inflated_sigma[0, 1] == pytest.approx(0.4 * 100 / 0.001 * 0.051, rel=1e-3)
    assert inflated_sigma[1, 1] > 10 * inflated_sigma[0, 1]
    for _ in range(30):
        inflated_sigma = changing.step(image, SURE, age_s, 0.001)
    assert inflated_sigma.max() < 1
    changing.reset()
    assert changing.rate_counts_per_s == 0


def test_what_may_have_changed_adds_to_sigma() -> None:
    changing = RateOfChange(1, 2, touch_counts=15)
    changing.step(np.array([[100, 0]], np.float32), np.zeros((1, 2), np.float32), np.zeros((1, 2), np.float32), 0.001)
    ages_s = np.array([[0.5, 0.002]], np.float32)
    alone = changing.step(np.zeros((1, 2), np.float32), np.zeros((1, 2), np.float32), ages_s, 0.001).copy()
    assert (alone > 0).all()
    rate = changing.rate_counts_per_s
    both = changing.step(np.zeros((1, 2), np.float32), np.array([[3, 4]], np.float32), ages_s, 0.001)
    np.testing.assert_allclose(both, np.hypot([[3, 4]], ages_s * 0.6 * rate), rtol=1e-5)


def test_a_run_goes_as_the_plain_version_says() -> None:
    rng = np.random.default_rng(4)
    changing = RateOfChange(6, 7, touch_counts=15)
    values, measured_s, rate = np.zeros((6, 7)), np.full((6, 7), -1.0), 0.0
    now_s = 0.0
    for _ in range(40):
        period_s = 0.001 + 0.002 * rng.random()
        now_s += period_s
        fresh = rng.random((6, 7)) < 0.4
        image = np.where(fresh, 60 * rng.random((6, 7)), values)
        at_s = now_s - 0.9 * period_s * rng.random((6, 7))
        change = rate_of_change(values, image, at_s - measured_s, fresh, 15)
        rate = 0.6 * rate + 0.4 * change
        values, measured_s = image, np.where(fresh, at_s, measured_s)
        age_s = (now_s - measured_s).astype(np.float32)
        inflated_sigma = changing.step(image.astype(np.float32), np.zeros((6, 7), np.float32), age_s, period_s)
        assert changing.rate_counts_per_s == pytest.approx(rate, rel=1e-3)
        np.testing.assert_allclose(inflated_sigma, np.minimum(age_s, 1.0) * rate, rtol=1e-3)
