# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tangential motion of a contact between two images of the same patch, by the method of Lucas and Kanade (1981).

The pattern of pressure is modelled as that of the reference, shifted by d, with its force scaled by g and its width by
1 + s about its centre c. To first order::

    image - reference = (g - 1) reference - d . grad - s (r - c) . grad

This is solved by least squares over all live taxels; `grad` is the gradient of the two images' mean. Force and width
are unknowns, too, because a grip that tightens changes both, and neither is slip.
"""

from __future__ import annotations

import math
from typing import NamedTuple

# Ridge term: a pattern without gradient, such as equal pressure all over, has no motion.
RIDGE = 1e-6

SMALLEST_SIDE = 3
"""Of a patch, in taxels."""


class Motion(NamedTuple):
    """From the reference to the image.

    Attributes
    ----------
    cols, rows : float
        Shift along the columns and along the rows, towards higher numbers [taxels].
    sd_taxels : float
        Standard deviation of the shift, from the residual of the least squares and the noise [taxels].
    gain : float
        Force relative to the reference.
    growth : float
        Relative change of the width.
    """

    cols: float
    rows: float
    sd_taxels: float
    gain: float
    growth: float

    @property
    def distance_taxels(self) -> float:
        """Length of the shift."""
        return math.hypot(self.cols, self.rows)
