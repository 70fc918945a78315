# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Baseline methods, which interpolate the samples of each frame alone."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, QhullError

from acts_core.array import COUNT_MAX
from acts_core.kernels import kernel
from acts_recon.methods import Method, NoSettings, SkinSetup

_LENGTH_TAXELS = 2.0
_NOISE = 0.05


class _Interpolation(Method):
    """An image of the samples of each frame alone, clipped to 0 to 1023; measured taxels have what was measured."""

    def __init__(self, skin: SkinSetup, config: NoSettings | None = None) -> None:
        geometry = skin.geometry
        self._row_col = np.divmod(np.arange(geometry.rows * geometry.cols), geometry.cols)
        self.image = np.zeros((geometry.rows, geometry.cols), dtype=np.float32)
        self._flat = self.image.ravel()

    def reset(self) -> None:
        """Nothing is kept."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        if not counts.any():
            self._flat.fill(0)
        elif len(indices) == len(self._flat):
            self._flat[indices] = counts
        else:
            self._flat[:] = np.clip(self._interpolate(indices, counts.astype(np.float64)), 0, COUNT_MAX)
            self._flat[indices] = counts
        return self.image

    @abstractmethod
    def _interpolate(self, indices: NDArray[np.uint16], counts: NDArray[np.float64]) -> NDArray[np.float64]:
        """Counts of all taxels, shape (taxels,), from those of some."""


class Linear(_Interpolation):
    """Linear interpolation over the Delaunay triangles of the measured taxels, linear extrapolation beyond them.

    Outside of the convex hull of the measured taxels, the plane of the triangle at the nearest edge is extrapolated.
    The result is clipped to 0 to 1023. Without any triangle, each taxel gets the value of the nearest measured one.
    """

    summary = "linear interpolation"

    def __init__(self, skin: SkinSetup, config: NoSettings | None = None) -> None:
        super().__init__(skin)
        self._places = np.stack(self._row_col, axis=1).astype(np.float64)

    def _interpolate(self, indices: NDArray[np.uint16], counts: NDArray[np.float64]) -> NDArray[np.float64]:
        known = self._places[indices]
        try:
            mesh = Delaunay(known)
        except QhullError:
            return np.asarray(counts[_nearest(self._places, known)])
        owner, opposite = np.nonzero(mesh.neighbors < 0)
        corners = mesh.simplices[owner]
        edge = np.arange(len(owner))
        ends = np.stack((corners[edge, (opposite + 1) % 3], corners[edge, (opposite + 2) % 3]), axis=1)
        image = np.full(self.image.shape, np.nan)
        _fill(image, known, counts, mesh.simplices, owner, ends)
        return image.ravel()


@kernel
def _fill(
    image: NDArray[np.float64],
    known: NDArray[np.float64],
    counts: NDArray[np.float64],
    triangles: NDArray[np.int32],
    owner: NDArray[np.int64],
    ends: NDArray[np.int32],
) -> None:
    """Fill `image` by the plane of each triangle, and outside (NaN) by that of the triangle at the nearest edge."""
    planes = np.zeros((len(triangles), 3))
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        ur, uc = known[b, 0] - known[a, 0], known[b, 1] - known[a, 1]
        vr, vc = known[c, 0] - known[a, 0], known[c, 1] - known[a, 1]
        area = ur * vc - uc * vr
        # Positions are integers, so twice the area of a triangle is at least 1 unless it is degenerate.
        if abs(area) < 0.5:
            planes[t, 0] = counts[a]
            continue
        u, v = counts[b] - counts[a], counts[c] - counts[a]
        planes[t, 1] = (u * vc - v * uc) / area
        planes[t, 2] = (v * ur - u * vr) / area
        planes[t, 0] = counts[a] - planes[t, 1] * known[a, 0] - planes[t, 2] * known[a, 1]
        rows = (known[a, 0], known[b, 0], known[c, 0])
        cols = (known[a, 1], known[b, 1], known[c, 1])
        for row in range(int(min(rows)), int(max(rows)) + 1):
            for col in range(int(min(cols)), int(max(cols)) + 1):
                dr, dc = row - known[a, 0], col - known[a, 1]
                share_b, share_c = (dr * vc - dc * vr) / area, (dc * ur - dr * uc) / area
                if share_b > -1e-9 and share_c > -1e-9 and share_b + share_c < 1 + 1e-9:
                    image[row, col] = planes[t, 0] + planes[t, 1] * row + planes[t, 2] * col
    for row in range(image.shape[0]):
        for col in range(image.shape[1]):
            if not np.isnan(image[row, col]):
                continue
            nearest, best = -1, np.inf
            for e in range(len(owner)):
                first, last = known[ends[e, 0]], known[ends[e, 1]]
                ar, ac = last[0] - first[0], last[1] - first[1]
                share = ((row - first[0]) * ar + (col - first[1]) * ac) / (ar * ar + ac * ac)
                share = min(max(share, 0.0), 1.0)
                square = (row - first[0] - share * ar) ** 2 + (col - first[1] - share * ac) ** 2
                if square < best:
                    nearest, best = owner[e], square
            image[row, col] = planes[nearest, 0] + planes[nearest, 1] * row + planes[nearest, 2] * col


def _nearest(places: NDArray[np.float64], known: NDArray[np.float64]) -> NDArray[np.intp]:
    return np.asarray(np.argmin(((places[:, None] - known[None]) ** 2).sum(axis=2), axis=1))


class GaussianProcess(_Interpolation):
    """Posterior mean of a Gaussian process given the measured taxels, each frame alone.

    The prior mean is 0, the kernel a Matern 3/2 with a length of 2 taxels, and the noise of a reading 5 % of the
    kernel's amplitude. All are fixed: of several kernels this was the best on presses of the contact model. The result
    is clipped to 0 to 1023.
    """

    summary = "a Gaussian process"

    def __init__(self, skin: SkinSetup, config: NoSettings | None = None) -> None:
        super().__init__(skin)
        row, col = self._row_col
        distance = np.sqrt(3) * np.hypot(row[:, None] - row, col[:, None] - col) / _LENGTH_TAXELS
        self._kernel = (1 + distance) * np.exp(-distance)

    def _interpolate(self, indices: NDArray[np.uint16], counts: NDArray[np.float64]) -> NDArray[np.float64]:
        known = self._kernel[indices]
        covariance = known[:, indices] + _NOISE**2 * np.eye(len(indices))
        return np.asarray(np.linalg.solve(covariance, counts) @ known)
