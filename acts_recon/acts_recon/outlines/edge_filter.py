# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The edge of a contact that grows or shrinks while a frame is measured, out of single samples.

In the image of a fast contact most taxels are some frames old. So the edge itself is followed, as a state with a
velocity: its distance from the centre, by the direction theta, and how fast that grows::

    r(theta, t) = sum_k (c_k + d_k t) basis_k(theta)        basis: 1, cos, sin, ..., cos 4 theta, sin 4 theta

Between frames c and d are predicted as of a body under random accelerations (a Kalman filter). A sample at distance
rho says whether it lies inside: with the probability ``1 / (1 + exp((rho - r) / width))``, each at its own time. The
new state is the most probable one (logistic regression with the prediction as its prior, by Newton's method). So a
frame that has measured one side of a contact changes that side only.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_WAVES = 4
_TERMS = 1 + 2 * _WAVES
_WIDTH = 0.4
_STEPS, _SMALLEST_STEP = 8, 1e-3
# Standard deviations at the beginning [taxels, taxels/ms]: of the mean radius, and of each wave.
_BEGIN_SD, _BEGIN_WAVE_SD = (1.0, 1.0), (0.35, 0.3)
_FASTEST_BEGIN = 2.0
# Random accelerations of the mean radius, and of each wave [taxels/ms per root ms].
_SHAKE, _WAVE_SHAKE = 0.5, 0.18
# Where it is not measured an edge is round within this, in each of so many directions [taxels, taxels/ms].
_ROUND_SD, _DIRECTIONS = (3.0, 1.0), 24
_CORNERS = 72
_LEAST_RADIUS, _LEAST_MEAN = 0.1, 0.4


class EdgeFilter:
    """The edge of one contact, in taxels and milliseconds.

    Parameters
    ----------
    row, col : float
        Its centre.
    radius : float
        Its mean radius.
    growth : float
        How fast that grows, about [taxels/ms].
    time_ms : float
        Of the frame.
    """

    def __init__(self, row: float, col: float, radius: float, growth: float, time_ms: float) -> None:
        self.row, self.col = row, col
        self._time_ms = time_ms
        self._state = np.zeros(2 * _TERMS)
        self._state[0], self._state[_TERMS] = radius, min(growth, _FASTEST_BEGIN)
        waves = np.ones(2 * _WAVES)
        sd = np.concatenate([np.r_[_BEGIN_SD[k], _BEGIN_WAVE_SD[k] * waves] for k in (0, 1)])
        self._covariance = np.diag(sd**2)
        self._shake = np.r_[_SHAKE, _WAVE_SHAKE * waves] ** 2

    @property
    def radius(self) -> float:
        """Mean radius [taxels]."""
        return float(self._state[0])

    def predict(self, time_ms: float) -> None:
        """Go on to a later time."""
        step = time_ms - self._time_ms
        self._time_ms = time_ms
        on = np.eye(2 * _TERMS)
        on[:_TERMS, _TERMS:] = step * np.eye(_TERMS)
        shake = np.diag(self._shake)
        noise = np.block([[shake * step**3 / 3, shake * step**2 / 2], [shake * step**2 / 2, shake * step]])
        self._state = on @ self._state
        self._covariance = on @ self._covariance @ on.T + noise

    def round_off(self, is_measured: NDArray[np.bool_]) -> None:
        """Take the edge for round where it lies on taxels that are never measured, or beyond the picture.

        There the last motion would go on for ever, and in the end turn what lies on the others.

        Parameters
        ----------
        is_measured : np.ndarray [shape=(rows, cols), dtype=bool]
            Which taxels of the picture are, on this patch.
        """
        angle = 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
        row = np.rint(self.row + self.radius * np.sin(angle)).astype(int)
        col = np.rint(self.col + self.radius * np.cos(angle)).astype(int)
        rows, cols = is_measured.shape
        is_known = (row >= 0) & (row < rows) & (col >= 0) & (col < cols)
        is_known &= is_measured[np.clip(row, 0, rows - 1), np.clip(col, 0, cols - 1)]
        if is_known.all():
            return
        waves = _basis(angle[~is_known])
        waves[:, 0] = 0.0
        columns = np.kron(np.eye(2), waves)
        # Of a Kalman filter that measures 0.
        noise = np.diag(np.repeat(_ROUND_SD, len(waves)) ** 2)
        seen = columns @ self._covariance
        gain = np.linalg.solve(seen @ columns.T + noise, seen).T
        kept = np.eye(2 * _TERMS) - gain @ columns
        self._state = kept @ self._state
        # In this form (Joseph's) it stays symmetric.
        self._covariance = kept @ self._covariance @ kept.T + gain @ noise @ gain.T

    def update(self, row: Array, col: Array, since_ms: Array, inside: Array) -> None:
        """Take the samples of a frame.

        Parameters
        ----------
        row, col : np.ndarray [shape=(n,), dtype=float64]
            Where they lie.
        since_ms : np.ndarray [shape=(n,), dtype=float64]
            When they were measured, since the time predicted to.
        inside : np.ndarray [shape=(n,), dtype=float64]
            How much each speaks for lying inside, 0 to 1.
        """
        if not row.size:
            return
        away = np.hypot(row - self.row, col - self.col)
        basis = _basis(np.arctan2(row - self.row, col - self.col))
        columns = np.hstack((basis, basis * since_ms[:, None]))
        known = np.linalg.inv(self._covariance)

        def unlikely(state: Array) -> float:
            margin, moved = (columns @ state - away) / _WIDTH, state - self._state
            return float(np.sum(np.logaddexp(0.0, margin) - inside * margin) + moved @ known @ moved / 2)

        state, bend = self._state.copy(), known
        now = unlikely(state)
        for _ in range(_STEPS):
            chance = 1 / (1 + np.exp(np.clip((away - columns @ state) / _WIDTH, -30.0, 30.0)))
            slope = columns.T @ (chance - inside) / _WIDTH + known @ (state - self._state)
            # Far from the edge a sample says nothing; the small number keeps steps finite.
            bend = (columns * (chance * (1 - chance) + 1e-3)[:, None]).T @ columns / _WIDTH**2 + known
            step = np.linalg.solve(bend, slope)
            after = unlikely(state - step)
            while after > now and np.abs(step).max() > _SMALLEST_STEP:
                step = step / 2
                after = unlikely(state - step)
            state, now = state - step, after
            if np.abs(step).max() <= _SMALLEST_STEP:
                break
        self._state, self._covariance = state, np.linalg.inv(bend)
        # The first wave moves the whole edge: that is the centre's.
        self.col += float(state[1])
        self.row += float(state[1 + _WAVES])
        state[[1, 1 + _WAVES]] = 0.0

    def corners(self) -> Array:
        """Rows and columns of the edge; np.ndarray [shape=(n, 2), dtype=float64], empty where it has none any more."""
        if self.radius < _LEAST_MEAN:
            return np.zeros((0, 2))
        angle = 2 * np.pi * np.arange(_CORNERS) / _CORNERS
        reach = np.maximum(_basis(angle) @ self._state[:_TERMS], _LEAST_RADIUS)
        return np.column_stack((self.row + reach * np.sin(angle), self.col + reach * np.cos(angle)))


def _basis(angle: Array) -> Array:
    waves = angle[:, None] * np.arange(1, _WAVES + 1)
    return np.column_stack((np.ones_like(angle), np.cos(waves), np.sin(waves)))
