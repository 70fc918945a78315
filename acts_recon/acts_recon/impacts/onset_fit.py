# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When a touch began: some time before a taxel was pressed enough to be told from an untouched one.

**A slow touch.** A hand that comes at 0.1 m/s has touched for 3 to 8 ms until a taxel reads 25 counts. So the readings
of the taxel that is pressed most are followed back to 0. What touches is taken to be round where it first touches, and
to press with a pressure that goes with depth, as foam does. With R the radius of curvature, d(t) the depth, and a taxel
that takes the mean over a Gaussian of standard deviation s (its own square and the spread of the foam), the force is

    force(t) = c (u - 1 + exp(-u))        u = R d(t) / s^2

It begins with the square of the depth, while the contact is smaller than what a taxel sees, and goes on in proportion.
How large R d is tells the area of the contact. The speed fades in one of two ways: of a hand that comes to rest from
the first moment on, of one that springs back, as in a tap, late::

    d(t) = v T (1 - exp(-(t - t0) / T))        d(t) = v T sin(min((t - t0) / T, pi / 2))

Both are tried; t0 and T are looked for on a grid, and the mean over all that is likely is told.

**An impact.** The depth of what bounces is about half a sine wave, and by Hertz's law its force goes with the depth to
the power 3/2. So the first force F1 at t1 and the largest Fp at tp tell which share of the rise had passed::

    (t1 - t0) / (tp - t0) = (2 / pi) asin((F1 / Fp)^(2/3))
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_recon.impacts.footprint_fit import FORCE_SD, Footprint

Array = NDArray[np.float64]

_LEAST_SAMPLES = 4
_MISFIT = 0.04  # of the force: sensitivities do not matter, but shapes and motions do
_EARLIEST_S, _STEP_S = 0.016, 0.0002
_SLOWING_S = np.array([0.006, 0.010, 0.015, 0.022, 0.033, 0.050, 0.100, 1.0])
_HERTZ_POWER = 1.5
# What an onset errs by beyond what the readings say, as a share of how far it is followed back.
_SHARE_SD = 0.15


@dataclass(frozen=True)
class Rise:
    """The rise of a touch.

    Attributes
    ----------
    time_s, force_n, noise_n : np.ndarray [shape=(n,), dtype=float64]
        When the taxel that is pressed most was measured pressed, the force on it, and the standard deviation of that,
        until it is about largest.
    free_s : np.ndarray [shape=(k,), dtype=float64]
        When it was measured before, and no more than noise.
    free_n : float
        The largest force that can be noise.
    area_m2 : float
        Of the contact at the end of that time: where the force is at least half of the largest.
    blur_m2 : float
        s^2.
    """

    time_s: Array
    force_n: Array
    noise_n: Array
    free_s: Array
    free_n: float
    area_m2: float
    blur_m2: float


@dataclass(frozen=True)
class FollowedBack:
    """When the force of an impact was 0.

    Attributes
    ----------
    zero_s, zero_sd_s : float
        And the standard deviation [s].
    wait_s : float
        For how long a taxel may be touched until it is pressed enough to be told from an untouched one [s].
    """

    zero_s: float
    zero_sd_s: float
    wait_s: float


def follow_back(rise: Rise) -> tuple[float, float] | None:
    """When a touch began, and the standard deviation [s]; None where there are too few samples to tell."""
    time_s, force_n = rise.time_s, rise.force_n
    if force_n.size < _LEAST_SAMPLES:
        return None
    # The mean over a Gaussian is half of its top where r^2 is 2 ln 2 s^2; a paraboloid is at R d.
    curved_m2 = max(rise.area_m2 / math.pi - 2 * math.log(2) * rise.blur_m2, 0.3 * rise.blur_m2)
    first_s, last_s = float(time_s[0]), float(time_s[-1])
    onset_s = np.arange(first_s - _EARLIEST_S, first_s, _STEP_S)[:, None]

    def shape(at_s: Array) -> Array:
        """Of the force, by onset, way of slowing and time."""
        depth, whole = _depths(at_s - onset_s[..., None]), _depths(last_s - onset_s[..., None])
        u = (curved_m2 / rise.blur_m2) * depth / whole
        return u + np.expm1(-u)

    weight = 1.0 / np.hypot(rise.noise_n, _MISFIT * force_n)
    model = shape(time_s) * weight
    size = (model @ (force_n * weight)) / np.maximum((model**2).sum(-1), 1e-30)
    squares = ((model * size[..., None] - force_n * weight) ** 2).sum(-1)
    too_much = np.maximum(shape(rise.free_s) * size[..., None] - rise.free_n, 0.0) / rise.noise_n[0]
    squares += (too_much**2).sum(-1)
    likely = np.exp(-0.5 * (squares - squares.min()))
    likely /= likely.sum()
    mean_s = float((likely * onset_s).sum())
    sd_s = math.sqrt(float((likely * (onset_s - mean_s) ** 2).sum()))
    return mean_s, math.hypot(sd_s, _SHARE_SD * (first_s - mean_s), _STEP_S)


def follow_back_impact(fitted: Footprint) -> FollowedBack | None:
    """When an impact began; None where its force was largest at first."""
    time_s, force_n = fitted.time_s, fitted.force_n
    top = int(force_n.argmax())
    peak_s, peak_n = _peak(time_s, force_n, top)
    share = float(force_n[0] / peak_n) ** (1.0 / _HERTZ_POWER)
    if share >= 1.0:
        return None
    rise_s = peak_s - float(time_s[0])
    passed = 2.0 / math.pi * math.asin(share)
    before_s = rise_s * passed / (1.0 - passed)
    # Of the two forces' ratio, as the samples tell it and as the footprint's shape may be wrong.
    log = fitted.log_covariance
    ratio_sd = math.hypot(math.sqrt(max(float(log[0, 0] + log[top, top] - 2.0 * log[0, top]), 0.0)), FORCE_SD)
    passed_sd = 2.0 / math.pi * share / math.sqrt(1.0 - share**2) / _HERTZ_POWER * ratio_sd
    # The largest force lies between two nodes.
    peak_sd_s = float(time_s[1] - time_s[0]) / math.sqrt(12)
    sd_s = math.hypot(
        passed_sd * rise_s / (1.0 - passed) ** 2, peak_sd_s * passed / (1.0 - passed), _SHARE_SD * before_s
    )
    # It takes no longer to a pressed taxel than from there to the largest force: else the first sample was a late one.
    return FollowedBack(float(time_s[0]) - before_s, sd_s, min(before_s, rise_s))


def _peak(time_s: Array, force_n: Array, top: int) -> tuple[float, float]:
    """When a force was largest, and how large [s, N]: of the parabola through the largest value and those beside it."""
    if not 0 < top < force_n.size - 1:
        return float(time_s[top]), float(force_n[top])
    before_n, top_n, after_n = force_n[top - 1 : top + 2].tolist()
    bend_n = before_n - 2.0 * top_n + after_n
    steps = 0.5 * (before_n - after_n) / bend_n if bend_n < 0 else 0.0
    return float(time_s[top] + steps * (time_s[1] - time_s[0])), top_n - 0.25 * (before_n - after_n) * steps


def _depths(since_s: Array) -> Array:
    """Depths at a speed of 1, in all ways of slowing.

    Parameters
    ----------
    since_s : np.ndarray [shape=(..., 1, n), dtype=float64]
        Since the first touch [s]; 0 before.

    Returns
    -------
    np.ndarray [shape=(..., 2 * slowing times, n), dtype=float64]
    """
    slowing_s = _SLOWING_S[:, None]
    share = np.maximum(since_s, 0.0) / slowing_s
    resting, springing = -np.expm1(-share), np.sin(np.minimum(share, math.pi / 2))
    return np.concatenate((slowing_s * resting, slowing_s * springing), axis=-2)
