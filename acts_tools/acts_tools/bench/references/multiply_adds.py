# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Peak performance of one core: single-precision multiply-adds per second in registers."""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel

_CHAINS = 4
_STEPS = 8
_ELEMENTS = 256


@kernel(fastmath={"contract", "nsz"})
def _work(times: int, x: NDArray[np.float32], a: float, b: float) -> None:
    """Four chains of eight multiply-adds for every element, unrolled: enough parallelism for any processor."""
    for _ in range(times):
        for k in range(x.shape[0]):
            p = x[k]
            q, r, s = p + a, p + b, p - a
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            p, q, r, s = p * a + b, q * a + b, r * a + b, s * a + b
            x[k] = (p + q) + (r + s)


def peak_per_s(trials: int = 15, times: int = 1000) -> float:
    """The best of some trials, by CPU time."""
    x = np.ones(_ELEMENTS, dtype=np.float32)
    a, b = np.float32(0.2), np.float32(0.1)
    _work(1, x, a, b)
    best_s = np.inf
    for _ in range(trials):
        begin_s = time.thread_time()
        _work(times, x, a, b)
        best_s = min(best_s, time.thread_time() - begin_s)
    return _CHAINS * _STEPS * _ELEMENTS * times / best_s
