# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How a footprint moves while it grows and shrinks, from single samples, each with its own time.

In a frame at 1 kHz the taxels of a bouncing ball are measured one after the other while its force changes by half, and
not all of them are measured. The centre of an image therefore errs by a good part of what the ball moves. So all
samples of the touch are explained at once, by a footprint that moves straight on::

    force(t, r) = A(t) exp(-|(r - r0 - v t) / w(t)|^3 / 2)

With the third power it is flatter in the middle than a Gaussian, and has less force at its foot: so it is nearer to the
pressure under a ball, Hertz's half ellipsoid blurred by the foam. The logarithms of A and w are linear between nodes,
one a frame. Levenberg and Marquardt's method solves the least squares. The standard deviations are those of errors that
are common to all samples of one taxel, such as its sensitivity (a "sandwich" of clusters), so they also hold where the
footprint is not quite that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FORCE_SD = 0.2
"""Of a fitted footprint's force, as a share: the taxels' sensitivities, and how far it is from the model."""

LEAST_NODES = 5
"""Nodes of a fit to fewer frames than that: what is between frames is then only assumed to be smooth."""

_SPREAD = 0.05  # of the taxels' sensitivities
_MISFIT = 0.05  # how far a footprint is from the model, as a share of the largest force on a taxel
_STEPS = 30
# Exponent of the squared distance in the footprint, and the footprint's integral over the plane for A = w = 1.
_POWER = 1.5
_VOLUME = math.pi * 2.0 ** (1.0 / _POWER) * math.gamma(1.0 + 1.0 / _POWER)
_LEAST_TAXELS = 8
# What presses is not round where the pressed samples are farther from the fit than this, as the mean of squared
# residuals over their variances, or where the fit is so many times as wide as the samples are spread. Of balls it is
# 1.7 and 1.6 at most, also where sensitivities differ by twice as much; the first is mostly 2 to 5 of an edge.
_MOST_MISFIT, _WIDEST = 2.0, 2.0
# Where a pressed taxel is measured in this share of the frames or more, images hold what was measured. With `random`
# and `uniform` it is in a few only.
_MEASURED_SHARE = 0.3
# Nor is what presses round where taxels with a fifth of the largest force or more were measured so often each, and the
# fit has more force than the images show by so many of their standard deviations. Of balls few fits have, and there the
# images are nearer to the truth. Where taxels are measured less often, as with `random`, images show too little.
_STRONG_SHARE, _OFTEN, _MOST_ABOVE_SD = 0.2, 1.5, 5.0
# Less than a few measurements take. At the time of today nodes would fall together that are not a microsecond apart.
_LEAST_S = 2e-5
_MOST_NODES = 24
# How far amplitude and width go from node to node, as natural logarithms.
_AMPLITUDE_STEP, _WIDTH_STEP = 1.5, 0.4
# How far they are from the largest force and from the width of all samples together, likewise.
_AMPLITUDE_SD, _WIDTH_SD = 0.7, 0.15


@dataclass(frozen=True)
class Footprint:
    """How a footprint moved, grew and shrank.

    Attributes
    ----------
    time_s, force_n : np.ndarray [shape=(n,), dtype=float64]
        Its force, once a frame and at least five times, from the first pressed sample to the last [s, N].
    log_covariance : np.ndarray [shape=(n, n), dtype=float64]
        Of the natural logarithms of `force_n`.
    middle_s : float
        Mean time of the force [s].
    x_m, y_m : float
        Where its centre was then [m].
    velocity_m_s : np.ndarray [shape=(2,), dtype=float64]
        Along x and y.
    covariance : np.ndarray [shape=(2, 2), dtype=float64]
        Of the velocity [m^2/s^2].
    explains_samples : bool
        Whether it explains the samples, or these are so few of each taxel that images show little of what pressed.
    strong_samples : float
        How often a taxel was measured with a fifth of the largest force or more, in the mean of those that were.
    """

    time_s: Array
    force_n: Array
    log_covariance: Array
    middle_s: float
    x_m: float
    y_m: float
    velocity_m_s: Array
    covariance: Array
    explains_samples: bool = True
    strong_samples: float = 1.0

    def is_better_than_images(self, peak_n: float, peak_sd_n: float) -> bool:
        """Whether it tells more of what pressed than images do.

        A round footprint that passes beside an edge explains that in part, with any force and place.

        Parameters
        ----------
        peak_n, peak_sd_n : float
            The largest force in the images, and its standard deviation [N].
        """
        above_n = float(self.force_n.max()) - peak_n
        return self.explains_samples and (self.strong_samples < _OFTEN or above_n <= _MOST_ABOVE_SD * peak_sd_n)

    def path(self, time_s: Array) -> tuple[Array, Array]:
        """x and y of the centre at these times [m]; held before the first of its force and after the last."""
        since_s = np.clip(time_s, self.time_s[0], self.time_s[-1]) - self.middle_s
        return self.x_m + self.velocity_m_s[0] * since_s, self.y_m + self.velocity_m_s[1] * since_s

    @property
    def direction_sd_rad(self) -> float:
        """Standard deviation of the velocity's direction [rad], inf without velocity."""
        square = float(self.velocity_m_s @ self.velocity_m_s)
        if square == 0.0:
            return float(np.inf)
        across = np.array([-self.velocity_m_s[1], self.velocity_m_s[0]]) / square
        return math.sqrt(max(float(across @ self.covariance @ across), 0.0))


class _Model:
    """The footprint, its derivatives and what is measured; lengths in mm, times in ms."""

    def __init__(self, time_ms: Array, x_mm: Array, y_mm: Array, force_n: Array, sd_n: Array, nodes: int) -> None:
        self.x, self.y, self.force, self.sd = x_mm, y_mm, force_n, sd_n
        self.middle = float(force_n @ time_ms) / float(force_n.sum())
        self.since = time_ms - self.middle
        self.at = at = np.linspace(time_ms.min(), time_ms.max(), nodes)
        self.share = np.maximum(0.0, 1.0 - np.abs(time_ms[:, None] - at) / (at[1] - at[0]))
        self.nodes = nodes
        steps, ones, nothing = np.diff(np.eye(nodes), axis=0), np.eye(nodes), np.zeros((nodes, nodes))
        self.prior = np.vstack(
            (
                np.hstack((np.zeros((nodes - 1, 4)), steps / _AMPLITUDE_STEP, nothing[1:])),
                np.hstack((np.zeros((nodes - 1, 4)), nothing[1:], steps / _WIDTH_STEP)),
                np.hstack((np.zeros((nodes, 4)), ones / _AMPLITUDE_SD, nothing)),
                np.hstack((np.zeros((nodes, 4)), nothing, ones / _WIDTH_SD)),
            )
        )
        self.before = np.zeros(4 + 2 * nodes)

    def start(self, spread_mm: float) -> Array:
        total = float(self.force.sum())
        place = [float(self.force @ self.x) / total, float(self.force @ self.y) / total, 0.0, 0.0]
        log_top, log_width = np.log(float(self.force.max())), np.log(spread_mm)
        self.before = np.concatenate((place, np.full(self.nodes, log_top), np.full(self.nodes, log_width)))
        return self.before

    def residuals(self, state: Array) -> Array:
        return np.concatenate(((self._force(state)[0] - self.force) / self.sd, self.prior @ (state - self.before)))

    def jacobian(self, state: Array) -> Array:
        force, dx, dy, square, width = self._force(state)
        pull = _POWER * force * square ** (_POWER - 1.0) / width**2
        of_place = np.column_stack((pull * dx, pull * dy, pull * dx * self.since, pull * dy * self.since))
        of_shape = np.hstack((force[:, None] * self.share, (_POWER * force * square**_POWER)[:, None] * self.share))
        return np.vstack((np.hstack((of_place, of_shape)) / self.sd[:, None], self.prior))

    def _force(self, state: Array) -> tuple[Array, Array, Array, Array, Array]:
        top = np.exp(self.share @ state[4 : 4 + self.nodes])
        width = np.exp(self.share @ state[4 + self.nodes :])
        dx = self.x - state[0] - state[2] * self.since
        dy = self.y - state[1] - state[3] * self.since
        square = (dx * dx + dy * dy) / width**2
        return top * np.exp(-0.5 * square**_POWER), dx, dy, square, width


def fit_footprint(
    time_s: Array,
    x_m: Array,
    y_m: Array,
    force_n: Array,
    noise_n: Array,
    taxel: NDArray[np.intp],
    frames: int,
    taxel_area_m2: float,
) -> Footprint | None:
    """The footprint that explains the samples of one touch best.

    Parameters
    ----------
    time_s, x_m, y_m, force_n, noise_n : np.ndarray [shape=(n,), dtype=float64]
        When and where each sample was measured, the force on its taxel, and the standard deviation of that [s, m, N];
        of taxels under the footprint and around it.
    taxel : np.ndarray [shape=(n,), dtype=intp]
        Which taxel it was.
    frames : int
        In how many frames.
    taxel_area_m2 : float

    Returns
    -------
    Footprint or None
        None where there are too few samples to tell, or all are of one row or column.
    """
    if min(np.ptp(x_m), np.ptp(y_m)) <= 0:
        return None
    pressed = force_n > 0
    if np.unique(taxel[pressed]).size < _LEAST_TAXELS or np.ptp(time_s[pressed]) < _LEAST_S:
        return None
    sd_n = np.hypot(np.hypot(noise_n, _SPREAD * force_n), _MISFIT * float(force_n.max()))
    nodes = min(max(frames, LEAST_NODES), _MOST_NODES)
    model = _Model(1e3 * time_s, 1e3 * x_m, 1e3 * y_m, force_n, sd_n, nodes)
    total = float(force_n.sum())
    dx, dy = x_m - force_n @ x_m / total, y_m - force_n @ y_m / total
    state = model.start(1e3 * float(np.sqrt(force_n @ (dx * dx + dy * dy) / total)))
    state = _minimise(model, state)
    misfit = float(np.mean(model.residuals(state)[: taxel.size][pressed] ** 2))
    wider = float(np.exp((state - model.before)[4 + nodes :].max()))
    measured_share = float(np.count_nonzero(pressed)) / (frames * np.unique(taxel[pressed]).size)
    strong = taxel[force_n > _STRONG_SHARE * force_n.max()]
    jacobian = model.jacobian(state)
    clusters, cluster = np.unique(taxel, return_inverse=True)
    scores = np.zeros((clusters.size, state.size))
    np.add.at(scores, cluster, jacobian[: taxel.size] * model.residuals(state)[: taxel.size, None])
    inverse = np.linalg.pinv(jacobian.T @ jacobian)
    # As a square, no variance is below 0, also where the samples say next to nothing of some of the numbers.
    spread = inverse @ scores.T
    covariance = spread @ spread.T * clusters.size / max(clusters.size - state.size, 1)
    top_n, width_mm = np.exp(state[4 : 4 + nodes]), np.exp(state[4 + nodes :])
    forces_n = _VOLUME * top_n * width_mm**2 / (1e6 * taxel_area_m2)
    # Of the force, which goes with amplitude times the square of the width.
    of_force = np.hstack((np.zeros((nodes, 4)), np.eye(nodes), 2.0 * np.eye(nodes)))
    # mm/ms are m/s.
    centre_x_m, centre_y_m = (1e-3 * state[:2]).tolist()
    middle_s = 1e-3 * model.middle
    return Footprint(
        1e-3 * model.at,
        forces_n,
        of_force @ inverse @ of_force.T,
        middle_s,
        centre_x_m,
        centre_y_m,
        state[2:4].copy(),
        covariance[2:4, 2:4],
        wider <= _WIDEST and (misfit <= _MOST_MISFIT or measured_share < _MEASURED_SHARE),
        strong.size / np.unique(strong).size,
    )


def _minimise(model: _Model, state: Array) -> Array:
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
