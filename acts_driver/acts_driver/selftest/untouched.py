# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The skin untouched: noise, baseline, taxels that read high."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.words import counted
from acts_driver.selftest.findings import Finding, Level, Thresholds, taxels_listed
from acts_driver.selftest.record import FrameRecord

_TOP_CUT = 0.02


@dataclass(frozen=True, eq=False)
class Untouched:
    """What each taxel reads untouched.

    Attributes
    ----------
    readings : np.ndarray [shape=(rows, cols), dtype=int64]
        How often it was measured.
    baseline_counts : np.ndarray [shape=(rows, cols), dtype=float64]
        Median reading; NaN where it was never measured.
    noise_counts : np.ndarray [shape=(rows, cols), dtype=float64]
        Standard deviation about it, robust; NaN likewise.
    """

    readings: NDArray[np.int64]
    baseline_counts: NDArray[np.float64]
    noise_counts: NDArray[np.float64]


def noise_of(counts: NDArray[np.float64]) -> float:
    """Standard deviation of readings, robust against single spikes and against clipping at 0 or full scale.

    The root mean square distance from the median, of the half of the readings above it or of that below: the larger
    one, since clipping makes one of them small. The farthest 2 % are left out.

    Parameters
    ----------
    counts : np.ndarray [shape=(n,), dtype=float64]
        Of one taxel.

    Returns
    -------
    float
        [counts]; 0 for fewer than two readings.
    """
    ordered = np.sort(counts)
    half = len(ordered) // 2
    if half == 0:
        return 0.0
    cut = int(len(ordered) * _TOP_CUT)
    distance = ordered - np.median(ordered)
    lower, upper = distance[cut : half or None], distance[len(ordered) - half : len(ordered) - cut]
    return float(max(np.sqrt(np.mean(side**2)) if len(side) else 0.0 for side in (lower, upper)))


def measure_untouched(record: FrameRecord) -> Untouched:
    """Baseline and noise of every taxel from frames of the untouched skin."""
    start, counts = record.readings()
    size = record.rows * record.cols
    baseline, noise = np.full(size, np.nan), np.full(size, np.nan)
    for taxel in range(size):
        own = counts[start[taxel] : start[taxel + 1]]
        if len(own):
            baseline[taxel], noise[taxel] = np.median(own), noise_of(own)
    shape = (record.rows, record.cols)
    return Untouched(np.diff(start).reshape(shape), baseline.reshape(shape), noise.reshape(shape))


def judge_untouched(skin: Untouched, thresholds: Thresholds) -> list[Finding]:
    """What of this is a fault, but for taxels that read high: whether those are stuck, touching them tells."""
    return [*_judge_coverage(skin), _judge_noise(skin, thresholds), _judge_baseline(skin)]


def _judge_coverage(skin: Untouched) -> list[Finding]:
    """A warning of taxels that were never measured; nothing where there are none."""
    unseen = _where(skin.readings == 0)
    if not unseen:
        return []
    return [
        Finding(
            Level.WARN,
            "measured",
            f"{len(unseen)} of {skin.readings.size} taxels were never measured",
            "let the board sample raster, or uniform or random for longer",
        )
    ]


def _judge_noise(skin: Untouched, thresholds: Thresholds) -> Finding:
    noise = skin.noise_counts
    typical = float(np.nanmedian(noise)) if not np.isnan(noise).all() else 0.0
    is_noisier = "taxel is noisier than", "taxels are noisier than"
    loud = _where(noise > thresholds.noise_fail_counts)
    if loud:
        return Finding(
            Level.FAIL,
            "noise",
            f"{counted(len(loud), *is_noisier)} {thresholds.noise_fail_counts:g} counts: {taxels_listed(loud)}",
            "a loose contact, or something that moved on the skin: repeat it untouched, check the connector",
            taxels=loud,
        )
    uneasy = _where(noise > max(thresholds.noise_ratio * typical, thresholds.noise_warn_counts))
    if uneasy:
        return Finding(
            Level.WARN,
            "noise",
            f"{counted(len(uneasy), *is_noisier)} the others ({typical:.1f} counts): {taxels_listed(uneasy)}",
            "repeat it untouched; look for a loose contact where it comes again",
            taxels=uneasy,
        )
    return Finding(Level.PASS, "noise", f"{typical:.1f} counts (median), at most {np.nanmax(noise):.1f}")


def _judge_baseline(skin: Untouched) -> Finding:
    baseline = skin.baseline_counts
    return Finding(
        Level.PASS,
        "baseline",
        f"{np.nanmedian(baseline):.0f} counts (median), {np.nanmin(baseline):.0f} to {np.nanmax(baseline):.0f}",
    )


def high_taxels(skin: Untouched, thresholds: Thresholds) -> tuple[tuple[int, int], ...]:
    """Taxels that read as if they were pressed."""
    return _where(skin.baseline_counts > thresholds.high_counts)


def judge_high(skin: Untouched, thresholds: Thresholds) -> Finding:
    """What can be said of them without touching the skin."""
    high = high_taxels(skin, thresholds)
    if not high:
        return Finding(Level.PASS, "high taxels", f"none above {thresholds.high_counts:g} counts untouched")
    readings = {round(float(skin.baseline_counts[taxel])) for taxel in high}
    span = f"{min(readings)}" if len(readings) == 1 else f"{min(readings)} to {max(readings)}"
    at_end = " (full scale)" if min(readings) >= COUNT_MAX else ""
    return Finding(
        Level.FAIL,
        "high taxels",
        f"{counted(len(high), 'taxel reads', 'taxels read')} {span} counts untouched{at_end}: {taxels_listed(high)}",
        "take away what lies on the skin; otherwise these taxels are stuck: touch them to know",
        taxels=high,
    )


def _where(mask: NDArray[np.bool_]) -> tuple[tuple[int, int], ...]:
    return tuple((int(row), int(col)) for row, col in np.argwhere(mask))
