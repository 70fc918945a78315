# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Dead taxels: broken ones, of which the readings say nothing.

Their samples are left out, and what presses there is estimated from the live taxels around: kriging, as Gaussian
process regression is called in geostatistics (Rasmussen and Williams, Gaussian Processes for Machine Learning, 2006,
eqs. 2.23 and 2.24). Pressure at the distance of d taxels is correlated by ``exp(-d^2 / (2 LENGTH_TAXELS^2))``, which
is about how far a foam spreads it. With the correlations ``K`` between live taxels, and ``k`` between them and a dead
one, the estimate is ``w . counts`` with ``w = (K + NOISE_SHARE I)^-1 k``, but at most twice what is read beside it:
pressure does not jump over live taxels, while weights change their sign with the distance. What these leave
unknown is the share ``1 - w . k`` of the variance; the largest of the counts around stands for the standard deviation
of pressure. Where more than half is unknown, as in the middle of several dead lines, counts of 0 around say little: the
standard deviation is at least that of the method, which has never measured there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.kernels import kernel
from acts_core.settings import setting, validate
from acts_core.skin import TAXELS_RULE, Layout, dead_taxels_named
from acts_recon.images.borders import borders_of
from acts_recon.images.frame_check import require_image, require_samples

LENGTH_TAXELS = 1.3
"""At this distance pressures are correlated by exp(-1/2)."""

NOISE_SHARE = 0.03
"""Variance of what correlations do not explain, over that of pressure: keeps weights small."""

_KNOWN_SHARE = 0.5
"""Of the variance: where less is known, an estimate is no surer than a taxel that was never measured."""

_MOST_OF_BESIDE = 2.0
"""An estimate is no more than this times the largest count beside it; where a contact is, none needs to be."""

_BESIDE_TAXELS = 1.5
"""Live taxels as near as this are beside a dead one, and so is the next live one along its row and its column."""

_REACH = 3
"""Live taxels farther away, in rows or columns, are not used: their weights are next to 0."""

_UNKNOWN = np.zeros(0, dtype=np.float32)
"""In place of standard deviations that are not known."""


@dataclass(frozen=True)
class DeadTaxelsConfig:
    """Which taxels are dead."""

    dead_taxels: str = setting(
        "",
        f"broken taxels of the matrix, as acts selftest names them: {TAXELS_RULE}; their readings are not used, and "
        "what presses there is estimated from the taxels around; empty: none",
    )

    def __post_init__(self) -> None:
        validate(self)

    def dead(self, rows: int, cols: int) -> NDArray[np.bool_] | None:
        """Which taxels of a matrix of this size are; bool (rows, cols), or None where none is.

        Raises
        ------
        SettingsError
            `dead_taxels` names no taxels of it, or all of them.
        """
        named = dead_taxels_named(self.dead_taxels, rows, cols)
        return named if named.any() else None


class DeadTable(NamedTuple):
    """How dead taxels of an image are estimated, for kernels: those that have a live taxel near.

    Attributes
    ----------
    places : np.ndarray [shape=(n,), dtype=intp]
        Where they are in the flat image.
    around : np.ndarray [shape=(n, k), dtype=intp]
        Where the live taxels are that each is estimated from.
    weights : np.ndarray [shape=(n, k), dtype=float32]
        Of these; 0 where there are fewer than k.
    unknown_share : np.ndarray [shape=(n,), dtype=float32]
        Share of the variance of pressure that these leave unknown.
    beside : np.ndarray [shape=(n, k), dtype=bool]
        Which of `around` lie beside it.
    """

    places: NDArray[np.intp]
    around: NDArray[np.intp]
    weights: NDArray[np.float32]
    unknown_share: NDArray[np.float32]
    beside: NDArray[np.bool_]


NO_DEAD = DeadTable(
    np.zeros(0, dtype=np.intp),
    np.zeros((0, 1), dtype=np.intp),
    np.zeros((0, 1), dtype=np.float32),
    np.zeros(0, dtype=np.float32),
    np.zeros((0, 1), dtype=np.bool_),
)
"""Where no taxel is dead."""


class DeadTaxels:
    """Leaves out samples of dead taxels, and estimates these in images.

    Parameters
    ----------
    dead : np.ndarray [shape=(matrix rows, matrix cols), dtype=bool]
        Which taxels of the matrix are.
    geometry : ArrayGeometry
        Of the picture; without a layout that is the matrix itself.
    layout : Layout, optional
        Where the taxels of the matrix lie in the picture. Only taxels of the same patch are used.

    Attributes
    ----------
    in_picture : np.ndarray [shape=(rows, cols), dtype=bool]
        Which taxels of the picture are dead.
    table : DeadTable
        Of the picture.

    Raises
    ------
    ArrayError
        When `dead` is no array of bool, or of another matrix.
    """

    def __init__(self, dead: NDArray[np.bool_], geometry: ArrayGeometry, layout: Layout | None = None) -> None:
        matrix = (geometry.rows, geometry.cols) if layout is None else (layout.matrix_rows, layout.matrix_cols)
        # Lists come from callers without types.
        if not isinstance(dead, np.ndarray):
            raise ArrayError(f"dead is {type(dead).__name__}: needed is an array of numpy of shape {matrix}, bool")
        if dead.shape != matrix or dead.dtype != np.bool_:
            raise ArrayError(f"dead of shape {dead.shape}, {dead.dtype}: needed is {matrix}, bool")
        # An index outside of the matrix stays, for whoever takes the frame to refuse.
        self._is_live = np.ones(2**16, dtype=np.bool_)
        self._is_live[: dead.size] = ~dead.ravel()
        self.in_picture = in_picture = np.zeros((geometry.rows, geometry.cols), dtype=np.bool_)
        in_picture.ravel()[np.arange(dead.size) if layout is None else layout.places] = dead.ravel()
        rectangle_of = borders_of(geometry.rows, geometry.cols, layout).rectangle_of.reshape(in_picture.shape)
        places: NDArray[np.intp] = np.flatnonzero(in_picture)
        around = np.zeros((len(places), (2 * _REACH + 1) ** 2), dtype=np.intp)
        weights = np.zeros(around.shape, dtype=np.float32)
        unknown_share = np.ones(len(places), dtype=np.float32)
        beside = np.zeros(around.shape, dtype=np.bool_)
        for i, (row, col) in enumerate(np.argwhere(in_picture)):
            top, left = max(row - _REACH, 0), max(col - _REACH, 0)
            near = np.s_[top : row + _REACH + 1, left : col + _REACH + 1]
            live = np.argwhere(~in_picture[near] & (rectangle_of[near] == rectangle_of[row, col]))
            live += np.array([top, left])
            correlation = _correlation(live, np.array([[row, col]]))[:, 0]
            between = _correlation(live, live) + NOISE_SHARE * np.eye(len(live))
            n = len(live)
            around[i, :n] = live[:, 0] * geometry.cols + live[:, 1]
            weights[i, :n] = np.linalg.solve(between, correlation)
            unknown_share[i] = 1.0 - weights[i, :n] @ correlation
            beside[i, :n] = _are_beside(live - (row, col))
        # Where no live taxel is near, the image is left as the method has it.
        known = (weights != 0.0).any(axis=1)
        self.table = DeadTable(places[known], around[known], weights[known], unknown_share[known], beside[known])
        # Compile, or load from the cache, what the first frame would otherwise wait for.
        blank = np.zeros((geometry.rows, geometry.cols), dtype=np.float32)
        self.fill(blank, blank)

    def require_shape(self, rows: int, cols: int) -> None:
        """Raise `ArrayError` unless they are of a picture of this size."""
        if self.in_picture.shape != (rows, cols):
            given_rows, given_cols = self.in_picture.shape
            raise ArrayError(f"dead taxels of {given_rows} x {given_cols}: the image is {rows} x {cols}")

    def left_out(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16]
    ) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        """The samples of a frame without those of dead taxels.

        The others are taken for evenly spaced, as those of every frame are. So with a dead row of 32 they are dated
        wrong by up to a thirty-second of the frame's duration. A board that was not told of a row that is stuck high
        follows it with tracking, and measures what it follows last: then the others are dated too late, by up to 0.56
        of it in a frame of 55 samples.

        Parameters
        ----------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices of the matrix, and what was measured there.

        Raises
        ------
        ArrayError
            These are no samples, or all are of dead taxels.
        """
        require_samples(indices, counts)
        kept = self._is_live[indices]
        if kept.all():
            return indices, counts
        if not kept.any():
            raise ArrayError(
                f"only dead taxels were measured, index {indices[0]} first: needed is at least one that works; let the "
                "board measure others, or correct dead_taxels"
            )
        return indices[kept], counts[kept]

    def fill(self, image: NDArray[np.float32], sigma: NDArray[np.float32] | None) -> None:
        """Write what the taxels around say into an image, and its standard deviation.

        Parameters
        ----------
        image : np.ndarray [shape=(rows, cols), dtype=float32]
            Counts; written, in whole counts as readings are. C-contiguous, as is `sigma`.
        sigma : np.ndarray [shape=(rows, cols), dtype=float32] or None
            Standard deviation of it, as the method has it [counts]; written.

        Raises
        ------
        ArrayError
            When one of them is of another kind or size, or cannot be written.
        """
        for name, array in {"image": image, **({} if sigma is None else {"sigma": sigma})}.items():
            require_image(name, array, self.in_picture.shape, must_be_contiguous=True)
            if not array.flags.carray:
                raise ArrayError(f"{name} is read-only: estimates are written into it; give a copy")
        fill_dead(image.ravel(), _UNKNOWN if sigma is None else sigma.ravel(), self.table)


@kernel
def fill_dead(image: NDArray[np.float32], sigma: NDArray[np.float32], table: DeadTable) -> None:
    """See `DeadTaxels.fill`; flat arrays, `sigma` is empty where it is not known."""
    places, around, weights, beside = table.places, table.around, table.weights, table.beside
    unknown_share = table.unknown_share
    for i in range(places.shape[0]):
        estimate = variance = largest = largest_beside = 0.0
        for j in range(around.shape[1]):
            weight, taxel = float(weights[i, j]), around[i, j]
            # The others fill up the row.
            if weight != 0.0:
                estimate += weight * image[taxel]
                largest = max(largest, float(image[taxel]))
                if beside[i, j]:
                    largest_beside = max(largest_beside, float(image[taxel]))
                if sigma.shape[0] > 0:
                    variance += (weight * sigma[taxel]) ** 2
        estimate = min(estimate, _MOST_OF_BESIDE * largest_beside)
        image[places[i]] = np.float32(round(min(max(estimate, 0.0), float(COUNT_MAX))))
        if sigma.shape[0] > 0:
            deviation = np.float32(math.sqrt(variance + unknown_share[i] * largest**2))
            if unknown_share[i] > 1.0 - _KNOWN_SHARE:
                deviation = max(deviation, sigma[places[i]])
            sigma[places[i]] = deviation


def _are_beside(away: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Which live taxels lie beside a dead one; `away` (n, 2): rows and columns from it. Where none does, all do."""
    beside: NDArray[np.bool_] = np.hypot(*away.T) <= _BESIDE_TAXELS
    for along, across in ((0, 1), (1, 0)):
        for sign in (-1, 1):
            steps = np.where(away[:, across] == 0, sign * away[:, along], 0)
            if (steps > 0).any():
                beside |= steps == steps[steps > 0].min()
    return beside if beside.any() else np.ones(len(away), dtype=np.bool_)


def _correlation(places: NDArray[np.intp], others: NDArray[np.intp]) -> NDArray[np.float64]:
    """Of the pressures at each of `places` (n, 2) and each of `others` (m, 2); (n, m)."""
    squares = np.square(places[:, None] - others[None]).sum(axis=2)
    return np.exp(-squares / (2.0 * LENGTH_TAXELS**2))
