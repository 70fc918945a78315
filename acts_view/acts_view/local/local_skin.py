# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Image, contacts and regions of one skin out of its frames, in this process, as the node reconstruction makes them."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.frames import SampleFrame
from acts_driver.baseline import Baseline
from acts_recon.frame_pipeline import RepeatedFrameError
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.settings import ReconstructionConfig
from acts_view.skin.snapshot import Frame, RegionState, Sample, SkinShape, contact_table

# Where nobody takes them, so many samples are kept: ten seconds at 1 kHz.
_SAMPLES_MAX = 10_000


class LocalSkin:
    """Recovers frames; everything is compiled when the constructor is through.

    Parameters
    ----------
    settings : ReconstructionConfig
        Size, layout and method, as the node's parameters.
    with_outlines : bool
        Whether to find the outlines of contacts, whenever the newest is asked for; that costs CPU.

    Raises
    ------
    ArrayError, SettingsError
        As of `ReconstructionConfig.recovery`.
    """

    def __init__(self, settings: ReconstructionConfig, *, with_outlines: bool = False) -> None:
        self._recovery = FrameRecovery(settings)
        self._tracer = settings.outline_tracer(self._recovery.recovery) if with_outlines else None
        self._lock = threading.Lock()
        self._samples: list[Sample] = []
        self._stamp_ns = 0
        self._duration_s = 0.0
        self._is_fitting = True
        self._is_blank = True
        self.rejected = 0
        """Frames that did not fit."""
        self.problem = ""
        """Why the last of them did not."""
        self.shape = SkinShape(
            layout=settings.layout,
            rows=settings.rows,
            cols=settings.cols,
            pitch_m=settings.pitch_m,
            row_pitch_m=settings.row_pitch_m,
            touch_counts=settings.touch_counts,
            force_full_scale_counts=settings.force_full_scale_counts,
            force_dead_n=settings.force_dead_n,
            force_half_n=settings.force_half_n,
            force_response=settings.force_response,
        )

    def take(self, frames: Sequence[tuple[SampleFrame, int]], now_ns: int | None) -> None:
        """Recover frames, in their order; from one thread.

        Parameters
        ----------
        frames : sequence of (SampleFrame, int)
            Each with the time of its last measurement [ns].
        now_ns : int or None
            The time now, by the same clock [ns]; None: of a recording, how late a frame is says nothing.
        """
        for frame, stamp_ns in frames:
            latency_ms = math.nan if now_ns is None else (now_ns - stamp_ns) * 1e-6
            with self._lock:
                try:
                    self._step(frame, stamp_ns, latency_ms)
                except ArrayError as error:
                    # A frame that came twice is shown already.
                    if not isinstance(error, RepeatedFrameError):
                        self._is_fitting = False
                    self.rejected += 1
                    self.problem = str(error)

    def newest(self) -> tuple[Frame, list[Sample]] | None:
        """What is newest, and the samples since the last call; None without any. From any thread.

        Where the last frame did not fit, and none before it is new, the newest is once that there is no picture.
        """
        with self._lock:
            samples, self._samples = self._samples, []
            if not samples:
                if self._is_fitting or self._is_blank:
                    return None
                self._is_blank = True
                return Frame(stamp_s=self._stamp_ns * 1e-9), []
            self._is_blank = False
            found = self._recovery
            recovery, contact = found.recovery, found.contact
            confidence, age_s = recovery.confidence(), recovery.age_s
            numbers, table = contact_table(found.blobs)
            frame = Frame(
                stamp_s=self._stamp_ns * 1e-9,
                image=np.rint(recovery.image).astype(np.uint16),
                confidence=None if confidence is None else confidence.copy(),
                age_s=None if age_s is None else np.where(age_s <= self._duration_s, np.float32(0.0), age_s),
                contact_numbers=numbers,
                contacts=table,
                outlines=self._outlines(),
                touch=(contact.x_m, contact.y_m, contact.force_n, contact.peak_counts, contact.area_m2)
                if contact.in_contact
                else None,
                regions=[RegionState(one.name, one.force_n, one.slip_m, one.slipping) for one in found.regions],
            )
        return frame, samples

    def _outlines(self) -> list[NDArray[np.float32]]:
        found = self._recovery
        if self._tracer is None or found.frame is None:
            return []
        duration_s = found.frame.duration_us * 1e-6
        outlines = self._tracer.step(
            found.frame.indices, found.frame.counts, self._stamp_ns * 1e-9, duration_s, found.recovery.image
        )
        return [np.column_stack((one.x_m, one.y_m)).astype(np.float32) for one in outlines]

    def set_baseline(self, baseline: Baseline) -> None:
        """Subtract from now on what the taxels read untouched."""
        with self._lock:
            self._recovery.set_baseline(baseline.counts.ravel(), baseline.noise_counts.ravel(), baseline.valid.ravel())

    def reset(self) -> None:
        """Forget all frames: the next one is long after or before, or of another board."""
        with self._lock:
            self._recovery.reset()
            if self._tracer is not None:
                self._tracer.reset()
            self._samples.clear()

    def _step(self, frame: SampleFrame, stamp_ns: int, latency_ms: float) -> None:
        lost = self._recovery.step(frame, stamp_ns)
        self._is_fitting = True
        self._stamp_ns = stamp_ns
        self._duration_s = frame.duration_us * 1e-6
        if len(self._samples) < _SAMPLES_MAX:
            self._samples.append(Sample(stamp_ns * 1e-9, self._recovery.contact.force_n, latency_ms, lost))
