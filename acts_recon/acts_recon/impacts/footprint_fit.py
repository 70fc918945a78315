# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How a footprint moves while it grows and shrinks, from single samples, each with its own time.

In a frame at 1 kHz the taxels of a bouncing ball are measured one after the other while its force changes by half, and
not all of them are measured. The centre of an image therefore errs by a good part of what the ball moves. So all
samples of the touch are explained at once, by a footprint that moves straight on (`footprint_model`): a round one, or
one that is longer than wide where that explains them far better. The standard deviations are those of errors that are
common to all samples of one taxel, such as its sensitivity (a "sandwich" of clusters), so they also hold where the
footprint is not quite that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_recon.impacts.footprint_model import VOLUME, Array, FootprintModel, minimise, spread_points

FORCE_SD = 0.2
"""Of a fitted footprint's force, as a share: the taxels' sensitivities, and how far it is from the model."""

LEAST_NODES = 5
"""Nodes of a fit to fewer frames than that: what is between frames is then only assumed to be smooth."""

_SPREAD = 0.05  # of the taxels' sensitivities
_MISFIT = 0.05  # how far a footprint is from the model, as a share of the largest force on a taxel
# What presses is long where a long footprint leaves less than this share of what a round one cannot explain, and this
# much less of it, as sums of squared residuals. Of balls it leaves 0.59 and more, of edges at least twice as long as
# wide mostly 0.1 to 0.5.
_LONG_SHARE, _LONG_GAIN = 0.55, 10.0
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
# Where a long footprint has so many times the force that such images show, or so many times less, it lies beside what
# presses: of edges their force is within 0.6 to 1.2 of the true one.
_LONG_APART = 1.3
# Less than a few measurements take. At the time of today nodes would fall together that are not a microsecond apart.
_LEAST_S = 2e-5
_MOST_NODES = 24


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
    width_m : np.ndarray [shape=(n,), dtype=float64]
        As `force_n`, see `footprint_model` [m].
    stretch : np.ndarray [shape=(2,), dtype=float64]
        p and q, see `footprint_model`; 0 of a round one.
    explains_samples : bool
        Whether it explains the samples, or these are so few of each taxel that images show little of what pressed.
    strong_samples : float
        How often a taxel was measured with a fifth of the largest force or more, in the mean of those that were.
    is_long : bool
        Whether it is longer than wide.
    """

    time_s: Array
    force_n: Array
    log_covariance: Array
    middle_s: float
    x_m: float
    y_m: float
    velocity_m_s: Array
    covariance: Array
    width_m: Array
    stretch: Array
    explains_samples: bool = True
    strong_samples: float = 1.0
    is_long: bool = False

    def is_better_than_images(self, own_n: float, peak_n: float, peak_sd_n: float) -> bool:
        """Whether it tells more of what pressed than images do.

        A footprint that passes beside an edge explains that in part, with any force and place.

        Parameters
        ----------
        own_n : float
            Its largest force on the patch, see `within` [N].
        peak_n, peak_sd_n : float
            That in the images, and its standard deviation [N].
        """
        if own_n <= 0:
            return False
        if not self.explains_samples or self.strong_samples < _OFTEN:
            return self.explains_samples
        if self.is_long:
            return peak_n / _LONG_APART <= own_n <= peak_n * _LONG_APART
        return own_n - peak_n <= _MOST_ABOVE_SD * peak_sd_n

    def within(self, x_m: tuple[float, float], y_m: tuple[float, float]) -> tuple[Array, Array, Array]:
        """What it presses of a patch: a body beyond the border presses nothing there.

        Parameters
        ----------
        x_m, y_m : (float, float)
            From where to where the patch reaches [m].

        Returns
        -------
        force_n, x_m, y_m : np.ndarray [shape=(n,), dtype=float64]
            Force on the patch, and its centre [N, m]; without force the place on the patch that is nearest.
        """
        dx, dy, weight = spread_points(self.stretch)
        since_s = (self.time_s - self.middle_s)[:, None]
        at_x = self.x_m + self.velocity_m_s[0] * since_s + self.width_m[:, None] * dx
        at_y = self.y_m + self.velocity_m_s[1] * since_s + self.width_m[:, None] * dy
        inside = (x_m[0] <= at_x) & (at_x <= x_m[1]) & (y_m[0] <= at_y) & (at_y <= y_m[1])
        share = np.where(inside, weight, 0.0)
        whole = share.sum(axis=1)
        is_felt = whole > 0
        centres = []
        for at, limits in ((at_x, x_m), (at_y, y_m)):
            felt = (share * at).sum(axis=1) / np.where(is_felt, whole, 1.0)
            centres.append(np.where(is_felt, felt, np.clip(at.mean(axis=1), *limits)))
        return self.force_n * whole, centres[0], centres[1]

    @property
    def direction_sd_rad(self) -> float:
        """Standard deviation of the velocity's direction [rad], inf without velocity."""
        square = float(self.velocity_m_s @ self.velocity_m_s)
        if square == 0.0:
            return float(np.inf)
        across = np.array([-self.velocity_m_s[1], self.velocity_m_s[0]]) / square
        return math.sqrt(max(float(across @ self.covariance @ across), 0.0))


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
    models = [
        FootprintModel(1e3 * time_s, 1e3 * x_m, 1e3 * y_m, force_n, sd_n, nodes, is_long=is_long)
        for is_long in (False, True)
    ]
    model, state = _better(*models)
    misfit = float(np.mean(model.residuals(state)[: taxel.size][pressed] ** 2))
    wider = float(np.exp((state - model.before)[model.widths].max()))
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
    top_n, width_mm = np.exp(state[model.amplitudes]), np.exp(state[model.widths])
    forces_n = VOLUME * top_n * width_mm**2 / (1e6 * taxel_area_m2)
    # Of the force, which goes with amplitude times the square of the width.
    each = np.eye(state.size)
    of_force = each[model.amplitudes] + 2.0 * each[model.widths]
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
        1e-3 * width_mm,
        model.stretch_of(state),
        wider <= _WIDEST and (misfit <= _MOST_MISFIT or measured_share < _MEASURED_SHARE),
        strong.size / np.unique(strong).size,
        model.is_long,
    )


def _better(of_round: FootprintModel, of_long: FootprintModel) -> tuple[FootprintModel, Array]:
    """The round or the long one, and the state by which it explains the samples best."""
    states = minimise(of_round, of_round.start()), minimise(of_long, of_long.start())
    round_squares = float(np.sum(of_round.residuals(states[0]) ** 2))
    long_squares = float(np.sum(of_long.residuals(states[1]) ** 2))
    if long_squares < _LONG_SHARE * round_squares and round_squares - long_squares > _LONG_GAIN:
        return of_long, states[1]
    return of_round, states[0]
