# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""When a touch began: some time before a taxel was pressed enough to be told from an untouched one.

**A slow touch.** A hand that comes at 0.1 m/s has touched for 3 to 8 ms until a taxel reads 25 counts. So the readings
of the taxels around the middle of the contact are followed back to 0. What touches is taken to be round where it first
touches, and to press with a pressure that goes with depth, as foam does. With R the radius of curvature, d(t) the
depth, r how far from the middle a taxel lies, and s the standard deviation of the Gaussian over which it takes the mean
(its own square and the spread of the foam), the force on it is the mean of

    force(t) = c max(u - |z|^2 / 2, 0)        u = R d(t) / s^2

over a normal distribution of z about r / s. With L = r^2 / (2 s^2), |z|^2 / 2 is distributed as the sum of 1 + k
exponentials of mean 1, with k of Poisson's distribution of mean L. So in the middle the mean is c (u - 1 + exp(-u)): it
begins with the square of the depth, while the contact is smaller than what a taxel sees, and goes on in proportion. A
pitch away it begins some ms later. How large R d is tells the area of the contact. A body that is flat in its middle,
as a sole is, presses with c d(t) at once. The speed fades in one of two ways: of a hand that comes to rest from the
first moment on, of one that springs back, as in a tap, late::

    d(t) = v T (1 - exp(-(t - t0) / T))        d(t) = v T sin(min((t - t0) / T, pi / 2))

All are tried; t0 and T are looked for on a grid, and the mean over all that is likely is told. Each taxel has a c of
its own: its sensitivity, and how the pressure is spread, do not matter.

**An impact.** The depth of what bounces is about half a sine wave, and by Hertz's law its force goes with the depth to
the power 3/2. So a force F1 at t1 and the largest Fp at tp tell which share of the rise had passed::

    (t1 - t0) / (tp - t0) = (2 / pi) asin((F1 / Fp)^(2/3))

The first force of the fitted footprint and the second, a frame later, both tell it, and their weighted mean is taken.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_recon.impacts.footprint_fit import FORCE_SD, LEAST_NODES, Footprint

Array = NDArray[np.float64]

_LEAST_SAMPLES = 4
_MISFIT = 0.04  # of the force: sensitivities do not matter, but shapes and motions do
_EARLIEST_S, _ONSETS = 0.020, 48
_LEAST_SD_S = 0.0003
# How likely a flat body is, beside a round one.
_FLAT = 0.05
_SLOWING_S = np.array([0.006, 0.010, 0.015, 0.022, 0.033, 0.050, 0.100, 1.0])
_HERTZ_POWER = 1.5
# What an onset errs by beyond what the readings say, as a share of how far it is followed back.
_SLOW_SHARE_SD, _IMPACT_SHARE_SD = 0.05, 0.15
# Of the largest force: what a fitted footprint's force errs by where it is small. While few taxels are pressed, the
# footprint is smaller than it is later, and than the fit has it.
_SMALLEST_SD = 0.01
# Terms of Poisson's distribution: of taxels about a pitch from the middle its mean is 1 to 5.
_TERMS = 12


@dataclass(frozen=True)
class Rise:
    """The rise of a touch, as the taxels around its middle were measured.

    Attributes
    ----------
    time_s, force_n, noise_n : np.ndarray [shape=(n,), dtype=float64]
        When one of them was measured, the force on it, and the standard deviation of that; of each from before the
        touch until its force is about largest.
    is_pressed : np.ndarray [shape=(n,), dtype=bool]
        Whether it read more than noise.
    taxel : np.ndarray [shape=(n,), dtype=intp]
        Which of them, from 0.
    away_m2 : np.ndarray [shape=(taxels,), dtype=float64]
        Squared distance of each from the middle.
    felt_s : float
        When one of them was first pressed enough to be sure of it.
    unread_n, free_n : float
        The largest force that reads 0, and the largest that can be noise.
    area_m2 : float
        Of the contact at the end of that time: where the force is at least half of the largest.
    blur_m2 : float
        s^2.
    """

    time_s: Array
    force_n: Array
    noise_n: Array
    is_pressed: NDArray[np.bool_]
    taxel: NDArray[np.intp]
    away_m2: Array
    felt_s: float
    unread_n: float
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
    if rise.is_pressed.sum() < _LEAST_SAMPLES:
        return None
    # Nearer to each other where it is felt soon.
    back = (np.arange(_ONSETS) + 0.5) / _ONSETS
    onset_s = (rise.felt_s - _EARLIEST_S * back**2)[:, None]
    # Of each sample, by onset and way of slowing, of a round body and of a flat one.
    depth = _depths(time_s - onset_s[..., None]) / _depths(float(time_s.max()) - onset_s[..., None])
    shape = _mean_pressure(
        _curved(rise.area_m2 / rise.blur_m2) * depth, (rise.away_m2 / (2 * rise.blur_m2))[rise.taxel]
    )
    shape = np.concatenate((shape, depth), axis=-2)
    weight = 1.0 / np.hypot(rise.noise_n, _MISFIT * force_n)
    squares = np.zeros(shape.shape[:-1])
    for number in range(rise.away_m2.size):
        own = rise.taxel == number
        felt = own & rise.is_pressed
        model = shape[..., felt] * weight[felt]
        size = (model @ (force_n * weight)[felt]) / np.maximum((model**2).sum(-1), 1e-30)
        model_n = shape[..., own] * size[..., None]
        # A reading of noise contradicts no force that is less, and one above noise none that is not read.
        errors_n = np.where(
            rise.is_pressed[own],
            np.maximum(model_n, rise.unread_n) - force_n[own],
            np.maximum(model_n - rise.free_n, 0.0),
        )
        squares += ((errors_n * weight[own]) ** 2).sum(-1)
    # What is not as the model has it, all taxels share in part.
    squares /= math.sqrt(rise.away_m2.size)
    # All moments are as likely, but the onsets that are tried are further apart the earlier they are.
    before = back[:, None] * np.repeat((1.0, _FLAT), shape.shape[1] // 2)
    likely = np.exp(-0.5 * (squares - squares.min())) * before
    likely /= likely.sum()
    mean_s = float((likely * onset_s).sum())
    sd_s = math.sqrt(float((likely * (onset_s - mean_s) ** 2).sum()))
    return mean_s, math.hypot(sd_s, _SLOW_SHARE_SD * (rise.felt_s - mean_s), _LEAST_SD_S)


def _curved(area: float) -> float:
    """R d / s^2 of a contact of this area over s^2.

    The mean over a Gaussian is half of its top where r^2 is 2 ln 2 s^2 if the contact is small, and R d - s^2 if it is
    large; in between this is right to 0.1.
    """
    wider = max(area / math.pi - 2 * math.log(2), 0.1)
    return wider + (1 + 2 * math.log(2)) * wider / (wider + 2)


def _mean_pressure(u: Array, mean_terms: Array) -> Array:
    """The mean of max(u - |z|^2 / 2, 0) at these L.

    Parameters
    ----------
    u : np.ndarray [shape=(..., n), dtype=float64]
    mean_terms : np.ndarray [shape=(n,), dtype=float64]
        L of each.
    """
    k = np.arange(_TERMS)
    factorial = np.cumprod(np.maximum(k, 1))
    share = mean_terms[:, None] ** k / factorial
    share /= share.sum(1, keepdims=True)
    # The mean of max(u - w, 0), with w of 1 + k exponentials, is u - (k + 1) + exp(-u) sum_j (k + 1 - j) u^j / j!.
    terms = np.zeros_like(u)
    for j in k[::-1]:
        terms = terms * u + (share[:, j:] @ (k[j:] + 1.0 - j)) / factorial[j]
    return np.maximum(u - share @ (k + 1.0) + np.exp(-u) * terms, 0.0)


def follow_back_impact(fitted: Footprint) -> FollowedBack | None:
    """When an impact began; None where its force was largest at first."""
    time_s, force_n = fitted.time_s, fitted.force_n
    top = int(force_n.argmax())
    peak_s, peak_n = _peak(time_s, force_n, top)
    if force_n[0] >= peak_n:
        return None
    # The first force is nearest to the onset, but may be little more than what it errs by. The second is of the same
    # samples where there is not one to a frame.
    nodes = min(2, top) if time_s.size > LEAST_NODES else 1
    found = [_followed_from(fitted, node, top, peak_s, peak_n) for node in range(nodes)]
    # By the model's errors alone: those of the samples are nearly the same in both.
    weights = [model_sd_s**-2 for _, _, model_sd_s in found]
    total = sum(weights)
    zero_s = sum(weight * each_s for weight, (each_s, _, _) in zip(weights, found, strict=True)) / total
    zero_sd_s = math.hypot(*(weight * sd_s for weight, (_, sd_s, _) in zip(weights, found, strict=True))) / total
    # It takes no longer to a pressed taxel than from there to the largest force: else the first sample was a late one.
    first_s = float(time_s[0])
    return FollowedBack(zero_s, zero_sd_s, min(max(first_s - zero_s, 0.0), peak_s - first_s))


def _followed_from(fitted: Footprint, node: int, top: int, peak_s: float, peak_n: float) -> tuple[float, float, float]:
    """When the force was 0 by its value at this node, the standard deviation, and the model's part of that [s]."""
    at_s, share_n = float(fitted.time_s[node]), float(fitted.force_n[node]) / peak_n
    share = share_n ** (1.0 / _HERTZ_POWER)
    rise_s = peak_s - at_s
    passed = 2.0 / math.pi * math.asin(share)
    before_s = rise_s * passed / (1.0 - passed)
    # Of the two forces' ratio, as the footprint's shape may be wrong, and as the samples tell it.
    shape_sd = math.hypot(FORCE_SD, _SMALLEST_SD / share_n)
    log = fitted.log_covariance
    log_sd = math.sqrt(max(float(log[node, node] + log[top, top] - 2.0 * log[node, top]), 0.0))
    of_ratio_s = 2.0 / math.pi * share / math.sqrt(1.0 - share**2) / _HERTZ_POWER * rise_s / (1.0 - passed) ** 2
    # The largest force lies between two nodes.
    peak_sd_s = float(fitted.time_s[1] - fitted.time_s[0]) / math.sqrt(12)
    model_sd_s = math.hypot(of_ratio_s * shape_sd, peak_sd_s * passed / (1.0 - passed), _IMPACT_SHARE_SD * before_s)
    return at_s - before_s, math.hypot(model_sd_s, of_ratio_s * log_sd), model_sd_s


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
