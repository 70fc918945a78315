# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the node reconstruction makes of the frames of one skin, for programs without that node."""

from __future__ import annotations

from collections.abc import Sequence

from acts_core.frames import SampleFrame
from acts_core.skin import RegionContact
from acts_recon.contacts import BlobTracker, TrackedBlob
from acts_recon.frame_pipeline import FramePipeline
from acts_recon.settings import ReconstructionConfig


class FrameRecovery(FramePipeline):
    """Recovers frame after frame: image, contacts, regions; everything is compiled when the constructor is through.

    Parameters
    ----------
    settings : ReconstructionConfig
        Size, layout and method, as the node's parameters.

    Attributes
    ----------
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
        super().__init__(settings, self._forget_contacts)
        recovery = self.recovery
        self._regions = settings.regions(recovery)
        self._tracker = BlobTracker(recovery.geometry, recovery.response, settings.blob_config(), recovery.borders)
        self.blobs: Sequence[TrackedBlob] = ()
        self.regions: Sequence[RegionContact] = ()

    def step(self, frame: SampleFrame, stamp_ns: int) -> int:
        """See `FramePipeline.step`."""
        lost = super().step(frame, stamp_ns)
        time_s, recovery = stamp_ns * 1e-9, self.recovery
        self.blobs = self._tracker.step(recovery.image, time_s, recovery.sigma)
        if self._regions is not None:
            self.regions = self._regions.step(time_s, recovery.image, recovery.measured, recovery.age_s)
        return lost

    def _forget_contacts(self) -> None:
        self._tracker.reset()
        if self._regions is not None:
            self._regions.reset()
