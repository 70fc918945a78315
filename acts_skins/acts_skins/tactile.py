# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`tactile`: driver and reconstruction of one skin in one process, which pass frames in memory.

The thread that reads a frame from the port also computes its contact, without another thread, executor or middleware
in between. The message `samples` is published only while it has subscribers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from acts_core.kernels import skip_extras
from acts_core.stop_signals import StopSignals
from acts_core.wire import StreamDecoder
from acts_driver.nodes.driver_node import DriverNode
from acts_driver.settings import DriverSettings
from acts_recon.frame_recovery import FrameRecovery
from acts_recon.nodes.reconstruction_node import ReconstructionNode
from acts_recon.settings import ReconstructionSettings
from acts_ros.composition import run_nodes

SETTINGS: dict[str, type] = {"driver": DriverSettings, "reconstruction": ReconstructionSettings}
"""The settings classes of the nodes, by name."""


def prepare() -> None:
    """Load what is compiled of driver and reconstruction, as with their default settings."""
    skip_extras()
    FrameRecovery(ReconstructionSettings())
    StreamDecoder()


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run both nodes and return the exit code."""
    skip_extras()
    reconstructions: list[ReconstructionNode] = []

    def make_reconstruction(**given: Any) -> ReconstructionNode:
        reconstructions.append(ReconstructionNode(subscribes=False, **given))
        return reconstructions[0]

    def make_driver(**given: Any) -> DriverNode:
        driver = DriverNode(**given)
        driver.consumers.append(reconstructions[0].take)
        return driver

    # The driver last, so that it is destroyed first: its frames end before the node that processes them.
    return run_nodes({"reconstruction": make_reconstruction, "driver": make_driver}, SETTINGS, signals, args)
