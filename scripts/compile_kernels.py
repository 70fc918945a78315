# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Compiles the kernels that most nodes need, while linters run: else tests side by side would each compile them."""

from __future__ import annotations

from acts_core.wire import StreamDecoder
from acts_driver.baseline import BaselineTracker
from acts_recon.contacts import BlobTracker
from acts_recon.settings import ReconstructionSettings
from acts_sim.ball import World, WorldConfig
from acts_sim.hand import HandWorld, HandWorldConfig


def main() -> None:
    World(WorldConfig())
    HandWorld(HandWorldConfig())
    StreamDecoder()
    BaselineTracker(32, 32)
    for settings in (
        ReconstructionSettings(),
        ReconstructionSettings(method="per_frame"),
        ReconstructionSettings(layout="leap_right"),
    ):
        recovery = settings.recovery()
        settings.regions(recovery)
        BlobTracker(recovery.geometry, recovery.response, settings.blob_config(), recovery.borders)


if __name__ == "__main__":
    main()
