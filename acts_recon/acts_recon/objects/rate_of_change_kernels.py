# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts_recon.objects.rate_of_change` in numba, without allocation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel


# Not the fast arithmetic of other kernels: it would not tell NaN.
@kernel
def possible(image: NDArray[np.float32], sigma: NDArray[np.float32], age_s: NDArray[np.float32]) -> bool:
    """Whether all counts and deviations are finite, and all deviations and ages 0 or more; flat arrays."""
    wrong = 0
    for t in range(image.shape[0]):
        if not (np.isfinite(image[t]) and 0 <= sigma[t] < np.inf and age_s[t] >= 0):
            wrong += 1
    return wrong == 0


@kernel
def follow(
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    age_s: NDArray[np.float32],
    period_s: float,
    touch_counts: float,
    noise_counts: float,
    shortest_s: float,
    longest_s: float,
    kept: float,
    rate_counts_per_s: float,
    values: NDArray[np.float32],
    ages_s: NDArray[np.float32],
    inflated_sigma: NDArray[np.float32],
) -> float:
    """One step of `RateOfChange`; returns the new rate. `values`, `ages_s` and `inflated_sigma` are overwritten."""
    total = 0.0
    n = 0
    period = np.float32(period_s)
    longest = np.float32(longest_s)
    for t in range(image.shape[0]):
        before_s = ages_s[t] + period
        if age_s[t] < min(before_s, period):
            if max(image[t], values[t]) > touch_counts:
                n += 1
                change = abs(image[t] - values[t])
                if change > noise_counts:
                    rate = change / min(max(before_s - age_s[t], shortest_s), longest_s)
                    total += rate * rate
            values[t] = image[t]
        ages_s[t] = min(age_s[t], longest)
    if n > 0:
        total /= n
    rate_counts_per_s = kept * rate_counts_per_s + (1.0 - kept) * np.sqrt(total)
    for t in range(image.shape[0]):
        by_now = ages_s[t] * rate_counts_per_s
        inflated_sigma[t] = np.sqrt(sigma[t] * sigma[t] + by_now * by_now)
    return rate_counts_per_s
