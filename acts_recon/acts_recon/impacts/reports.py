# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is told of a touch: of one that has begun, of one that has joined another, and of one that is over."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from acts_recon.impacts.config import ImpactConfig
from acts_recon.impacts.footprint_fit import FORCE_SD, Footprint
from acts_recon.impacts.impact import UNKNOWN_DIRECTION_SD_RAD, Impact, Kind
from acts_recon.impacts.onset_fit import follow_back, follow_back_impact
from acts_recon.impacts.samples import RecentSamples
from acts_recon.impacts.touch import Force, Touch, impulse_of

Array = NDArray[np.float64]

_UNSURE_S = 0.001


class Reports:
    """Makes the reports of touches out of their frames and of the samples around them.

    Parameters
    ----------
    samples : RecentSamples
        Of all frames, for as long as an impact may last.
    config : ImpactConfig
    """

    def __init__(self, samples: RecentSamples, config: ImpactConfig) -> None:
        self._samples = samples
        self._config = config

    def so_far(self, touch: Touch, *, joined: int = 0, until_s: float | None = None) -> Impact:
        """What is known of a touch that has begun, or now becomes a part of another."""
        onset_s, onset_sd_s = touch.onset(self._untouched_before(touch))
        return Impact(
            number=touch.number,
            is_over=False,
            kind=Kind.UNKNOWN,
            joined=joined,
            onset_s=onset_s,
            onset_sd_s=onset_sd_s,
            duration_s=0.0 if until_s is None else max(float(until_s - onset_s), 0.0),
            frames=touch.frames_seen,
            x_m=touch.x_m,
            y_m=touch.y_m,
            peak_n=touch.peak_n,
            peak_sd_n=touch.peak_sd_n,
        )

    def over(
        self, touch: Touch, touches: Sequence[Touch], period_s: float, frame_s: float, *, stays: bool = False
    ) -> Impact:
        """What a touch was that is over, or an impact that stays on the skin.

        Parameters
        ----------
        touch : Touch
        touches : sequence of Touch
            All that have not ended before it, of which those that rest beside it are no part of it.
        period_s, frame_s : float
            From one frame to the next, and how long its measurements took [s].
        stays : bool, optional
            Whether it is an impact that stays.
        """
        is_short = stays or touch.last_s - touch.began_s <= self._config.impact_longest_s
        time_s, force_n, path_x_m, path_y_m = touch.path()
        found = self._footprint(touch, touches, time_s, force_n, path_x_m, path_y_m) if is_short else None
        x_m, y_m, peak_n, peak_sd_n = touch.peak_x_m, touch.peak_y_m, touch.peak_n, touch.peak_sd_n
        force: Force = time_s, force_n
        fitted: Footprint | None = None
        if found is not None:
            on_patch = found.within(*self._samples.reach_of(touch.patch))
            top = int(on_patch[0].argmax())
            own_n, own_x_m, own_y_m = (float(one[top]) for one in on_patch)
            if found.is_better_than_images(own_n, peak_n, peak_sd_n):
                # Between taxels that were just measured an image is a guess, which is far off where taxels saturate.
                fitted, time_s = found, found.time_s
                force_n, path_x_m, path_y_m = on_patch
                # That of the whole goes with its depth, by which it is followed to 0.
                force = found.time_s, found.force_n
                peak_n, x_m, y_m, peak_sd_n = own_n, own_x_m, own_y_m, FORCE_SD * own_n
        onset_s, onset_sd_s = self._onset(touch, force, found, is_short)
        end_s = touch.last_s if stays else self._last_touched(touch, force if is_short else None, period_s)
        kind = Kind.IMPACT if stays else touch.kind(onset_s, end_s, frame_s, self._config)
        impulse_n_s = impulse_of((time_s, force_n), onset_s, end_s if is_short else float(time_s[-1]))
        told = Impact(
            number=touch.number,
            is_over=True,
            kind=kind,
            onset_s=onset_s,
            onset_sd_s=onset_sd_s,
            duration_s=max(end_s - onset_s, 0.0),
            frames=touch.frames_seen,
            x_m=x_m,
            y_m=y_m,
            peak_n=peak_n,
            peak_sd_n=peak_sd_n,
            bounced=kind is Kind.IMPACT and not stays,
            impulse_n_s=impulse_n_s,
            impulse_sd_n_s=FORCE_SD * impulse_n_s if fitted is not None else impulse_n_s * peak_sd_n / peak_n,
            time_s=time_s,
            force_n=force_n,
            path_x_m=path_x_m,
            path_y_m=path_y_m,
        )
        # Along something long no motion is seen.
        if fitted is None or fitted.is_long or kind is not Kind.IMPACT:
            return told
        return _with_direction(told, fitted)

    def _onset(self, touch: Touch, force: Force, fitted: Footprint | None, is_short: bool) -> tuple[float, float]:
        """When a touch that is over first touched, and the standard deviation [s]."""
        followed = None if fitted is None else follow_back_impact(fitted)
        of_images = force if is_short and fitted is None else None
        onset_s, onset_sd_s = touch.onset(self._untouched_before(touch), of_images, followed)
        # What taps for long may look like an impact that stays; the onset of one that is none is hardly known so.
        if touch.slow_onset is not None and (not is_short or onset_sd_s > _UNSURE_S):
            return touch.slow_onset
        return onset_s, onset_sd_s

    def _last_touched(self, touch: Touch, force: Force | None, period_s: float) -> float:
        """When a touch that is over was last touched [s]."""
        free_s = self._samples.untouched_s(touch.x_m, touch.y_m, touch.patch, touch.last_sample_s, math.inf)
        return touch.end(free_s, touch.last_sample_s + 1.5 * period_s, force)[0]

    def slow_onset(self, touch: Touch, time_s: float) -> tuple[float, float] | None:
        """When a touch that is no impact began, and the standard deviation [s]."""
        first_s = touch.first_sample_s - self._config.impact_longest_s
        rise = self._samples.rise(
            first_s, time_s, *touch.start_m, touch.patch, touch.peak_image, self._config.impact_foam_spread_m
        )
        return None if rise is None else follow_back(rise)

    def _untouched_before(self, touch: Touch) -> NDArray[np.float64]:
        # At an edge of the skin few taxels lie around: the last frames may have measured none of them.
        return self._samples.untouched_s(*touch.start_m, touch.patch, -math.inf, touch.first_sample_s)

    def _footprint(
        self, touch: Touch, touches: Sequence[Touch], time_s: Array, force_n: Array, x_m: Array, y_m: Array
    ) -> Footprint | None:
        total = float(force_n.sum())
        middle_m = float(force_n @ x_m) / total, float(force_n @ y_m) / total
        away_m2 = (x_m - middle_m[0]) ** 2 + (y_m - middle_m[1]) ** 2
        spread_m = math.sqrt(float(force_n @ away_m2) / total + touch.spread_m**2)
        # What begins later may be a piece of the same.
        before_s = touch.began_s - self._config.impact_longest_s
        others = [one.area for one in touches if one.began_s < before_s and one.patch == touch.patch and one.area]
        return self._samples.footprint(float(time_s[0]), float(time_s[-1]), *middle_m, touch.patch, spread_m, others)


def _with_direction(impact: Impact, fitted: Footprint) -> Impact:
    """The same impact, with the way that its footprint went."""
    vx, vy = fitted.velocity_m_s.tolist()
    sd_x, sd_y = np.sqrt(np.diag(fitted.covariance)).tolist()
    return replace(
        impact,
        direction_rad=math.atan2(vy, vx),
        direction_sd_rad=min(fitted.direction_sd_rad, UNKNOWN_DIRECTION_SD_RAD),
        velocity_m_s=(vx, vy),
        velocity_sd_m_s=(sd_x, sd_y),
    )
