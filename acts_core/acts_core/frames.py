# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One frame of the array: scheme, samples and times, from the board to the reconstruction."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.registry import FromRegistry
from acts_core.sampling import REPEATING, SCHEME_NUMBERS


class Scheme(IntEnum, metaclass=FromRegistry):
    """How the taxels of a frame are chosen: the number on the wire of every sampling scheme, by its name in capitals.

    1 to 3 are the mode numbers of the published firmware.
    """

    _ignore_ = "_name _number"

    UNKNOWN = 0
    for _name, _number in SCHEME_NUMBERS.items():
        vars()[_name.upper()] = _number


class SampleFrame(NamedTuple):
    """One subsampled frame as the board sent it.

    Attributes
    ----------
    sequence : int
        Number of the frame, wraps at 2**32. A gap is a lost frame.
    board_us : int
        The board's clock at the end of the frame's last measurement [us], 64 bit, does not wrap.
    duration_us : int
        From the start of the first measurement to the end of the last [us].
    scheme : Scheme
        How the taxels were chosen.
    rows, cols : int
        Size of the array.
    overruns : int
        Frames the board had to drop since its start because the host did not read, wraps at 2**32.
    indices : np.ndarray [shape=(m,), dtype=uint16]
        Row-major taxel indices in the order of measurement; none twice, unless the scheme repeats taxels.
    counts : np.ndarray [shape=(m,), dtype=uint16]
        ADC counts of these taxels, 0 to 1023.
    """

    sequence: int
    board_us: int
    duration_us: int
    scheme: Scheme
    rows: int
    cols: int
    overruns: int
    indices: NDArray[np.uint16]
    counts: NDArray[np.uint16]

    @property
    def repeats(self) -> bool:
        """Whether a taxel may be there several times."""
        return self.scheme in REPEATING

    def once(self) -> SampleFrame:
        """The frame with the last sample of each taxel only, as recovery takes it."""
        if self.scheme not in REPEATING:
            return self
        m = len(self.indices)
        # What is no frame at all is for whoever takes it to refuse.
        if m == 0 or m != len(self.counts):
            return self
        kept = last_samples(self.indices)
        # The samples are evenly spaced, and the last of them are kept.
        return self._replace(
            indices=self.indices[kept], counts=self.counts[kept], duration_us=self.duration_us * len(kept) // m
        )


def last_samples(indices: NDArray[np.uint16]) -> NDArray[np.intp]:
    """Where the last sample of each taxel is among samples, in the order of measurement.

    Parameters
    ----------
    indices : np.ndarray [shape=(m,), dtype=uint16]
        Taxels, in the order of measurement.

    Returns
    -------
    np.ndarray [shape=(taxels,), dtype=intp]
        Ascending, 0 to m - 1.
    """
    # The first in reverse order is the last.
    _, first = np.unique(indices[::-1], return_index=True)
    return np.sort(len(indices) - 1 - first)
