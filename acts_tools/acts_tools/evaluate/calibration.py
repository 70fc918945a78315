"""Whether a method knows how wrong it is: its errors against the standard deviations that it gives."""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

TOUCHED, UNTOUCHED = range(2)
SUMS = (2, 4)
"""Shape of the sums: touched and untouched taxels; their number, squares of error over sigma, within 1 and 2 sigma."""


@numba.njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def add_errors(
    image: NDArray[np.float32],
    sigma: NDArray[np.float32],
    truth: NDArray[np.float32],
    live: NDArray[np.bool_],
    threshold: float,
    sums: NDArray[np.float64],
) -> None:
    """Add the errors of one image to the sums.

    Parameters
    ----------
    image, sigma, truth : np.ndarray [shape=(taxels,), dtype=float32]
        Estimate, its standard deviation and what really was there [counts].
    live : np.ndarray [shape=(taxels,), dtype=bool]
        Only these count.
    threshold : float
        A taxel is touched where the truth is above half of it [counts].
    sums : np.ndarray [shape=SUMS, dtype=float64]
        Added to.
    """
    for t in range(image.size):
        if not live[t]:
            continue
        error = abs(np.float64(image[t]) - truth[t])
        of = sums[TOUCHED if truth[t] > 0.5 * threshold else UNTOUCHED]
        of[0] += 1
        # An error of 0 is 0 sigmas, however small these are.
        of[1] += (error / sigma[t]) ** 2 if error > 0.0 else 0.0
        of[2] += error <= sigma[t]
        of[3] += error <= 2.0 * sigma[t]


def summary(sums: NDArray[np.float64]) -> dict[str, Any] | None:
    """What the report says of the sums; None where nothing was added: the method gives no standard deviations."""
    if not sums[:, 0].any():
        return None
    return {"touched": _of(sums[TOUCHED]), "untouched": _of(sums[UNTOUCHED])}


def _of(sums: NDArray[np.float64]) -> dict[str, float | None]:
    taxels, squares, within_1, within_2 = sums.tolist()
    if not taxels:
        return {"ratio": None, "within_1": None, "within_2": None}
    return {"ratio": float(np.sqrt(squares / taxels)), "within_1": within_1 / taxels, "within_2": within_2 / taxels}
