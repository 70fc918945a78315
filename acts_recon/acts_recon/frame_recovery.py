# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the node reconstruction makes of the frames of one skin, for programs without that node."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ArrayError
from acts_core.frames import SampleFrame
from acts_core.runtime import SequenceNumbers
from acts_core.skin import RegionContact
from acts_recon.contacts import BlobTracker, Contact, TrackedBlob
from acts_recon.images import BaselineSubtraction, check_untouched
from acts_recon.settings import ReconstructionConfig


class FrameRecovery:
    """Recovers frame after frame: image, contacts, regions; everything is compiled when the constructor is through.

    Parameters
    ----------
    settings : ReconstructionConfig
        Size, layout and method, as the node's parameters.

    Attributes
    ----------
    recovery : Recovery
        With the image of the newest frame.
    frame : SampleFrame or None
        The newest, with each taxel once, and counts less the baseline; the next one overwrites them.
    contact : Contact
        All that presses, as one.
    blobs : sequence of TrackedBlob
        The contacts one by one.
    regions : sequence of RegionContact
        Of a skin of several patches, or of one on a link.

    Raises
    ------
    ArrayError, SettingsError
        As of `ReconstructionConfig.recovery`.
    """

    def __init__(self, settings: ReconstructionConfig) -> None:
        self._size = (settings.rows, settings.cols)
        self.recovery = settings.recovery()
        self._regions = settings.regions(self.recovery)
        self._tracker = BlobTracker(
            self.recovery.geometry, self.recovery.response, settings.blob_config(), self.recovery.borders
        )
        self._baseline = BaselineSubtraction(settings.rows * settings.cols)
        self._numbers = SequenceNumbers()
        self.frame: SampleFrame | None = None
        self.contact = Contact()
        self.blobs: Sequence[TrackedBlob] = ()
        self.regions: Sequence[RegionContact] = ()

    def set_baseline(
        self, counts: NDArray[np.float32], noise_counts: NDArray[np.float32], valid: NDArray[np.bool_]
    ) -> None:
        """Use from now on what the taxels read untouched; see `BaselineSubtraction.set` and `Method.set_noise`.

        Raises
        ------
        ArrayError
            One of the two cannot be; nothing is changed then.
        """
        check_untouched("noise", noise_counts, valid, self._size[0] * self._size[1])
        self._baseline.set(counts, valid)
        self.recovery.set_noise(noise_counts, valid)

    def reset(self) -> None:
        """Forget all frames: the next one is long after or before, or of another board."""
        self._forget()
        self._numbers = SequenceNumbers()

    def step(self, frame: SampleFrame, stamp_ns: int) -> int:
        """Recover one frame. A board that counts from the start again is another board.

        Parameters
        ----------
        frame : SampleFrame
        stamp_ns : int
            Time of its last measurement [ns].

        Returns
        -------
        int
            Frames that are missing between the last one and this.

        Raises
        ------
        ArrayError
            The frame is of another size, or its samples are not of this matrix.
        """
        if (frame.rows, frame.cols) != self._size:
            raise ArrayError(
                f"frame of {frame.rows} x {frame.cols} taxels, expected are {self._size[0]} x {self._size[1]}"
            )
        if self._numbers.goes_back(frame.sequence):
            self._forget()
        lost = self._numbers.step(frame.sequence)
        frame = frame._replace(counts=self._baseline.apply(frame.indices, frame.counts)).once()
        time_s = stamp_ns * 1e-9
        recovery = self.recovery
        self.contact = recovery.step(frame.indices, frame.counts, time_s, frame.duration_us * 1e-6)
        self.blobs = self._tracker.step(recovery.image, time_s, recovery.sigma)
        if self._regions is not None:
            self.regions = self._regions.step(time_s, recovery.image, recovery.measured, recovery.age_s)
        self.frame = frame
        return lost

    def _forget(self) -> None:
        self.recovery.reset()
        self._tracker.reset()
        if self._regions is not None:
            self._regions.reset()
