# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Image, contacts and regions of one skin out of its frames, in this process, as the node reconstruction makes them."""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence

import numpy as np

from acts_core.errors import ArrayError
from acts_core.frames import SampleFrame
from acts_driver.baseline import Baseline
from acts_recon.contacts import BlobTracker, Contact, TrackedBlob
from acts_recon.images import BaselineSubtraction
from acts_recon.settings import ReconstructionConfig
from acts_view.skin.snapshot import CONTACT_COLUMNS, Frame, RegionState, Sample, SkinShape

_SEQUENCE_MODULUS = 1 << 32
# Where nobody takes them, so many samples are kept: ten seconds at 1 kHz.
_SAMPLES_MAX = 10_000


class LocalSkin:
    """Recovers frames; everything is compiled when the constructor is through.

    Parameters
    ----------
    settings : ReconstructionConfig
        Size, layout and method, as the node's parameters.

    Raises
    ------
    ArrayError, SettingsError
        As of `ReconstructionConfig.recovery`.
    """

    def __init__(self, settings: ReconstructionConfig) -> None:
        self._recovery = settings.recovery()
        self._regions = settings.regions(self._recovery)
        self._tracker = BlobTracker(
            self._recovery.geometry, self._recovery.response, settings.blob_config(), self._recovery.borders
        )
        self._size = (settings.rows, settings.cols)
        self._baseline = BaselineSubtraction(settings.rows * settings.cols)
        self._lock = threading.Lock()
        self._samples: list[Sample] = []
        self._blobs: tuple[TrackedBlob, ...] = ()
        self._contact = Contact()
        self._region_states: list[RegionState] = []
        self._stamp_ns = 0
        self._sequence: int | None = None
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
                    self.rejected += 1
                    self.problem = str(error)

    def newest(self) -> tuple[Frame, list[Sample]] | None:
        """What is newest, and the samples since the last call; None without any. From any thread."""
        with self._lock:
            samples, self._samples = self._samples, []
            if not samples:
                return None
            confidence = self._recovery.confidence()
            contact = self._contact
            frame = Frame(
                stamp_s=self._stamp_ns * 1e-9,
                image=np.rint(self._recovery.image).astype(np.uint16),
                confidence=None if confidence is None else confidence.copy(),
                contact_numbers=np.array([blob.number for blob in self._blobs], np.uint32),
                contacts=np.array([_row(blob) for blob in self._blobs], np.float32).reshape(-1, len(CONTACT_COLUMNS)),
                touch=(contact.x_m, contact.y_m, contact.force_n, contact.peak_counts, contact.area_m2)
                if contact.in_contact
                else None,
                regions=tuple(self._region_states),
            )
        return frame, samples

    def set_baseline(self, baseline: Baseline) -> None:
        """Subtract from now on what the taxels read untouched."""
        with self._lock:
            self._baseline.set(baseline.counts.ravel(), baseline.valid.ravel())

    def reset(self) -> None:
        """Forget all frames: the next one is long after or before, or of another board."""
        with self._lock:
            self._recovery.reset()
            self._tracker.reset()
            if self._regions is not None:
                self._regions.reset()
            self._samples.clear()
            self._sequence = None

    def _step(self, frame: SampleFrame, stamp_ns: int, latency_ms: float) -> None:
        if (frame.rows, frame.cols) != self._size:
            raise ArrayError(
                f"frame of {frame.rows} x {frame.cols} taxels, expected are {self._size[0]} x {self._size[1]}"
            )
        counts = self._baseline.apply(frame.indices, frame.counts)
        time_s = stamp_ns * 1e-9
        recovery = self._recovery
        self._contact = recovery.step(frame.indices, counts, time_s, frame.duration_us * 1e-6)
        self._blobs = self._tracker.step(recovery.image, time_s, recovery.sigma)
        if self._regions is not None:
            found = self._regions.step(time_s, recovery.image, recovery.measured, recovery.age_s)
            self._region_states = [RegionState(one.name, one.force_n, one.slip_m, one.slipping) for one in found]
        self._stamp_ns = stamp_ns
        if len(self._samples) < _SAMPLES_MAX:
            self._samples.append(Sample(time_s, self._contact.force_n, latency_ms, self._lost(frame.sequence)))

    def _lost(self, sequence: int) -> int:
        before, self._sequence = self._sequence, sequence
        missing = 0 if before is None else (sequence - before - 1) % _SEQUENCE_MODULUS
        # Half the range back is a board that began anew.
        return missing if missing < _SEQUENCE_MODULUS // 2 else 0


def _row(blob: TrackedBlob) -> tuple[float, ...]:
    speed_m_s = math.hypot(blob.vx_m_s, blob.vy_m_s)
    return (
        blob.x_m,
        blob.y_m,
        blob.force_n,
        blob.peak_counts,
        blob.area_m2,
        blob.spread_m,
        speed_m_s,
        blob.age_s,
    )
