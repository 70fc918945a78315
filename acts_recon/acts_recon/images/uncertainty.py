# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""First-order propagation of the taxels' variances to force, centre, spread and area of a contact.

The formulae of `uncertainty_kernels`; their reference implementation is in the tests.

A taxel of `c` counts, standard deviation `s` and force `f(c)` has two errors. A pressed one changes the force by
``f'(c) s``. With probability ``q = Phi(-abs(c - threshold) / s)`` a taxel is on the wrong side of its threshold: then
the force of a pressed one should be missing, and an untouched neighbour should be there with the threshold's force.
The variance of a taxel's force is ``e**2 = (f' s)**2 + q f**2``. Sums over the taxels give the variances of:

- force F: ``sum(e**2)``
- centre of pressure: ``sum(e**2 (x_taxel - x)**2) / F**2``
- square of the spread: ``sum(e**2 (r_taxel**2 - spread**2)**2) / F**2``
- number of taxels: ``sum(q)``

These formulae are for independent errors, as the noise of readings is. Errors of estimated taxels are correlated: a
contact that moved further than predicted is wrong at many taxels. So each term is multiplied by a factor between 1, for
``s <= noise_counts``, and `err_together`: ``together - (together - 1) noise**2 / s**2``.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

NOISE_COUNTS = 2.0
"""Standard deviation of a reading where nobody has told it; what an image's is beyond it is that of a guess."""

LEAST_NOISE_COUNTS = 0.29
"""Smallest standard deviation of a reading: whole counts are rounded, ``1 / sqrt(12)``."""

ERR_TOGETHER = 5.0
"""Guesses that err together: as many as this are one independent error."""

FAR = 6.0
"""Standard deviations from the threshold beyond which q is taken as 0."""


def slope_table(force_n: NDArray[np.float64]) -> NDArray[np.float64]:
    """Slope of a force table; where the table ends flat because the taxel is saturated, the last slope before.

    Parameters
    ----------
    force_n : np.ndarray [shape=(1025,), dtype=float64]
        See `acts_core.skin.force.force_table`.

    Returns
    -------
    np.ndarray [shape=(1024,), dtype=float64]
        Newtons a count, between each count and the next.
    """
    slope = np.diff(force_n)
    rising = np.flatnonzero(slope > 0)
    if rising.size:
        # The table may end within the last step that rises, which then is too flat.
        slope[rising[-1] :] = slope[rising[-2:]].max()
    return slope
