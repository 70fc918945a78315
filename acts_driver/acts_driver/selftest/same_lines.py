# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Lines that respond as one: shorted rows or columns, or columns that a broken address line makes the same."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from acts_driver.selftest.findings import Thresholds

Pairs = set[tuple[int, int]]

# Readings are judged in so many parts, one after the other, of at least so many each.
_PARTS, _PART_READINGS = 8, 30

_MOST_ADDRESS_BITS = 6
_BIT_SHARE = 0.75


def same_pairs(
    pictures: NDArray[np.floating], limit_counts: float, thresholds: Thresholds, *, takes_share: float
) -> Pairs:
    """Pairs of lines whose taxels, one against the other, read the same wherever one of them is pressed.

    Parameters
    ----------
    pictures : np.ndarray [shape=(n, lines, across), dtype=float]
        Rise over the baseline [counts]; NaN for readings that tell nothing.
    limit_counts : float
        Rise above which a taxel is pressed.
    thresholds : Thresholds
    takes_share : float
        Which share of the time from one picture to the next lies between its first line and its last.

    Returns
    -------
    set of (int, int)
        The smaller line first.
    """
    n, lines, _ = pictures.shape
    pairs: Pairs = set()
    for a in range(lines):
        for b in range(a + 1, lines):
            # The second line is measured later: the first, as it was then, on the way to its next reading.
            later = np.float32(takes_share * (b - a) / lines)
            first = pictures[: n - 1, a] + later * (pictures[1:, a] - pictures[: n - 1, a])
            second = pictures[: n - 1, b]
            pressed = np.maximum(first, second) > limit_counts
            if int(pressed.sum()) < thresholds.same_readings:
                continue
            one, other = first[pressed], second[pressed]
            apart = np.abs(one - other) / np.maximum(np.abs(one) + np.abs(other), 1.0)
            # In each part of the time: sound lines read the same for as long as a hand rests flat on both.
            parts = np.array_split(apart, min(_PARTS, max(len(apart) // _PART_READINGS, 1)))
            median, p90 = np.max([np.percentile(part, (50, 90)) for part in parts], axis=0)
            if median <= thresholds.same_median and p90 <= thresholds.same_p90:
                pairs.add((a, b))
    return pairs


def groups_of(pairs: Pairs) -> list[tuple[int, ...]]:
    """Lines that are one, from the pairs that are."""
    groups: list[set[int]] = []
    for pair in sorted(pairs):
        touching = [group for group in groups if group & set(pair)]
        merged = set(pair).union(*touching)
        groups = [group for group in groups if not group & merged]
        groups.append(merged)
    return sorted(tuple(sorted(group)) for group in groups)


def address_bits(pairs: Pairs, cols: int, alive: NDArray[np.bool_]) -> tuple[tuple[int, ...], Pairs]:
    """Bits of the address that explain pairs of columns, and the pairs that none of them explains.

    Parameters
    ----------
    pairs : set of (int, int)
        Columns that respond as one.
    cols : int
    alive : np.ndarray [shape=(cols,), dtype=bool]
        Columns that respond at all: of the others nothing is known.
    """
    bits = []
    for bit in range(_MOST_ADDRESS_BITS):
        partners = [(c, c | 1 << bit) for c in range(cols) if not c >> bit & 1 and (c | 1 << bit) < cols]
        known = [pair for pair in partners if alive[pair[0]] or alive[pair[1]]]
        same = [pair for pair in known if pair in pairs]
        if len(same) >= 2 and len(same) >= _BIT_SHARE * len(known):
            bits.append(bit)
    mask = sum(1 << bit for bit in bits)
    return tuple(bits), {(a, b) for a, b in pairs if a & ~mask != b & ~mask}
