# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How well a board keeps its time: rate, losses, clock."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.sampling import MEASUREMENT_US
from acts_driver.selftest.findings import Finding, Level, Thresholds
from acts_driver.selftest.record import FrameRecord
from acts_driver.stream import ClockFilter

_SEQUENCE_MODULUS = 2**32
# No board loses half of all numbers: it began to count anew.
_RESTART_FROM = 2**31
_DRIFT_FROM_S = 2.0


@dataclass(frozen=True, eq=False)
class Timing:
    """Of the frames of a record.

    Attributes
    ----------
    frames, lost : int
        Frames that came; numbers missing between them.
    restarts : int
        How often the numbers went back.
    rate_hz : float
        Frames per second of the board's clock, lost ones included; of the host's where the board has no clock.
    possible_hz : float
        What measuring and the rate cap allow; NaN where the board says neither.
    taxel_us : float
        Median time of one measurement [us]; NaN where the board does not say how long a frame takes.
    jitter_us : float
        99th percentile of how far a frame begins off the steady beat [us]; NaN without a clock or with too few frames.
    drift_ppm : float
        How much faster the board's clock runs than the host's; NaN without a clock or below 2 s.
    late_us : np.ndarray [shape=(n,), dtype=float64]
        How much longer each frame was on its way than the fastest [us]; empty without a clock.
    """

    frames: int
    lost: int
    restarts: int
    rate_hz: float
    possible_hz: float
    taxel_us: float
    jitter_us: float
    drift_ppm: float
    late_us: NDArray[np.float64]


def measure_timing(record: FrameRecord, *, has_board_clock: bool, frame_period_us: float = 0.0) -> Timing:
    """Timing of a record of two frames or more; `frame_period_us` is the board's rate cap, 0 for none or unknown."""
    frames = record.frames
    steps = np.mod(np.diff(np.array([frame.sequence for frame in frames], dtype=np.int64)), _SEQUENCE_MODULUS)
    # From one frame to the next of the same life: over a restart neither numbers nor clock go on.
    goes_on = steps < _RESTART_FROM
    restarts = int((~goes_on).sum())
    steps[~goes_on] = 1
    # A frame that comes twice makes up for none that is missing.
    lost = int(np.maximum(steps - 1, 0).sum())
    arrivals_us = np.array(record.arrivals_ns, dtype=np.float64) / 1000
    board_us = np.array([frame.board_us for frame in frames], dtype=np.float64)
    duration_us = np.array([frame.duration_us for frame in frames], dtype=np.float64)
    sizes = np.array([len(frame.indices) for frame in frames])
    clock_us = board_us if has_board_clock else arrivals_us
    beat_us = float(np.diff(clock_us)[goes_on].sum()) / max(int(steps[goes_on].sum()), 1)
    possible_us = max(float(np.median(duration_us)), frame_period_us)
    jitter_us, drift_ppm, late_us = np.nan, np.nan, np.empty(0)
    if has_board_clock:
        begins_us = board_us - duration_us
        off_us = (np.diff(begins_us) - steps * beat_us)[goes_on]
        jitter_us = float(np.percentile(np.abs(off_us), 99)) if len(off_us) >= 10 else np.nan
        clock = ClockFilter()
        late = []
        for frame, arrival_ns in zip(frames, record.arrivals_ns, strict=True):
            clock.step(frame.board_us, arrival_ns)
            late.append(clock.state.delay_us)
        late_us = np.array(late)
        if (clock_us[-1] - clock_us[0]) * 1e-6 > _DRIFT_FROM_S:
            drift_ppm = -clock.state.drift_ppm
    return Timing(
        frames=len(frames),
        lost=lost,
        restarts=restarts,
        rate_hz=1e6 / beat_us if beat_us > 0 else np.nan,
        possible_hz=1e6 / possible_us if possible_us > 0 else np.nan,
        taxel_us=float(np.median(duration_us / np.maximum(sizes, 1))) if duration_us.any() else np.nan,
        jitter_us=jitter_us,
        drift_ppm=drift_ppm,
        late_us=late_us,
    )


def judge_timing(timing: Timing, thresholds: Thresholds) -> list[Finding]:
    """What of this is a fault."""
    return [*_judge_numbers(timing, thresholds), *_judge_clock(timing, thresholds)]


def _judge_numbers(timing: Timing, thresholds: Thresholds) -> list[Finding]:
    """Of the frames that came, and those that did not."""
    findings = []
    share = timing.lost / max(timing.frames + timing.lost, 1)
    of_possible = f" of {timing.possible_hz:.1f} that measuring and the rate cap allow"
    findings.append(
        _item(
            # Not where nothing is known that it could be compared with.
            not timing.rate_hz < thresholds.rate_share * timing.possible_hz,
            "frame rate",
            f"{timing.rate_hz:.1f} frames/s{of_possible if np.isfinite(timing.possible_hz) else ''}",
            "the board does something besides measuring, or has no clock of its own",
        )
    )
    findings.append(
        _item(
            timing.lost == 0,
            "lost frames",
            f"{timing.lost} of {timing.frames + timing.lost}",
            "use another cable and port without a hub, and a host that is less busy",
            Level.FAIL if share > thresholds.lost_share else Level.WARN,
        )
    )
    if timing.restarts:
        findings.append(
            Finding(
                Level.WARN,
                "frame numbers",
                f"they went back in {timing.restarts} of {timing.frames} frames",
                "the board restarted, or its decoder does not count on beyond the board's largest number",
            )
        )
    return findings


def _judge_clock(timing: Timing, thresholds: Thresholds) -> list[Finding]:
    """Of the times that the board tells, as far as it does."""
    findings = []
    low, high = thresholds.taxel_us
    if np.isfinite(timing.taxel_us):
        findings.append(
            _item(
                low <= timing.taxel_us <= high,
                "time per taxel",
                f"{timing.taxel_us:.2f} us (published board: {MEASUREMENT_US:.1f})",
                f"usual are {low:g} to {high:g} us: check the processor's clock and the ADC's settings",
            )
        )
    if np.isfinite(timing.jitter_us):
        findings.append(
            _item(
                timing.jitter_us <= thresholds.jitter_share * 1e6 / timing.rate_hz,
                "clock jitter",
                f"frames begin within {timing.jitter_us:.1f} us of the beat (99 %); on the way to the host "
                f"{np.percentile(timing.late_us, 99):.0f} us of delay (99 %)",
                "something on the board interrupts measuring",
            )
        )
    if np.isfinite(timing.drift_ppm):
        findings.append(
            _item(
                abs(timing.drift_ppm) <= thresholds.drift_ppm,
                "clock drift",
                f"{timing.drift_ppm:+.0f} ppm against the host",
                "a quartz keeps within 100 ppm: is the host's clock being set, or the board's processor overclocked?",
            )
        )
    return findings


def _item(is_good: bool, name: str, text: str, advice: str, otherwise: Level = Level.WARN) -> Finding:
    return Finding(Level.PASS, name, text) if is_good else Finding(otherwise, name, text, advice)
