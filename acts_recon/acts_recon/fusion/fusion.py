# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fusion of samples over time: an image at every frame out of all samples so far, and how sure it is.

A frame of 55 samples shows little, but at 1 kHz the skin hardly changes from one frame to the next. The estimator
predicts the image and corrects it by each frame's samples, as a Kalman filter does, but with a variance for every taxel
instead of a covariance matrix. One frame takes five steps:

1. **Motion: Lucas-Kanade per tile.** The velocity v of each tile of 4 x 4 taxels minimises ``sum (g . v + dc/dt)^2``
   over the samples of the 20 x 20 taxels around it. g is the image's gradient at a sample, dc/dt the change of the
   taxel since its last measurement; older samples fade. A velocity that explains less than `motion_share` of the
   changes is not used.
2. **Prediction.** The estimate is shifted by v. What v does not explain follows each taxel's slope, which fades.
   Value and slope of a taxel are an alpha-beta filter: ``value = count`` (alpha = 1) and ``slope += b (dc/dt - slope)``
   with ``b = t^2 / (t^2 + slope_memory_s^2)``, where t is the time between two measurements.
3. **Update.** The innovation of a sample is its count less the prediction for its time. The taxel takes the count. The
   taxels around it are corrected by inverse-distance interpolation: the mean of the innovations within two taxels,
   weighted by ``1 / distance^5``, times `spread_gain`. A taxel measured t ago is corrected by the share that arose
   since then: t over the time between the sample's measurements. One that was never measured is known by those around
   it alone: what of its estimate is above the least of the samples within two taxels fades within some 10 ms, since
   beyond the edge of a contact at least one of them reads little.
4. **Image.** A taxel shows its last count and, as far as predictions are trusted, how it has changed since: those of
   this frame, too, since an image is of the end of its frame. Above half of the full scale none is shown to have risen
   beyond what was measured within the last `horizon_s`. A count that can be noise has no slope. The trust is the least
   squares solution of ``measured change = trust * predicted change``, of each taxel for predictions over less than
   `horizon_s`, of each tile for longer ones. Where nothing predicted comes true, the image is that of the last values.
   A slope is trusted as far as earlier slopes came true, and what it predicts counts as one more such prediction, which
   comes true over times well below `UNPROVEN_S` and fails over longer ones: a slope that nothing but samples beside has
   confirmed is not followed past the end of an impact, nor a tap that holds. At `horizon_s` the slope is forgotten, and
   what it added stays as far as it was trusted. In place of the noise of untouched skin its mean is shown, since the
   noise of a thousand taxels would pull the centre of pressure to and fro. What untouched skin reads is learnt, see
   below.
5. **Uncertainty.** ``sigma^2 = noise^2 + s q t^2 + ...``, where t is the taxel's age and q its process noise: the
   exponential average of ``(innovation^2 - 2 noise^2) / t^2``. The factor s is innovation-based adaptive noise. It
   follows the normalised innovation squared, slowly over frames and at once within a frame.

**Noise.** It begins as calibrated for every taxel (`FusionEstimator.set_noise`), or as the settings say. While running,
each tile sums up its low readings, which are those of taxels with none beside that reads more than 4.6 standard
deviations. A low reading is noise if, lately in its tile, 0 was about as good a prediction of the next reading as the
last one, and if the readings changed no more than the noise of fast measured taxels explains. A light steady pressure
fails the first, slow changes of the skin the second. So on a skin with little noise readings of one count are shown.
Noise of a known size is shown as 0, though it reads more in the mean: no reading is below 0. Where nobody has told the
noise, it is taken for `NOISE_COUNTS` at first, and the mean of the tile's low readings is shown: it may be what
is there.

`fusion_kernels` does the work; `fusion_reference` in the tests is the reference implementation, in double precision.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry, check_untouched
from acts_core.settings import setting, validate
from acts_core.skin import Layout
from acts_recon.fusion.fusion_image_kernels import confidence
from acts_recon.fusion.fusion_kernels import fuse
from acts_recon.fusion.fusion_state import Tuning, expect_noise, forget, new_memory, state_of
from acts_recon.images import (
    LEAST_NOISE_COUNTS,
    LONGEST_PAUSE_S,
    NOISE_COUNTS,
    PlacedSamples,
    borders_of,
    require_times,
)


@dataclass(frozen=True)
class FusionConfig:
    """Settings of the fusion of samples over time.

    The node and `acts evaluate` set `noise_counts` alone; the others are no parameters, and as the figures in docs/
    have them.
    """

    noise_counts: float = setting(
        0.0,
        "standard deviation of a reading about the truth, where it is not calibrated [counts]; 0: not known",
        minimum=0.0,
        maximum=100.0,
    )
    quiet_s: float = setting(0.010, "how long a taxel measured untouched is taken for untouched [s]", minimum=0.0)
    horizon_s: float = setting(0.020, "measurements older than this predict no change [s]", minimum=1e-4, maximum=10.0)
    damping_s: float = setting(0.050, "time constant with which a taxel's slope fades [s]", minimum=1e-4, maximum=10.0)
    slope_memory_s: float = setting(
        0.0004, "time between two measurements at which half of the slope is replaced [s]", minimum=1e-5, maximum=10.0
    )
    motion_memory_s: float = setting(
        0.004, "time constant of the sums that motion is found from [s]", minimum=1e-4, maximum=10.0
    )
    motion_share: float = setting(
        0.3, "a motion is used where it explains more than this share of the changes", minimum=0.0, maximum=1.0
    )
    spread_gain: float = setting(
        0.6, "share of a sample's innovation that its neighbours are corrected by", minimum=0.0, maximum=1.0
    )
    reset_after_s: float = setting(LONGEST_PAUSE_S, "after a gap this long the estimate starts anew [s]", minimum=1e-3)
    confidence_counts: float = setting(
        30.0, "sigma at which the confidence is one half [counts]", minimum=0.1, maximum=float(COUNT_MAX)
    )

    def __post_init__(self) -> None:
        validate(self)

    @property
    def tuning(self) -> Tuning:
        """For the kernels."""
        return Tuning(*(float(getattr(self, name)) for name in Tuning._fields))


class FusionEstimator:
    """Estimates the image after each frame of samples; everything is allocated and compiled before the first.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the picture; without a layout that is the matrix itself.
    config : FusionConfig
    layout : Layout, optional
        Where the taxels of the matrix lie in the picture. `step` takes matrix indices, all results are the picture's.
        Each patch is estimated by itself: no sample affects another patch. Where there is no skin the image is 0.

    Raises
    ------
    ArrayError
        When the layout is of another size.
    """

    def __init__(
        self, geometry: ArrayGeometry, config: FusionConfig | None = None, layout: Layout | None = None
    ) -> None:
        self.geometry = geometry
        self.config = config or FusionConfig()
        self._tuning = self.config.tuning
        self._samples = PlacedSamples(geometry, layout)
        self._places = np.arange(geometry.size) if layout is None else layout.places.astype(np.intp)
        self.borders = borders_of(geometry.rows, geometry.cols, layout)
        self._memory = new_memory(geometry.rows, geometry.cols, self.borders)
        self._state = state_of(self._memory)
        self.set_noise(np.zeros(self._places.size, dtype=np.float32), np.zeros(self._places.size, dtype=np.bool_))
        self._confidence = np.zeros(geometry.size, dtype=np.uint8)
        self._end_s: float | None = None
        shape = (geometry.rows, geometry.cols)
        self.image: NDArray[np.float32] = self._state.image.reshape(shape)
        """The image at the end of the last frame [counts, 0 to 1023]; np.ndarray [shape=(rows, cols), dtype=float32].

        Overwritten by the next frame, as are `sigma`, `age_s` and `measured`: copy what is to be kept.
        """
        self.sigma: NDArray[np.float32] = self._state.sigma.reshape(shape)
        """Standard deviation of `image` [counts]; np.ndarray [shape=(rows, cols), dtype=float32]."""
        self.age_s: NDArray[np.float32] = self._state.age.reshape(shape)
        """Time since each taxel was measured [s], inf: never; np.ndarray [shape=(rows, cols), dtype=float32]."""
        self.measured: NDArray[np.float32] = self._state.value.reshape(shape)
        """What was measured then [counts]; np.ndarray [shape=(rows, cols), dtype=float32]."""
        self._warm_up()

    def reset(self) -> None:
        """Start anew, as if nothing had been measured; what was learnt of the noise is kept."""
        forget(self._memory)
        self._end_s = None

    def set_noise(self, noise_counts: NDArray[np.float32], valid: NDArray[np.bool_]) -> None:
        """Take over the calibrated noise of the taxels; what was learnt of it while running is forgotten.

        Untouched skin whose noise is known is shown as 0. The same noise once more changes nothing.

        Parameters
        ----------
        noise_counts : np.ndarray [shape=(taxels of the matrix,), dtype=float32]
            Standard deviation of each taxel's readings [counts].
        valid : np.ndarray [shape=(taxels of the matrix,), dtype=bool]
            Where it is known; elsewhere `FusionConfig.noise_counts` holds.

        Raises
        ------
        ArrayError
            See `acts_core.array.check_untouched`.
        """
        check_untouched("noise", noise_counts, valid, self._places.size)
        assumed = self.config.noise_counts or NOISE_COUNTS
        noise = np.full(self.geometry.size, assumed, dtype=np.float32)
        noise[self._places[valid]] = noise_counts[valid]
        noise = np.maximum(noise, np.float32(LEAST_NOISE_COUNTS))
        unknown = np.full_like(noise, 0.0 if self.config.noise_counts else 1.0)
        unknown[self._places[valid]] = 0.0
        state = self._state
        if not (np.array_equal(noise, state.noise) and np.array_equal(unknown, state.unknown)):
            state.noise[:], state.unknown[:] = noise, unknown
            expect_noise(self._memory)

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """Predict to the end of a frame and update by its samples.

        Frames may be lost or repeated. The estimate starts anew when the clock goes back, or when more than
        `reset_after_s` lie between two frames.

        Parameters
        ----------
        indices : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices of the matrix in the order of measurement, none twice; at least one.
        counts : np.ndarray [shape=(m,), dtype=uint16]
            What was measured there, 0 to 1023.
        end_s : float
            When the last measurement ended [s], on any clock.
        duration_s : float
            From the start of the first measurement to the end of the last [s]; they are evenly spaced.

        Returns
        -------
        np.ndarray [shape=(rows, cols), dtype=float32]
            `image`.

        Raises
        ------
        ArrayError
            When the frame does not fit the array or holds impossible values. Everything is left as it was.
        """
        require_times(end_s, duration_s)
        places, counts = self._samples.of(indices, counts)
        end_s, duration_s = float(end_s), float(duration_s)
        period_s = duration_s
        if self._end_s is not None:
            period_s = end_s - self._end_s
            if not 0 <= period_s <= self.config.reset_after_s:
                self.reset()
                period_s = duration_s
        self._end_s = end_s
        fuse(self._memory, places, counts, period_s, duration_s, self.geometry.cols, self._tuning)
        return self.image

    def confidence(self) -> NDArray[np.uint8]:
        """Confidence of each taxel: ``255 / (1 + (sigma / confidence_counts)^2)``, rounded.

        Returns
        -------
        np.ndarray [shape=(rows, cols), dtype=uint8]
            Overwritten by the next call.
        """
        confidence(self._state.sigma, self.config.confidence_counts, self._confidence)
        return self._confidence.reshape(self.image.shape)

    def _warm_up(self) -> None:
        """Compile, or load from the cache, what the first frame would otherwise wait seconds for."""
        one = np.zeros(1, dtype=np.uint16)
        self.step(one, one, 0.0, 0.0)
        self.step(one, one, 1e-3, 1e-3)
        self.confidence()
        self.reset()
        expect_noise(self._memory)
