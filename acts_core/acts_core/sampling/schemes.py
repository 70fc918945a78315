"""The sampling schemes: which taxels of a frame are measured, and in which order.

The firmware (``acts_firmware``, C++) does this on the board. This is its reference: the same taxels in the same order,
readable, and usable where there is no board. A test compares the two on random and on recorded fields.

A new scheme is a function from what it needs to row-major taxel indices in the order of measurement, none twice, plus
a branch in `Sampler.frame`, and the same in the C++ core. One that remembers is a class (`tracking`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_core.array import COUNT_MAX, MAX_SIDE
from acts_core.errors import ArrayError, SettingsError
from acts_core.frames import Scheme
from acts_core.sampling.dither_order import dither_order
from acts_core.sampling.random_taxels import RandomTaxels
from acts_core.sampling.skin_map import SkinMap
from acts_core.sampling.tracking import Tracking
from acts_core.sampling.uniform import uniform, uniform_spacing
from acts_core.settings import setting, validate

Measure = Callable[[int, int], int]
"""Measures one taxel: row and column to ADC counts."""

SCHEMES = {
    "adaptive": Scheme.ADAPTIVE,
    "tracking": Scheme.TRACKING,
    "hybrid": Scheme.HYBRID,
    "uniform": Scheme.UNIFORM,
    "random": Scheme.RANDOM,
    "raster": Scheme.RASTER,
}

NEIGHBOURS: dict[str, tuple[tuple[int, int], ...]] = {
    # Columns outer, the taxel's own first: the published sketches.
    "columns": ((-1, 0), (1, 0), (-1, -1), (0, -1), (1, -1), (-1, 1), (0, 1), (1, 1)),
    # Rows outer: fits the adaptive frames of the paper's figures 4 and 5.
    "rows": ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)),
}
"""Steps (rows, columns) to the eight neighbours of a taxel in the order of search, by neighbour order."""


@dataclass(frozen=True)
class SamplingConfig:
    """What a board is told about sampling."""

    scheme: str = setting("adaptive", "how the taxels of a frame are chosen", choices=tuple(SCHEMES))
    rows: int = setting(32, "rows of the array", minimum=1, maximum=MAX_SIDE)
    cols: int = setting(32, "columns of the array", minimum=1, maximum=MAX_SIDE)
    m: int = setting(55, "taxels measured per frame; raster measures all", minimum=1, maximum=MAX_SIDE**2)
    threshold_counts: int = setting(
        180,
        "counts above which adaptive and hybrid search a taxel's neighbours and tracking follows it",
        minimum=0,
        maximum=COUNT_MAX,
    )
    neighbour_order: str = setting("columns", "order of the neighbour search", choices=tuple(NEIGHBOURS))
    seed: int = setting(1, "seed of random and hybrid sampling", minimum=0, maximum=2**64 - 1)
    # Smaller shares would all mean the same: one taxel of even the largest array.
    search_share: float = setting(
        0.2, "share of a tracking frame that is kept for the search", minimum=0.0001, maximum=1.0
    )
    adaptive_share: float = setting(
        0.5, "share of a hybrid frame that is chosen adaptively", minimum=0.0001, maximum=1.0
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.m > self.rows * self.cols and self.scheme != "raster":
            raise SettingsError(
                f"m = {self.m}: an array of {self.rows} x {self.cols} has {self.rows * self.cols} taxels"
            )
        if self.scheme == "uniform":
            uniform_spacing(self.rows, self.cols, self.m)

    @property
    def search_quota(self) -> int:
        """Taxels of a tracking frame that are kept for the search: ``ceil(search_share * m)``, 1 to `m`."""
        return math.ceil(self.search_share * self.m)

    @property
    def adaptive_quota(self) -> int:
        """Taxels of a hybrid frame that are chosen adaptively: ``ceil(adaptive_share * m)``, 1 to `m`."""
        return math.ceil(self.adaptive_share * self.m)


class Sampler:
    """Samples frame after frame; holds what goes from one to the next (uniform offset, random numbers, flags).

    Parameters
    ----------
    config : SamplingConfig
    skin_map : SkinMap, optional
        How the taxels lie on the skin, for the schemes that look for neighbours; without it, as in the matrix.
    """

    def __init__(self, config: SamplingConfig, skin_map: SkinMap | None = None) -> None:
        self.config = config
        self._map = skin_map or SkinMap.of_matrix(config.rows, config.cols)
        if len(self._map.taxels) != config.rows * config.cols:
            raise ArrayError(
                f"map of {len(self._map.taxels)} taxels: the matrix is {config.rows} x {config.cols}; give one of that"
            )
        self._frame = 0
        self._random = RandomTaxels(config.rows, config.cols, config.seed)
        self._tracking = Tracking(
            dither_order(self._map.rows, self._map.cols),
            self._map,
            config.cols,
            config.m,
            search_quota=config.search_quota,
            threshold_counts=config.threshold_counts,
        )

    def frame(self, measure: Measure) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        """Sample one frame.

        Parameters
        ----------
        measure : Measure
            Called once for each taxel measured, in order.

        Returns
        -------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices in the order of measurement, none twice, and what was measured there.
        """
        config = self.config
        if config.scheme == "adaptive":
            return self._adaptive(measure, config.m)
        if config.scheme == "hybrid":
            return self._hybrid(measure)
        if config.scheme == "tracking":
            return self._tracking.frame(measure)
        if config.scheme == "uniform":
            indices = uniform(config.rows, config.cols, config.m, self._frame)
        elif config.scheme == "random":
            indices = self._random.draw(config.m)
        else:
            indices = raster(config.rows, config.cols)
        self._frame += 1
        return indices, self._measure(measure, indices)

    def _adaptive(self, measure: Measure, m: int) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        config = self.config
        return adaptive(
            measure,
            config.rows,
            config.cols,
            m,
            threshold_counts=config.threshold_counts,
            neighbour_order=config.neighbour_order,
            skin_map=self._map,
        )

    def _hybrid(self, measure: Measure) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
        """Adaptive sampling for its quota, then random taxels among those that this frame has not measured."""
        found, found_counts = self._adaptive(measure, self.config.adaptive_quota)
        drawn = self._random.draw(self.config.m - len(found), measured=found)
        return np.concatenate((found, drawn)), np.concatenate((found_counts, self._measure(measure, drawn)))

    def _measure(self, measure: Measure, indices: NDArray[np.uint16]) -> NDArray[np.uint16]:
        counts = [measure(*divmod(int(index), self.config.cols)) for index in indices]
        return np.array(counts, dtype=np.uint16)


def measure_in(field: ArrayLike) -> Measure:
    """Measure in a still field.

    Parameters
    ----------
    field : array_like [shape=(rows, cols), dtype=any integer]
        ADC counts of every taxel.
    """
    image = np.asarray(field)
    if image.ndim != 2 or image.dtype.kind not in "iu":
        raise ArrayError(f"field of shape {image.shape} and type {image.dtype}: a field is (rows, cols) whole counts")
    values = image.tolist()
    return lambda row, col: int(values[row][col])


def adaptive(
    measure: Measure,
    rows: int,
    cols: int,
    m: int,
    *,
    threshold_counts: int = 180,
    neighbour_order: str = "columns",
    skin_map: SkinMap | None = None,
) -> tuple[NDArray[np.uint16], NDArray[np.uint16]]:
    """Walk the division order; around a taxel above the threshold search the neighbours first, depth first.

    Paper, Supplemental Algorithm 1, with the two points in which the published firmware differs from it: exactly `m`
    taxels are measured, and the threshold itself does not count as a touch. Order and neighbours are those of the skin
    where there is a `skin_map`, and no neighbour is on another patch.

    Returns
    -------
    indices, counts : np.ndarray [shape=(m,), dtype=uint16]
        As in `Sampler.frame`.
    """
    skin = skin_map or SkinMap.of_matrix(rows, cols)
    steps = NEIGHBOURS[neighbour_order]
    measured = np.zeros((skin.rows, skin.cols), dtype=bool)
    indices: list[int] = []
    counts: list[int] = []

    def touched(row: int, col: int) -> bool:
        place = row * skin.cols + col
        count = measure(*divmod(skin.taxels[place], cols))
        measured[row, col] = True
        indices.append(skin.taxels[place])
        counts.append(count)
        return count > threshold_counts and skin.has_skin(place)

    for place in division_order(skin.rows, skin.cols).tolist():
        if len(indices) == m:
            break
        row, col = divmod(place, skin.cols)
        if measured[row, col] or not touched(row, col):
            continue
        # A stack instead of recursion, here and on the board: a palm on the skin is a thousand levels deep.
        stack = [(row, col, iter(steps))]
        while stack and len(indices) < m:
            row, col, remaining = stack[-1]
            step = next(remaining, None)
            if step is None:
                stack.pop()
                continue
            near_row, near_col = row + step[0], col + step[1]
            outside = not (0 <= near_row < skin.rows and 0 <= near_col < skin.cols)
            if outside or measured[near_row, near_col]:
                continue
            if not skin.joined(row * skin.cols + col, near_row * skin.cols + near_col):
                continue
            if touched(near_row, near_col):
                stack.append((near_row, near_col, iter(steps)))
    return np.array(indices, dtype=np.uint16), np.array(counts, dtype=np.uint16)


@lru_cache(maxsize=32)
def division_order(rows: int, cols: int) -> NDArray[np.uint16]:
    """Every taxel once, from coarse to fine: the centres of ever smaller halves of the array.

    Centres are kept doubled (the first is ``(rows, cols)``) and halved, rounding down, when listed. Each round splits
    every cell across its longer side, the columns where both are equal: the step along that side is halved, rounding
    up, and each centre yields the two at that step before and behind it. Centres outside of the array are split on but
    not listed. The rounds end when both steps are 1: by then no taxel is missing. On 32 x 32 these are the ten rounds
    of the published firmware; other sizes, also non-square, are a generalisation.

    Returns
    -------
    np.ndarray [shape=(rows * cols,), dtype=uint16, read-only]
        Row-major taxel indices.
    """
    listed = np.zeros((rows, cols), dtype=bool)
    order: list[int] = []

    def put(row2: int, col2: int) -> None:
        row, col = row2 >> 1, col2 >> 1
        if 0 <= row < rows and 0 <= col < cols and not listed[row, col]:
            listed[row, col] = True
            order.append(row * cols + col)

    centres = [(rows, cols)]
    put(rows, cols)
    row_step, col_step = rows, cols
    while row_step > 1 or col_step > 1:
        if col_step >= row_step:
            col_step = (col_step + 1) // 2
            step = (0, col_step)
        else:
            row_step = (row_step + 1) // 2
            step = (row_step, 0)
        centres = [(row + sign * step[0], col + sign * step[1]) for row, col in centres for sign in (-1, 1)]
        for row, col in centres:
            put(row, col)
    result = np.array(order, dtype=np.uint16)
    result.flags.writeable = False
    return result


def raster(rows: int, cols: int) -> NDArray[np.uint16]:
    """All taxels row by row; shape (rows * cols,), uint16."""
    return np.arange(rows * cols, dtype=np.uint16)
