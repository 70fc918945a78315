# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`skin_overview`: publish the frames of the skins of a file, and an aggregate of their diagnostics.

One process with the nodes `skin_frames` and `skin_diagnostics`.
"""

from __future__ import annotations

from collections.abc import Sequence

from rclpy.node import Node

from acts_core.stop_signals import StopSignals
from acts_ros.composition import run_nodes
from acts_skins.overview.diagnostics_node import SkinDiagnosticsNode, SkinDiagnosticsSettings
from acts_skins.overview.frames_node import SkinFramesNode, SkinFramesSettings

SETTINGS: dict[str, type] = {"skin_frames": SkinFramesSettings, "skin_diagnostics": SkinDiagnosticsSettings}
"""The settings classes of the nodes, by name."""

NODES: dict[str, type[Node]] = {"skin_frames": SkinFramesNode, "skin_diagnostics": SkinDiagnosticsNode}
"""The nodes themselves."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run both nodes and return the exit code."""
    return run_nodes(NODES, SETTINGS, signals, args)
