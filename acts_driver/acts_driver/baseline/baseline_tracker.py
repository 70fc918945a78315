# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Measures the baseline of a skin from the last seconds of the stream, and follows its drift."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.errors import ArrayError, CalibrationError
from acts_core.frames import SampleFrame
from acts_core.runtime import NS_PER_S, Pace
from acts_core.skin import Layout, dead_taxels_named, layout
from acts_core.words import counted
from acts_driver.baseline import baseline_kernels
from acts_driver.baseline.baseline import Baseline, BaselineSource
from acts_driver.baseline.baseline_config import BaselineConfig
from acts_driver.baseline.readings import LEAST_READINGS, Block, Readings, noise_of, readings_of

_LARGEST_STEP = 0.05
_HISTORY_STEP_NS = 10 * NS_PER_S
_HISTORY_STEPS = 6

# A reading farther from the baseline than this is no drift: counts, or standard deviations of the taxel's noise.
_FREEZE_COUNTS = 20.0
_FREEZE_SIGMAS = 6.0


class Drift(NamedTuple):
    """How fast the baseline moves [counts per minute]: the median taxel, and the one that moves fastest."""

    median: float
    largest: float


class Calibration(NamedTuple):
    """A calibration: the baseline since then, and how many taxels were measured for it."""

    baseline: Baseline
    measured: int

    def __str__(self) -> str:
        """What was done, for the one who asked for it."""
        valid, noise_counts = self.baseline.valid, self.baseline.noise_counts
        noise = float(np.median(noise_counts[valid]))
        done = f"calibrated {self.measured} of {valid.size} taxels, noise {noise:.2f} counts (median)"
        return done + _of_others(valid, self.measured, f"fewer than {LEAST_READINGS} readings")


class Tare(NamedTuple):
    """A tare: the baseline since then, how many taxels were measured for it, and how many of them were not still."""

    baseline: Baseline
    measured: int
    unsteady: int

    def __str__(self) -> str:
        """What was done, for the one who asked for it."""
        valid = self.baseline.valid
        done = f"tared {self.measured} of {valid.size} taxels"
        if self.unsteady:
            done += f", but {self.unsteady} of them changed meanwhile: keep what lies on the skin still and tare again"
        return done + _of_others(valid, self.measured, "no reading")


def _of_others(valid: NDArray[np.bool_], measured: int, readings: str) -> str:
    """What became of the taxels that were not measured enough; empty where there are none."""
    if measured == valid.size:
        return ""
    stay = "stay as they were" if valid.sum() > measured else "have no baseline"
    return f"; the other {valid.size - measured} had {readings} and {stay}: the schemes raster and uniform measure all"


class BaselineTracker:
    """Baseline of a stream. Frames come on one thread; calibration, tare and questions may come from another.

    Calibration and tare use the statistics of the last seconds, which are always kept, so both answer at once. From
    then on the baseline of a taxel is an exponential average of its readings. A reading farther from the baseline than
    drift can explain is a touch: it freezes the baseline of the taxel and of the eight around it for a while. Until
    `arrange` has told how the taxels lie on the skin, those around are the ones of the matrix.

    Parameters
    ----------
    rows, cols : int
        Size of the array; every frame must have it.
    config : BaselineConfig

    Raises
    ------
    SettingsError
        Its `dead_taxels` are none of this array, or all.
    """

    def __init__(self, rows: int, cols: int, config: BaselineConfig | None = None) -> None:
        self.config = config or BaselineConfig()
        self._dead = dead_taxels_named(self.config.dead_taxels, rows, cols).ravel()
        self._shape = (rows, cols)
        self._neighbours = layout("square", rows, cols).neighbours
        size = rows * cols
        self._lock = threading.Lock()
        self._block_ns = int(self.config.tare_s * NS_PER_S)
        # One grows, the others are the last whole ones.
        self._blocks = [Block(size) for _ in range(self.config.calibration_blocks + 1)]
        self._growing = 0
        self._growing_since_ns = -1
        # Of the blocks: those of a slow board begin with each of its frames.
        self._pace = Pace()
        self._whole = 0
        self._baseline = np.zeros(size)
        self._noise = np.zeros(size, dtype=np.float32)
        self._freeze = np.full(size, -1.0, dtype=np.float32)
        self._measured_ns = np.zeros(size, dtype=np.int64)
        self._frozen_until_ns = np.zeros(size, dtype=np.int64)
        self._source: BaselineSource | None = None
        self._now_ns = 0
        self._history: deque[tuple[int, NDArray[np.float64]]] = deque(maxlen=_HISTORY_STEPS + 1)
        # Compiled, or loaded, before the first frame.
        self._update(np.zeros(1, dtype=np.uint16), np.zeros(1, dtype=np.uint16), 0)
        self._blocks[self._growing].clear()

    def arrange(self, skin: Layout) -> None:
        """Set which taxels lie around one another.

        Parameters
        ----------
        skin : Layout
            Of this matrix.

        Raises
        ------
        ArrayError
            It is of another.
        """
        self._require_shape("a layout", (skin.matrix_rows, skin.matrix_cols))
        with self._lock:
            self._neighbours = skin.neighbours

    def observe(self, frames: Sequence[tuple[SampleFrame, int]]) -> None:
        """Update by frames with the times of their measurement [ns], in order.

        Raises
        ------
        ArrayError
            One of them is of another array, or its samples are no pairs. Everything is left as it was.
        """
        for frame, _ in frames:
            self._require_shape("a frame", (frame.rows, frame.cols))
            if len(frame.indices) != len(frame.counts):
                raise ArrayError(f"{len(frame.indices)} indices and {len(frame.counts)} counts: needed are as many")
        with self._lock:
            for frame, time_ns in frames:
                self._advance(time_ns)
                self._update(frame.indices, frame.counts, time_ns)

    def set(self, baseline: Baseline) -> None:
        """Set the baseline, for example to one from a file.

        Raises
        ------
        ArrayError
            It is of another array.
        """
        self._require_shape("a baseline", baseline.counts.shape)
        with self._lock:
            self._set(
                baseline.counts.ravel(),
                baseline.noise_counts.ravel(),
                baseline.valid.ravel(),
                baseline.source,
            )

    def calibrate(self, *, keeps_others: bool = True) -> Calibration:
        """Determine baseline and noise from the last seconds, in which the skin must have been untouched.

        Parameters
        ----------
        keeps_others : bool
            Whether taxels with too few readings in that time keep their baseline; False where that is of another skin.

        Raises
        ------
        CalibrationError
            When there were too few frames, or something touched the skin.
        """
        with self._lock:
            needed = self.config.calibration_blocks
            if self._whole < needed:
                raise CalibrationError(
                    f"{self._whole * self.config.tare_s:g} s of frames so far, a calibration needs "
                    f"{needed * self.config.tare_s:g} s: wait and call again"
                )
            readings = readings_of(self._blocks)
            measured = readings.n >= LEAST_READINGS
            if not measured.any():
                raise CalibrationError(
                    f"no taxel was measured {LEAST_READINGS} times in the last "
                    f"{needed * self.config.tare_s:g} s: raise the frame rate"
                )
            known = (self._freeze >= 0) & keeps_others
            touched = self._touched(readings, known)
            if touched.any():
                row, col = divmod(int(np.flatnonzero(touched)[0]), self._shape[1])
                raise CalibrationError(
                    f"the skin was touched: {counted(int(touched.sum()), 'taxel')}, for example row {row}, column "
                    f"{col}. Leave it alone for {(needed + 1) * self.config.tare_s:g} s and call again; where nothing "
                    "touches it, tare first"
                )
            self._set(
                np.where(measured, readings.mean, self._baseline),
                np.where(measured, readings.deviation, self._noise),
                measured | known,
                BaselineSource.CALIBRATION,
            )
            return Calibration(self._present(), int(measured.sum()))

    def tare(self, *, keeps_others: bool = True) -> Tare:
        """Tare: set the baseline to the present readings, whatever lies on the skin; noise that is known stays.

        Parameters
        ----------
        keeps_others : bool
            Whether taxels without a recent reading keep their baseline; False where that, and the noise, is of another
            skin.

        Raises
        ------
        CalibrationError
            When there were too few frames.
        """
        with self._lock:
            if self._whole < 1:
                raise CalibrationError(
                    f"less than {self.config.tare_s:g} s of frames so far: wait until the board is read and call again"
                )
            readings = readings_of([self._blocks[self._growing], self._blocks[self._growing - 1]])
            measured = readings.n > 0
            changed = readings.span > self.config.touch_counts
            unsteady = self._beside_others(changed)
            known = (self._freeze >= 0) & keeps_others
            self._set(
                np.where(measured, readings.mean, self._baseline),
                np.where(known, self._noise, noise_of(readings, ~changed)),
                measured | known,
                BaselineSource.TARE,
            )
            return Tare(self._present(), int(measured.sum()), int(unsteady.sum()))

    def present(self) -> Baseline | None:
        """The baseline now; None where there is none."""
        with self._lock:
            return None if self._source is None else self._present()

    def drift(self) -> Drift | None:
        """How fast the baseline has moved over the last minute, or since it was determined; None for less than 10 s.

        Call it at least every 10 s.
        """
        with self._lock:
            if self._source is None:
                return None
            now_ns, baseline = self._now_ns, self._baseline.copy()
            known = (self._freeze >= 0) & ~self._dead
            if not self._history or now_ns < self._history[-1][0]:
                self._history.clear()
                self._history.append((now_ns, baseline))
            elif now_ns - self._history[-1][0] >= _HISTORY_STEP_NS:
                self._history.append((now_ns, baseline))
            then_ns, then = self._history[0]
        minutes = (now_ns - then_ns) / (60 * NS_PER_S)
        if now_ns - then_ns < _HISTORY_STEP_NS or not known.any():
            return None
        speed = (baseline - then)[known] / minutes
        return Drift(float(np.median(speed)), float(speed[np.argmax(np.abs(speed))]))

    def below(self) -> int:
        """Number of taxels that read lower than drift explains, as when what lay there at a tare was taken off."""
        with self._lock:
            readings = readings_of([self._blocks[self._growing - 1]])
            low = readings.mean < self._baseline - self._freeze
            return int(np.count_nonzero((readings.n > 0) & (self._freeze >= 0) & low))

    def _require_shape(self, what: str, shape: tuple[int, ...]) -> None:
        if shape != self._shape:
            rows, cols = self._shape
            raise ArrayError(f"{what} of {' x '.join(map(str, shape))}: this baseline is of {rows} x {cols}")

    def _advance(self, time_ns: int) -> None:
        """Begin the next block where it is time; begin anew after a pause or a jump of the clock."""
        self._now_ns = time_ns
        since_ns = time_ns - self._growing_since_ns
        if 0 <= since_ns < self._block_ns and self._growing_since_ns >= 0:
            return
        if since_ns < 0:
            # The clock was set back: no taxel is kept as it is for longer than after a touch now.
            latest_ns = time_ns + int(self.config.hold_s * NS_PER_S)
            np.minimum(self._frozen_until_ns, latest_ns, out=self._frozen_until_ns)
        self._pace.step(time_ns * 1e-9)
        if self._growing_since_ns >= 0 and 0 <= since_ns < self._pace.limit_s(2 * self.config.tare_s) * NS_PER_S:
            self._growing = (self._growing + 1) % len(self._blocks)
            self._whole = min(self._whole + 1, len(self._blocks) - 1)
        else:
            self._whole = 0
            for block in self._blocks:
                block.clear()
        self._growing_since_ns = time_ns
        self._blocks[self._growing].clear()

    def _update(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], time_ns: int) -> None:
        config, block = self.config, self._blocks[self._growing]
        baseline_kernels.observe(
            indices,
            counts,
            time_ns,
            self._neighbours,
            block.n,
            block.sums,
            block.ends,
            self._baseline,
            self._freeze,
            self._measured_ns,
            self._frozen_until_ns,
            self._source is not None and config.tau_s > 0,
            max(config.tau_s, 1e-9) * NS_PER_S,
            int(config.hold_s * NS_PER_S),
            _LARGEST_STEP,
        )

    def _touched(self, readings: Readings, known: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Taxels that were pressed, or let go, in the time of these readings. One alone is a broken taxel, no touch."""
        untouched = np.where(known, self._baseline, 0.0)
        limit = self.config.touch_counts
        return self._beside_others((readings.n > 0) & ((readings.mean - untouched > limit) | (readings.span > limit)))

    def _beside_others(self, suspicious: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Those of these taxels that are not alone. Dead ones say nothing, whatever they read."""
        suspicious = suspicious & ~self._dead
        # -1, no neighbour, is the last of these.
        around = np.append(suspicious, False)[self._neighbours]
        return suspicious & around.any(axis=1)

    def _set(
        self,
        counts: NDArray[np.floating],
        noise: NDArray[np.floating],
        valid: NDArray[np.bool_],
        source: BaselineSource,
    ) -> None:
        self._baseline[:] = np.where(valid, counts, 0.0)
        self._noise[:] = np.where(valid, noise, 0.0)
        drift = np.maximum(_FREEZE_COUNTS, _FREEZE_SIGMAS * self._noise)
        self._freeze[:] = np.where(valid, np.minimum(drift, max(self.config.touch_counts, _FREEZE_COUNTS)), -1.0)
        # What a dead one reads is no touch, and keeps no taxel around from following its drift.
        self._freeze[self._dead & valid] = COUNT_MAX + 1
        self._frozen_until_ns[:] = 0
        self._source = source
        self._history.clear()

    def _present(self) -> Baseline:
        assert self._source is not None
        return Baseline(
            self._baseline.astype(np.float32).reshape(self._shape),
            self._noise.reshape(self._shape).copy(),
            (self._freeze >= 0).reshape(self._shape),
            self._source,
            self._now_ns,
        )
