# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Reference implementation of `acts_recon.fusion.fusion_kernels`: NumPy, in double precision."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from acts_core.array import COUNT_MAX
from acts_recon.fusion.fusion_image_kernels import (
    IDLE_COUNTS_PER_S,
    LEAST_CHANGE_COUNTS,
    MOST_CONFIRMED,
    STEEP_COUNTS,
    TRUST_PRIOR,
    UNPROVEN_S,
    UNPROVEN_WEIGHT,
)
from acts_recon.fusion.fusion_kernels import (
    LEAST_MOTION_S,
    LONGEST_AGE_S,
    NEW_CONTACT_AGE_S,
    NIS_PRIOR_SAMPLES,
    NOISE_LIMIT,
    NOISE_MARGIN,
    NOISE_MEAN,
    NOISE_MEMORY_S,
    NOISE_OUTLIER,
    NOISE_STEP,
    NOISE_STEP_LIMIT,
    OUTLIER,
    PROCESS_NOISE_GAIN,
    REACH,
    SCALE_LIMIT,
    SCALE_STEP,
    SHORTEST_AGE_S,
    SHORTEST_S,
    SPREAD_PRIOR,
    TRUST_MEMORY_S,
    UNMEASURED_MEMORY_S,
    ZERO_MARGIN,
)
from acts_recon.fusion.fusion_motion_kernels import AROUND, RIDGE
from acts_recon.fusion.fusion_state import (
    CLIPPED_CHANGE,
    PRIOR_SAMPLES,
    QUIET_SIGMAS,
    TILE,
    UNKNOWN_COUNTS,
    Tuning,
)
from acts_recon.images import LEAST_NOISE_COUNTS

Floats = NDArray[np.float64]


class FusionReference:
    """What is known of every taxel, as `acts_recon.fusion.fusion_state.State`; arrays are (rows, cols).

    Parameters
    ----------
    rows, cols : int
    tuning : Tuning
    noise : np.ndarray [shape=(rows, cols)] or float
        Standard deviation of a reading [counts].
    is_known : bool, optional
        Whether that is known, not assumed.
    """

    def __init__(self, rows: int, cols: int, tuning: Tuning, noise: Floats | float, *, is_known: bool = False) -> None:
        shape = (rows, cols)
        tiles = (-(-rows // TILE), -(-cols // TILE))
        self._tuning = tuning
        self._is_known = is_known
        self._tile_of = np.ix_(np.arange(rows) // TILE, np.arange(cols) // TILE)
        self.noise = np.maximum(np.broadcast_to(np.asarray(noise, dtype=np.float64), shape), LEAST_NOISE_COUNTS)
        taxels = self._by_tile(np.ones(shape))
        variance = self._by_tile(self.noise**2) / taxels
        self.readings = PRIOR_SAMPLES * 0.5 * variance
        self.changes = PRIOR_SAMPLES * CLIPPED_CHANGE * variance
        self.expected = PRIOR_SAMPLES * variance
        self.low_total, self.low_number = np.zeros(tiles), np.zeros(tiles)
        self.quiet_sigmas = np.full(tiles, QUIET_SIGMAS)
        self.is_noise = np.ones(tiles, dtype=bool)
        self.log_noise = 0.0
        self.forget()

    def forget(self) -> None:
        """Start anew, but keep what was learnt of the noise."""
        shape, tiles = self.noise.shape, self.readings.shape
        self.tile_product, self.tile_square = np.zeros(tiles), np.zeros(tiles)
        self.product, self.square, self.slope_square = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        self.low = np.zeros(shape, dtype=bool)
        self.image = np.zeros(shape)
        self.estimate = np.zeros(shape)
        self.sigma = np.full(shape, UNKNOWN_COUNTS)
        self.value = np.zeros(shape)
        self.slope = np.zeros(shape)
        self.age = np.full(shape, np.inf)
        self.process_noise = np.zeros(shape)
        self.around = np.zeros(shape)
        self.fresh = np.zeros(shape, dtype=bool)
        self.normal_sums = np.zeros((6, *tiles))
        self.log_scale = 0.0
        self.frame_scale = 1.0

    def step(
        self, indices: NDArray[np.integer], counts: NDArray[np.integer], period_s: float, duration_s: float
    ) -> None:
        """One frame that fits the array; parameters as of `acts_recon.fusion.fusion_kernels.fuse`."""
        self.update(indices, counts, lags(indices.size, duration_s), period_s)

    def update(self, indices: NDArray[np.integer], counts: NDArray[np.integer], lag: Floats, period_s: float) -> None:
        """One frame of samples, perhaps none, each measured `lag` seconds before the frame's end."""
        at = np.unravel_index(indices.astype(np.intp), self.image.shape)
        y = counts.astype(np.float64)

        self._observe_motion(at, y, self.age[at] + period_s - lag, period_s)
        rate, unexplained = self._predict(period_s)
        since = self.age[at] - lag
        innovation = self._learn(at, y, lag, rate, unexplained, period_s)
        self._update(at, y, lag, rate, innovation, unexplained)
        self._spread(at, y, innovation, since, period_s)
        self._show(rate, unexplained)
        self._update_sigma()

    def round_to_single(self) -> None:
        """Round the state to float32, in which the kernels keep it."""
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray) and value.dtype == np.float64:
                setattr(self, name, value.astype(np.float32).astype(np.float64))

    def field(self, name: str) -> Floats:
        """One of the arrays, by its name."""
        field: Floats = getattr(self, name)
        return field

    def _by_tile(self, values: Floats) -> Floats:
        """Sums over the taxels of each tile."""
        rows, cols = values.shape
        across = np.add.reduceat(values, np.arange(0, rows, TILE), axis=0)
        return np.asarray(np.add.reduceat(across, np.arange(0, cols, TILE), axis=1), dtype=np.float64)

    def _observe_motion(self, at: tuple[NDArray[np.intp], ...], y: Floats, since: Floats, period_s: float) -> None:
        self.normal_sums *= np.exp(-period_s / self._tuning.motion_memory_s)
        used = (since > 0) & (since < self._tuning.horizon_s)
        row, col = at[0][used], at[1][used]
        change = (y[used] - self.value[row, col]) / since[used]
        padded = np.pad(self.estimate, 1, mode="edge")
        along_cols = (padded[row + 1, col + 2] - padded[row + 1, col]) / 2
        along_rows = (padded[row + 2, col + 1] - padded[row, col + 1]) / 2
        terms = (
            along_cols * along_cols,
            along_cols * along_rows,
            along_rows * along_rows,
            -along_cols * change,
            -along_rows * change,
            change * change,
        )
        for q, term in enumerate(terms):
            np.add.at(self.normal_sums[q], (row // TILE, col // TILE), term)

    def _velocities(self) -> tuple[Floats, Floats, Floats]:
        """Columns and rows per second and the share explained, of every taxel."""
        side = np.ones((2 * AROUND + 1,) * 2)
        cc, cr, rr, ct, rt, tt = (ndimage.convolve(term, side, mode="constant") for term in self.normal_sums)
        cc, rr = cc + RIDGE, rr + RIDGE
        determinant = cc * rr - cr * cr
        by_cols = (rr * ct - cr * rt) / determinant
        by_rows = (cc * rt - cr * ct) / determinant
        share = np.divide(by_cols * ct + by_rows * rt, tt, out=np.zeros_like(tt), where=tt > 0)
        share = np.where(share > self._tuning.motion_share, np.minimum(share, 1), 0)
        return by_cols[self._tile_of], by_rows[self._tile_of], share[self._tile_of]

    def _predict(self, period_s: float) -> tuple[Floats, Floats]:
        """Rate of change of every taxel, and the share of it that is not motion."""
        tuning = self._tuning
        by_cols, by_rows, share = self._velocities()
        self.age += period_s
        elapsed = np.minimum(np.where(self.fresh, self.age, period_s), tuning.horizon_s)
        self.fresh[:] = False
        row, col = np.indices(self.estimate.shape)
        places = np.array([row - by_rows * elapsed, col - by_cols * elapsed])
        moved = ndimage.map_coordinates(self.estimate, places, order=1, mode="nearest")
        moved = np.where(elapsed > LEAST_MOTION_S, moved, self.estimate)
        slope = np.where(
            (self.age < tuning.horizon_s) & ~self.low, self.slope * np.exp(-self.age / tuning.damping_s), 0
        )
        change = share * (moved - self.estimate) + (1 - share) * slope * elapsed
        self.estimate = np.clip(self.estimate + change, 0, COUNT_MAX)
        rate: Floats = np.zeros_like(change)
        np.divide(change, elapsed, out=rate, where=elapsed > 0)
        return rate, 1 - share

    def _learn(
        self,
        at: tuple[NDArray[np.intp], ...],
        y: Floats,
        lag: Floats,
        rate: Floats,
        unexplained: Floats,
        period_s: float,
    ) -> Floats:
        """Innovations; what they say of the predictions and of the noise."""
        tile = (at[0] // TILE, at[1] // TILE)
        value, noise, since = self.value[at], self.noise[at], self.age[at] - lag
        predicted, change = self.estimate[at] - rate[at] * lag - value, y - value
        known = (since > 0) & (since < self._tuning.horizon_s)
        taxel_trust, tile_trust = self._trust()
        innovation = change - np.where(known, taxel_trust[at], tile_trust[tile]) * predicted

        stale = since >= self._tuning.horizon_s
        fade = np.where(stale, 0, np.exp(-np.where(known, since, 0) / TRUST_MEMORY_S))
        self.product[at] = fade * self.product[at] + np.where(known, predicted * change, 0)
        self.square[at] = fade * self.square[at] + np.where(known, predicted**2, 0)
        slope = self.slope[at] * np.exp(-np.where(known, self.age[at], 0) / self._tuning.damping_s)
        by_slope = unexplained[at] * slope * np.where(known, since, 0)
        self.slope_square[at] = fade * self.slope_square[at] + by_slope**2
        scale = np.exp(self.log_noise)
        used = known & (value > 0)
        ratio = np.minimum(innovation[used] ** 2 / (2 * noise[used] ** 2 * scale), NOISE_OUTLIER)
        step = np.clip(NOISE_STEP * (ratio - NOISE_MEAN).sum(), -NOISE_STEP_LIMIT, NOISE_STEP_LIMIT)
        self.log_noise = float(np.clip(self.log_noise + step, -NOISE_LIMIT, NOISE_LIMIT))

        low = (since > 0) & self.low[at] & (y <= 2 * noise * self.quiet_sigmas[tile])
        for sums, terms, where in (
            (self.tile_product, predicted * change, stale),
            (self.tile_square, predicted**2, stale),
            (self.readings, y**2, low),
            (self.changes, change**2, low),
            (self.expected, noise**2, low),
            (self.low_total, y, low),
            (self.low_number, np.ones_like(y), low),
        ):
            np.add.at(sums, tile, np.where(where, terms, 0))
            sums *= np.exp(-period_s / NOISE_MEMORY_S)
        known_noise = self.expected > 1e-20
        ratio = np.divide(
            self.changes, CLIPPED_CHANGE * self.expected, out=np.zeros_like(self.changes), where=known_noise
        )
        self.quiet_sigmas = np.where(known_noise, QUIET_SIGMAS * np.sqrt(ratio), self.quiet_sigmas)
        self.is_noise = self.readings < ZERO_MARGIN * self.changes
        self.is_noise &= self.changes < NOISE_MARGIN * scale * self.expected
        return innovation

    def _trust(self) -> tuple[Floats, Floats]:
        """Shares of what was predicted that came true: of every taxel lately, and of every tile."""

        return _share(self.product, self.square), _share(self.tile_product, self.tile_square)

    def _trust_slope(self, change: Floats, time: Floats, square: Floats) -> Floats:
        """Trust of every taxel by predictions of this square: as if this change, too, had come true as expected."""
        came_true = np.minimum((self.product + TRUST_PRIOR) / (self.square + TRUST_PRIOR), MOST_CONFIRMED)
        weight = UNPROVEN_WEIGHT * change**2
        expected = weight / (1 + (time / UNPROVEN_S) ** 2)
        return _share(square * came_true + expected, square + weight)

    def _update(
        self,
        at: tuple[NDArray[np.intp], ...],
        y: Floats,
        lag: Floats,
        rate: Floats,
        innovation: Floats,
        unexplained: Floats,
    ) -> None:
        tuning = self._tuning
        noise_variance = self.noise[at] ** 2
        since = self.age[at] - lag
        known = (since > 0) & (since < tuning.horizon_s)
        faded = np.exp(-np.where(self.age[at] < tuning.horizon_s, self.age[at], np.inf) / tuning.damping_s)
        slope_before = self.slope[at] * faded

        process_noise = (self.process_noise[at] + self.around[at]) / 2
        predicted_variance = np.where(known, process_noise * np.where(known, since, 0) ** 2, 0)
        moving = (predicted_variance > noise_variance) & (y > QUIET_SIGMAS * self.noise[at])
        ratio = innovation[moving] ** 2 / (
            2 * noise_variance[moving] + np.exp(self.log_scale) * predicted_variance[moving]
        )
        nis_excess = float((np.minimum(ratio, OUTLIER) - 1).sum())
        self.frame_scale = max(1 + nis_excess / (np.count_nonzero(moving) + NIS_PRIOR_SAMPLES), 1.0)
        self.log_scale = float(np.clip(self.log_scale + SCALE_STEP * nis_excess, -SCALE_LIMIT, SCALE_LIMIT))

        time = np.where(known, since, 1.0)
        share = time**2 / (time**2 + tuning.slope_memory_s**2)
        slope = self.slope[at] + share * ((y - self.value[at]) / time - self.slope[at])
        self.slope[at] = np.where(known, slope, np.where(since < tuning.horizon_s, self.slope[at], 0))
        stale = since >= tuning.horizon_s
        over = np.where(stale, NEW_CONTACT_AGE_S, np.maximum(since, 0)) + SHORTEST_S
        excess = np.maximum(innovation**2 - 2 * noise_variance, 0) / over**2
        is_new_contact = stale & (excess > self.process_noise[at])
        share = np.where(is_new_contact, 1, np.where(since > 0, PROCESS_NOISE_GAIN, 0))
        self.process_noise[at] += share * (excess - self.process_noise[at])
        self.value[at], self.age[at], self.fresh[at] = y, lag, True
        rate[at] += unexplained[at] * (self.slope[at] * np.exp(-lag / tuning.damping_s) - slope_before)

    def _spread(
        self, at: tuple[NDArray[np.intp], ...], y: Floats, innovation: Floats, since: Floats, period_s: float
    ) -> None:
        tuning = self._tuning
        step_rows, step_cols = np.indices((2 * REACH + 1,) * 2) - REACH
        square = (step_rows**2 + step_cols**2).astype(np.float64)
        near = np.divide(1, square**2.5, out=np.zeros_like(square), where=square > 0)

        def reached(values: Floats | float) -> Floats:
            field = np.zeros(self.image.shape)
            field[at] = values
            return ndimage.convolve(field, near, mode="constant")

        weight = reached(1.0)
        total, least = np.zeros(self.image.shape), np.full(self.image.shape, COUNT_MAX, dtype=np.float64)
        age = np.clip(self.age, 0, LONGEST_AGE_S)
        limited = np.clip(since, SHORTEST_AGE_S, LONGEST_AGE_S)
        for row, col, count, change, over in zip(*at, y, innovation, limited, strict=True):
            around = (slice(max(row - REACH, 0), row + REACH + 1), slice(max(col - REACH, 0), col + REACH + 1))
            least[around] = np.minimum(least[around], count)
            if abs(change) > QUIET_SIGMAS * self.noise[row, col]:
                weights = near[around[0].start - row + REACH :, around[1].start - col + REACH :]
                missed = np.minimum(age[around] / over, 1)
                total[around] += weights[: missed.shape[0], : missed.shape[1]] * change * missed
        process_noise_total = reached(self.process_noise[at])
        to = ~self.fresh & (weight > 1e-9)
        shrunk = weight[to] + SPREAD_PRIOR
        self.estimate[to] = np.clip(self.estimate[to] + tuning.spread_gain * total[to] / shrunk, 0, COUNT_MAX)
        fade = 1 - np.exp(-period_s / UNMEASURED_MEMORY_S)
        fading = np.where(self.age[to] > LONGEST_AGE_S, fade * weight[to] / shrunk, 0)
        self.estimate[to] -= fading * np.maximum(self.estimate[to] - least[to], 0)
        self.process_noise[to] += (
            PROCESS_NOISE_GAIN * weight[to] / shrunk * (process_noise_total[to] / weight[to] - self.process_noise[to])
        )
        self.estimate[at] = self.value[at]

    def _show(self, rate: Floats, unexplained: Floats) -> None:
        tuning = self._tuning
        quiet = self.noise * self.quiet_sigmas[self._tile_of]
        above = np.where(self.value <= quiet, 0.0, 1.0)
        self.low = ndimage.maximum_filter(above, size=3, mode="nearest") == 0
        time = np.minimum(self.age, tuning.horizon_s)
        by_slope = unexplained * self.slope * np.exp(-self.age / tuning.damping_s) * time
        _, tile_trust = self._trust()
        # Where motion explains nothing, all of the slope.
        all_slope = self.slope * np.exp(-self.age / tuning.damping_s) * time
        slope_trust = self._trust_slope(all_slope, time, self.slope_square)
        stale = (self.slope != 0) & (self.age >= tuning.horizon_s)
        self.slope[stale] = 0
        stale &= unexplained == 1
        self.estimate[stale] = (self.value + slope_trust * (self.estimate - self.value))[stale]
        of_fresh = np.where(self.low, 0, rate * np.where(self.fresh, self.age, 0))
        ahead = np.where(self.fresh, of_fresh, self.estimate - self.value)
        rest_trust = self._trust_slope(np.where(self.fresh, by_slope, 0), time, self.square)
        by_slope = np.clip(by_slope, np.minimum(ahead, 0), np.maximum(ahead, 0))
        trusted = rest_trust * (ahead - by_slope) + self._trust_slope(by_slope, time, self.slope_square) * by_slope
        change = np.where(self.age < tuning.horizon_s, trusted, tile_trust[self._tile_of] * ahead)
        is_change = (np.abs(ahead) >= LEAST_CHANGE_COUNTS) & (np.abs(change) >= LEAST_CHANGE_COUNTS)
        most = self.value[self.age < tuning.horizon_s].max(initial=STEEP_COUNTS)
        self.image = np.clip(self.value + np.where(is_change, change, 0), 0, np.maximum(self.value, most))
        self.image = np.floor(self.image + 0.5)
        is_settled = (self.image <= quiet) | (self.age < tuning.quiet_s)
        resting: Floats = np.zeros_like(self.low_total)
        if not self._is_known:
            np.divide(self.low_total, self.low_number, out=resting, where=self.low_number > 1e-20)
        is_noise = self.low & ~self.fresh & self.is_noise[self._tile_of] & is_settled
        self.image = np.where(is_noise, resting[self._tile_of], self.image)

    def _update_sigma(self) -> None:
        tuning = self._tuning
        time = np.minimum(self.age, tuning.horizon_s)
        self.around = ndimage.maximum_filter(self.process_noise, size=3, mode="nearest")
        process_noise = (self.process_noise + self.around) / 2
        variance = self.noise**2 + self.frame_scale * np.exp(self.log_scale) * process_noise * time**2
        variance += (IDLE_COUNTS_PER_S * np.minimum(self.age, 1e3)) ** 2
        self.sigma = np.minimum(np.sqrt(variance), UNKNOWN_COUNTS)


def _share(product: Floats, square: Floats) -> Floats:
    return np.clip((product + TRUST_PRIOR) / (square + TRUST_PRIOR), 0, 1)


def lags(m: int, duration_s: float) -> Floats:
    """How long before the end of a frame each of its m samples was measured [s]."""
    return np.arange(m - 1, -1, -1, dtype=np.float64) * (duration_s / m)
