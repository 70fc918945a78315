# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A worn skin that nobody touches for minutes, with noise and drift: what is told of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import CalibrationError, SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_core.sampling import MEASUREMENT_US, SamplingConfig
from acts_core.skin import layout
from acts_driver.baseline import BaselineConfig, BaselineTracker
from acts_sim.wearables import RestingSkin
from acts_tools.evaluate.scene_frames import Frame
from acts_tools.evaluate.wearables.watching import SCHEME, THRESHOLD_COUNTS, Watcher
from acts_tools.firmware.board_sampler import sampler_of

_CALIBRATED_AFTER_S = 3


@dataclass(frozen=True)
class Untouched:
    """What happened on a skin to which nothing happened.

    Attributes
    ----------
    seconds : int
        For how long it was watched, after its calibration.
    frames : int
    told : int
        Messages of a touch.
    drift_counts : float
        How far the taxel that drifted furthest was from where it was calibrated, at most [counts].
    """

    seconds: int
    frames: int
    told: int
    drift_counts: float


def watch_untouched(
    layout_name: str,
    seconds: int,
    m: int,
    noise_counts: float,
    rng: np.random.Generator,
    show: Callable[[int], None],
) -> Untouched:
    """Calibrate an untouched skin in its first seconds, as the driver does, and watch it.

    Parameters
    ----------
    layout_name : str
    seconds : int
    m : int
        Taxels per frame.
    noise_counts : float
        Of a reading.
    rng : np.random.Generator
    show : callable
        Called with the number of seconds so far.

    Raises
    ------
    SettingsError
        With so much noise the driver takes the untouched skin for a touched one.
    """
    arranged = layout(layout_name)
    watcher = Watcher(arranged, noise_counts)
    rows, cols = arranged.matrix_rows, arranged.matrix_cols
    resting = RestingSkin(rows * cols, rng)
    config = SamplingConfig(scheme=SCHEME, m=m, threshold_counts=THRESHOLD_COUNTS, seed=int(rng.integers(1, 2**31)))
    sampler = sampler_of(config, noise_counts, watcher.skin_map)
    tracker = BaselineTracker(rows, cols, BaselineConfig())
    tracker.arrange(arranged)
    sample_s = 1e-6 * MEASUREMENT_US
    duration_s = m * sample_s
    per_second = int(1 / duration_s)
    told, largest = 0, 0.0
    calibrated = np.zeros((rows, cols))
    for second in range(_CALIBRATED_AFTER_S + seconds):
        ends = [resting.counts(second + more).reshape(rows, cols) for more in (0, 1)]
        frames = np.rint(ends).astype(np.uint16)
        if second == _CALIBRATED_AFTER_S:
            try:
                tracker.calibrate()
            except CalibrationError as error:
                raise SettingsError(
                    f"--noise-counts {noise_counts:g}: by so much noise a driver takes the untouched skin {layout_name}"
                    " for touched, and does not calibrate it; give less, or leave untouched skins out by --untouched "
                    "without names"
                ) from error
            calibrated = ends[0]
        is_calibrated = second >= _CALIBRATED_AFTER_S
        if is_calibrated:
            # Once a second, as the driver publishes it.
            baseline = tracker.present()
            assert baseline is not None
            watcher.set_baseline(baseline.counts.ravel())
            largest = max(largest, float(np.abs(ends[1] - calibrated).max()))
        seen: list[tuple[SampleFrame, int]] = []
        for number in range(per_second):
            begin_s = number * duration_s
            indices, counts = sampler.frame(frames, begin_s, sample_s)
            end_s = second + begin_s + duration_s
            if is_calibrated:
                told += len(watcher.step(Frame(end_s, duration_s, indices, counts)))
            seen.append((_sample_frame(indices, counts, rows, cols), round(1e9 * end_s)))
        tracker.observe(seen)
        show(second + 1)
    return Untouched(seconds, seconds * per_second, told, largest)


def _sample_frame(indices: NDArray[np.uint16], counts: NDArray[np.uint16], rows: int, cols: int) -> SampleFrame:
    return SampleFrame(0, 0, 0, Scheme.TRACKING, rows, cols, 0, indices.copy(), counts.copy())
