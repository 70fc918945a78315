# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Motion and slip on all patches of an image whose taxels were measured at different times.

A board that measures a part of the taxels in each frame has a rolling shutter. While the force grows, taxels measured
later read more, which looks like motion. So every taxel is interpolated between its last two measurements, linearly, to
one moment for the whole patch: that at which the last of its pressed taxels was measured. Two such images, a window
apart, are compared (`acts_recon.slip.motion`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS
from acts_core.errors import ArrayError
from acts_core.kernels import as_compiled
from acts_core.skin import SkinPatch
from acts_recon.images import LONGEST_PAUSE_S, NO_DEAD, DeadTaxels, require_image, require_recovered
from acts_recon.slip import watch_kernels as kernels
from acts_recon.slip.config import SlipConfig
from acts_recon.slip.motion import RIDGE, SMALLEST_SIDE, Motion

# Images kept of each patch, at least a window's worth at any rate.
_KEPT = 64

# Frames come unevenly, and some are lost: up to so many windows are taken as one.
_LONGEST_WINDOWS = 2.0

NOISE_COUNTS = 1.5
"""Of the images that docs/slip.md has figures of; of a board whose noise nobody has told, the regions assume more."""


class Slip(NamedTuple):
    """What one patch feels of motion.

    Attributes
    ----------
    slipping : bool
    motion : Motion or None
        Within the window; None where nothing presses, or the window is not full yet.
    elapsed_s : float
        Time between the two images that were compared [s]; 0 without a motion.
    distance_taxels, distance_m : float
        Distance within the window where that counts as motion; else 0.
    """

    slipping: bool = False
    motion: Motion | None = None
    elapsed_s: float = 0.0
    distance_taxels: float = 0.0
    distance_m: float = 0.0


NO_SLIP = Slip()


class SlipWatch:
    """Watches the patches of an image; everything is allocated and compiled before the first.

    Parameters
    ----------
    rows, cols : int
        Size of the image.
    patches : sequence of SkinPatch
        Those of the image; at least 3 by 3 taxels each.
    config : SlipConfig, optional
    noise_counts : float
        Standard deviation of a measurement [counts].
    pressed_counts : float
        Taxels above are pressed: an image is of the moment at which all these have been measured.
    dead : DeadTaxels, optional
        Those of the image; they are estimated from what was measured around them at one moment.

    Raises
    ------
    ArrayError
        For a smaller patch, or one that is not within the image, dead taxels of another image, or noise that is not
        above 0.
    """

    def __init__(
        self,
        rows: int,
        cols: int,
        patches: Sequence[SkinPatch],
        config: SlipConfig | None = None,
        noise_counts: float = NOISE_COUNTS,
        pressed_counts: float = TOUCH_COUNTS,
        dead: DeadTaxels | None = None,
    ) -> None:
        self.config = config = SlipConfig() if config is None else config
        for patch in patches:
            if min(patch.rows, patch.cols) < SMALLEST_SIDE:
                raise ArrayError(
                    f"a patch of {patch.rows} x {patch.cols} taxels: motion is seen on {SMALLEST_SIDE} x "
                    f"{SMALLEST_SIDE} and more"
                )
            if min(patch.bounds) < 0 or patch.end_row > rows or patch.end_col > cols:
                raise ArrayError(
                    f"patch {patch.name} of rows {patch.first_row} to {patch.end_row - 1} and columns "
                    f"{patch.first_col} to {patch.end_col - 1}: the image is {rows} x {cols}"
                )
        if dead is not None:
            dead.require_shape(rows, cols)
        if not noise_counts > 0.0:
            raise ArrayError(f"noise_counts = {noise_counts}: allowed is a number above 0")
        self._pitches_m = [(patch.pitch_m, patch.row_pitch_m) for patch in patches]
        self._bounds = np.array([patch.bounds for patch in patches], dtype=np.int64).reshape(-1, 4)
        self._tuning = kernels.Tuning(
            config.slip_window_s,
            config.slip_window_s / (_KEPT - 8),
            config.slip_max_lag_s,
            config.slip_min_counts,
            float(pressed_counts),
            float(noise_counts),
            RIDGE,
        )
        self._shape = (rows, cols)
        self._no_age = np.zeros(self._shape, dtype=np.float32)
        shape = self._shape
        self._memory = kernels.Memory(
            last=np.zeros(shape, dtype=np.float32),
            before=np.zeros(shape, dtype=np.float32),
            last_s=np.zeros(shape),
            before_s=np.zeros(shape),
            now=np.zeros(shape, dtype=np.float32),
            past=np.zeros((_KEPT, *shape), dtype=np.float32),
            past_s=np.zeros((len(patches), _KEPT)),
            newest=np.zeros(len(patches), dtype=np.int64),
            matrix=np.zeros((4, 5)),
            inverse=np.zeros((4, 4)),
            is_dead=np.zeros(shape, dtype=np.bool_) if dead is None else dead.in_picture,
            dead=NO_DEAD if dead is None else dead.table,
        )
        self._results = np.zeros((len(patches), kernels.RESULTS))
        self._told_s = [-math.inf] * len(patches)
        self._time_s = -math.inf
        # Between the two images before the newest one.
        self._pace_s = math.inf
        self._period_s = math.inf
        self._warm_up()

    def reset(self) -> None:
        """Start anew, for instance after a pause."""
        memory = self._memory
        for times in (memory.last_s, memory.before_s, memory.past_s):
            times.fill(-np.inf)
        self._results.fill(0.0)
        self._told_s = [-math.inf] * len(self._told_s)
        self._time_s = -math.inf
        self._pace_s = self._period_s = math.inf

    def step(
        self,
        time_s: float,
        values: NDArray[np.float32],
        counts: NDArray[np.float64],
        age_s: NDArray[np.float32] | None = None,
    ) -> list[Slip]:
        """Update by the next image.

        Parameters
        ----------
        time_s : float
            Its time; where it goes back, or on by more than half a second, everything begins anew [s].
        values : np.ndarray [shape=(rows, cols), dtype=float32]
            Last measurement of every taxel, counts above the baseline, finite; not kept.
        counts : np.ndarray [shape=(patches,), dtype=float64]
            Sum of the counts on each patch: whether anything presses.
        age_s : np.ndarray [shape=(rows, cols), dtype=float32], optional
            How long ago that was [s], inf: never; without it all were measured now. A patch is watched once each of its
            live taxels has been measured.

        Returns
        -------
        list of Slip
            Of every patch.

        Raises
        ------
        ArrayError
            When an image or `counts` have another shape or type, or one of them or the time is not finite. Everything
            is left as it was.
        """
        ages = self._no_age if age_s is None else age_s
        require_image("image", values, self._shape)
        require_image("age_s", ages, self._shape)
        self._require_counts(counts)
        # What is kept of them would tell of slip in all that follows.
        require_recovered(self._shape, time_s, 0.0, image=values, age_s=age_s)
        time_s = float(time_s)
        if not 0.0 <= time_s - self._time_s <= LONGEST_PAUSE_S:
            self.reset()
        self._pace_s, self._period_s = self._period_s, time_s - self._time_s
        self._time_s = time_s
        kernels.update(time_s, as_compiled(values), as_compiled(ages), self._memory)
        kernels.watch(time_s, self._bounds, as_compiled(counts), self._memory, self._tuning, self._results)
        results = self._results.tolist()
        shares = [self._share_of_limits(p, numbers) for p, numbers in enumerate(results)]
        # Two patches that move at once confirm each other.
        together = self.config.slip_together_share
        needed = together if sum(share >= together for share in shares) > 1 else 1.0
        return [self._slip(p, numbers, shares[p] >= needed) for p, numbers in enumerate(results)]

    def _require_counts(self, counts: NDArray[np.float64]) -> None:
        patches = len(self._told_s)
        # Lists come from callers without types.
        if not isinstance(counts, np.ndarray):
            raise ArrayError(f"counts {type(counts).__name__}: needed is an array of numpy, of {patches} float64")
        if counts.shape != (patches,) or counts.dtype != np.float64:
            raise ArrayError(
                f"counts of shape {counts.shape}, {counts.dtype}: needed is ({patches},), float64, a sum for each patch"
            )
        if not np.isfinite(counts).all():
            raise ArrayError("counts with NaN or infinity: needed is a finite sum for each patch; leave the image out")

    def _share_of_limits(self, patch: int, numbers: list[float]) -> float:
        """Motion relative to the limit that it is farthest below; 0 where it cannot be told."""
        has_motion, cols, rows, sd_taxels, gain, _, elapsed_s, cut, pace_s = numbers
        config = self.config
        if not has_motion or not 1.0 / config.slip_max_gain <= gain <= config.slip_max_gain:
            return 0.0
        pitch_m, row_pitch_m = self._pitches_m[patch]
        taxels, metres = math.hypot(cols, rows), math.hypot(cols * pitch_m, rows * row_pitch_m)
        # Written so that it holds for no NaN.
        if not (taxels >= config.slip_cut_taxels * cut * abs(math.log(gain)) and sd_taxels >= 0.0):
            return 0.0
        sigmas = taxels / sd_taxels if sd_taxels > 0.0 else math.inf
        # After a gap the earlier image may be many windows old. In that time skin creeps farther than in one, but no
        # faster. Where frames come slowly all the time, a window is what lies between two of them.
        if math.isinf(pace_s):
            # The earlier image is the first of a touch: then it counts how the images before this one came.
            pace_s = 0.0 if math.isinf(self._pace_s) else self._pace_s
        windows = max(elapsed_s / (_LONGEST_WINDOWS * max(config.slip_window_s, pace_s)), 1.0)
        return min(
            taxels / (windows * config.slip_distance_taxels),
            metres / (windows * config.slip_distance_m),
            sigmas / config.slip_sigmas,
        )

    def _slip(self, patch: int, numbers: list[float], slips: bool) -> Slip:
        has_motion, cols, rows, sd_taxels, gain, growth, elapsed_s = numbers[: kernels.CUT]
        if not has_motion:
            return NO_SLIP if self._time_s - self._told_s[patch] > self.config.slip_hold_s else Slip(True)
        motion = Motion(cols, rows, sd_taxels, gain, growth)
        if slips:
            self._told_s[patch] = self._time_s
            pitch_m, row_pitch_m = self._pitches_m[patch]
            metres = math.hypot(cols * pitch_m, rows * row_pitch_m)
            return Slip(True, motion, elapsed_s, motion.distance_taxels, metres)
        return Slip(self._time_s - self._told_s[patch] <= self.config.slip_hold_s, motion, elapsed_s)

    def _warm_up(self) -> None:
        """Compile, or load from the cache, what the first image would otherwise wait seconds for."""
        empty = np.zeros(self._shape, dtype=np.float32)
        self.reset()
        self.step(0.0, empty, np.zeros(len(self._told_s)))
        self.reset()
