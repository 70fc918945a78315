# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What an acts_msgs/Baseline says, checked: anybody may have sent or recorded it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import check_untouched
from acts_core.errors import ArrayError
from acts_msgs.msg import Baseline


class BaselineFields(NamedTuple):
    """Reading and noise of every untouched taxel, row-major.

    Attributes
    ----------
    counts : np.ndarray [shape=(rows * cols,), dtype=float32]
        Mean reading [counts]; 0 where it is not known.
    noise_counts : np.ndarray [shape=(rows * cols,), dtype=float32]
        Standard deviation of one reading about it [counts]; likewise.
    valid : np.ndarray [shape=(rows * cols,), dtype=bool]
        Where both are known.
    """

    counts: NDArray[np.float32]
    noise_counts: NDArray[np.float32]
    valid: NDArray[np.bool_]


def baseline_of(message: Baseline, rows: int, cols: int) -> BaselineFields:
    """The baseline of an array of `rows` x `cols` taxels in a message.

    Raises
    ------
    ArrayError
        It is of another array, not whole, or has values that no board can read.
    """
    if (message.rows, message.cols) != (rows, cols):
        raise ArrayError(f"a baseline of {message.rows} x {message.cols} taxels, the array has {rows} x {cols}")
    valid = np.asarray(message.valid, dtype=np.bool_)
    counts, noise_counts = (np.asarray(values, dtype=np.float32) for values in (message.baseline, message.noise))
    for name, values in (("baseline", counts), ("noise", noise_counts)):
        check_untouched(name, values, valid, rows * cols)
    nothing = np.float32(0.0)
    return BaselineFields(np.where(valid, counts, nothing), np.where(valid, noise_counts, nothing), valid)
