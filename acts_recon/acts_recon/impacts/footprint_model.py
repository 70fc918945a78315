# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A footprint on the skin that moves straight on while it grows and shrinks, and which one explains samples best.

With r0 its centre at a middle time and v its velocity, the force on a taxel at r is::

    force(t, r) = A(t) exp(-(d' E d / w(t)^2)^(3/2) / 2)        d = r - r0 - v t

With the third power of the distance it is flatter in the middle than a Gaussian, and has less force at its foot: so it
is nearer to the pressure under a ball, Hertz's half ellipsoid blurred by the foam. The logarithms of A and w are linear
between nodes, one a frame.

Of a round footprint E is 1. Of a long one it is an exponential, so its determinant is 1 and the area goes with w^2::

    E = exp(-S)        S = | p   q |        length / width = exp(s)        s = (p^2 + q^2)^(1/2)
                           | q  -p |

As S S = s^2, E = cosh(s) - S sinh(s) / s.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Exponent of the squared distance in the footprint.
_POWER = 1.5
VOLUME = math.pi * 2.0 ** (1.0 / _POWER) * math.gamma(1.0 + 1.0 / _POWER)
"""The footprint's integral over the plane for A = w = 1."""

_STEPS = 30
# How far amplitude and width go from node to node, as natural logarithms.
_AMPLITUDE_STEP, _WIDTH_STEP = 1.5, 0.4
# How far they are from the largest force and from the width of all samples together, likewise.
_AMPLITUDE_SD, _WIDTH_SD = 0.7, 0.15
# How far p and q are from 0.
_STRETCH_SD = 1.0
# The samples' spread across is taken to be at least this share of that along, both as squares.
_LEAST_SPREAD = 1e-3
# Points of a footprint along each axis, and how many widths away the last are: beyond lies little of its force.
_POINTS, _FARTHEST = 41, 2.6
# sinh(s) / s and its derivative are series below.
_LEAST_STRETCH = 1e-3


class FootprintModel:
    """The footprint, its derivatives and what is measured; lengths in mm, times in ms.

    A state is of r0, v, the logarithms of A and of w at the nodes, and of a long footprint p and q.

    Parameters
    ----------
    time_ms, x_mm, y_mm, force_n, sd_n : np.ndarray [shape=(n,), dtype=float64]
        When and where each sample was measured, the force on its taxel, and the standard deviation of that.
    nodes : int
    is_long : bool
        Whether the footprint may be longer than wide.
    """

    def __init__(
        self, time_ms: Array, x_mm: Array, y_mm: Array, force_n: Array, sd_n: Array, nodes: int, *, is_long: bool
    ) -> None:
        self.x, self.y, self.force, self.sd = x_mm, y_mm, force_n, sd_n
        self.middle = float(force_n @ time_ms) / float(force_n.sum())
        self.since = time_ms - self.middle
        self.at = at = np.linspace(time_ms.min(), time_ms.max(), nodes)
        self.share = np.maximum(0.0, 1.0 - np.abs(time_ms[:, None] - at) / (at[1] - at[0]))
        self.amplitudes, self.widths = slice(4, 4 + nodes), slice(4 + nodes, 4 + 2 * nodes)
        self._stretch = slice(4 + 2 * nodes, 6 + 2 * nodes if is_long else 4 + 2 * nodes)
        each = np.eye(self._stretch.stop)
        self.prior = np.vstack(
            (
                np.diff(each[self.amplitudes], axis=0) / _AMPLITUDE_STEP,
                np.diff(each[self.widths], axis=0) / _WIDTH_STEP,
                each[self.amplitudes] / _AMPLITUDE_SD,
                each[self.widths] / _WIDTH_SD,
                each[self._stretch] / _STRETCH_SD,
            )
        )
        self.before = np.zeros(self._stretch.stop)

    def start(self) -> Array:
        """The state that the samples suggest, of which `before` is what is known beforehand."""
        total = float(self.force.sum())
        x, y = float(self.force @ self.x) / total, float(self.force @ self.y) / total
        dx, dy = self.x - x, self.y - y
        spread = np.array([[self.force @ (dx * dx), self.force @ (dx * dy)], [0.0, self.force @ (dy * dy)]]) / total
        before = np.zeros(self._stretch.stop)
        before[:2] = x, y
        before[self.amplitudes] = np.log(float(self.force.max()))
        before[self.widths] = 0.5 * np.log(float(np.trace(spread)))
        self.before = before
        state = before.copy()
        if self.is_long:
            squares, axes = np.linalg.eigh(spread, UPLO="U")
            logs = np.log(np.maximum(squares, _LEAST_SPREAD * squares[1]))
            p, q = ((axes * (logs - logs.mean())) @ axes.T)[0]
            state[self._stretch] = p, q
            # The spread is mostly that along it.
            before[self.widths] -= 0.5 * np.log(np.cosh(np.hypot(p, q)))
            state[self.widths] = before[self.widths]
        return state

    @property
    def is_long(self) -> bool:
        """Whether the footprint may be longer than wide."""
        return self._stretch.start < self._stretch.stop

    def stretch_of(self, state: Array) -> Array:
        """p and q of a state; 0 of a round footprint."""
        return state[self._stretch].copy() if self.is_long else np.zeros(2)

    def residuals(self, state: Array) -> Array:
        """Of the samples, then of what is known beforehand, as shares of their standard deviations."""
        return np.concatenate(((self._force(state)[0] - self.force) / self.sd, self.prior @ (state - self.before)))

    def jacobian(self, state: Array) -> Array:
        """Derivatives of the residuals."""
        force, dx, dy, square, width = self._force(state)
        ex, ey = self._turned(state, dx, dy)
        pull = _POWER * force * square ** (_POWER - 1.0) / width**2
        of_place = np.column_stack((pull * ex, pull * ey, pull * ex * self.since, pull * ey * self.since))
        of_shape = np.hstack((force[:, None] * self.share, (_POWER * force * square**_POWER)[:, None] * self.share))
        of_stretch = -0.5 * pull[:, None] * self._of_stretch(state, dx, dy)
        return np.vstack((np.hstack((of_place, of_shape, of_stretch)) / self.sd[:, None], self.prior))

    def _force(self, state: Array) -> tuple[Array, Array, Array, Array, Array]:
        top = np.exp(self.share @ state[self.amplitudes])
        width = np.exp(self.share @ state[self.widths])
        dx = self.x - state[0] - state[2] * self.since
        dy = self.y - state[1] - state[3] * self.since
        ex, ey = self._turned(state, dx, dy)
        # By rounding it may be less than 0.
        square = np.maximum(dx * ex + dy * ey, 0.0) / width**2
        return top * np.exp(-0.5 * square**_POWER), dx, dy, square, width

    def _turned(self, state: Array, dx: Array, dy: Array) -> tuple[Array, Array]:
        """E d."""
        if not self.is_long:
            return dx, dy
        p, q = state[self._stretch].tolist()
        cosh, sinh_share, _ = _hyperbolic(math.hypot(p, q))
        return (cosh - sinh_share * p) * dx - sinh_share * q * dy, (cosh + sinh_share * p) * dy - sinh_share * q * dx

    def _of_stretch(self, state: Array, dx: Array, dy: Array) -> Array:
        """Derivatives of d' E d by p and q; shape (n, 2), of a round footprint (n, 0)."""
        if not self.is_long:
            return np.zeros((dx.size, 0))
        p, q = state[self._stretch].tolist()
        _, sinh_share, slope = _hyperbolic(math.hypot(p, q))
        of_p, of_q = dx * dx - dy * dy, 2.0 * dx * dy
        both = sinh_share * (dx * dx + dy * dy) - slope * (p * of_p + q * of_q)
        return np.column_stack((p * both - sinh_share * of_p, q * both - sinh_share * of_q))


def spread_points(stretch: Array) -> tuple[Array, Array, Array]:
    """Points all over a footprint of the width 1, and which share of its force each stands for.

    Parameters
    ----------
    stretch : np.ndarray [shape=(2,), dtype=float64]
        p and q.

    Returns
    -------
    dx, dy, share : np.ndarray [shape=(n,), dtype=float64]
        How far each is from the centre. The shares add up to 1.
    """
    along = np.linspace(-_FARTHEST, _FARTHEST, _POINTS)
    u, v = (axis.ravel() for axis in np.meshgrid(along, along))
    share = np.exp(-0.5 * (u * u + v * v) ** _POWER)
    p, q = stretch.tolist()
    # The inverse root of E is exp(S / 2).
    cosh, sinh_share, _ = _hyperbolic(math.hypot(p, q) / 2.0)
    dx = cosh * u + sinh_share * (p * u + q * v) / 2.0
    dy = cosh * v + sinh_share * (q * u - p * v) / 2.0
    return dx, dy, share / share.sum()


def _hyperbolic(s: float) -> tuple[float, float, float]:
    """cosh(s), sinh(s) / s, and the derivative of the latter by s over s."""
    if s < _LEAST_STRETCH:
        return 1.0 + s * s / 2.0, 1.0 + s * s / 6.0, 1.0 / 3.0
    cosh, sinh_share = math.cosh(s), math.sinh(s) / s
    return cosh, sinh_share, (cosh - sinh_share) / (s * s)


def minimise(model: FootprintModel, state: Array) -> Array:
    """The state that explains the samples best, from this one on, by Levenberg and Marquardt's method."""
    # scipy.optimize finds the same minima, but its import would delay each start of the node by a quarter.
    residuals = model.residuals(state)
    cost, damping = float(residuals @ residuals), 1e-2
    for _ in range(_STEPS):
        jacobian = model.jacobian(state)
        normal, slope = jacobian.T @ jacobian, jacobian.T @ residuals
        for _ in range(8):
            damped = normal + damping * np.diag(np.diag(normal) + 1e-9)
            # Steps are bounded: an exponential far off would overflow.
            step = np.clip(np.linalg.solve(damped, -slope), -1.5, 1.5)
            new_residuals = model.residuals(state + step)
            new_cost = float(new_residuals @ new_residuals)
            if new_cost < cost:
                break
            damping *= 5
        else:
            return state
        gain, state, residuals, cost = cost - new_cost, state + step, new_residuals, new_cost
        damping = max(damping / 5, 1e-6)
        if gain < 1e-3 * cost:
            break
    return state
