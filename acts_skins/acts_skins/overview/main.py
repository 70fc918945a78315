# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`skin_overview`: publish the frames of the skins of a file, and an aggregate of their diagnostics.

One process with the nodes `skin_frames` and `skin_diagnostics`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence

from rclpy.node import Node
from rclpy.parameter import Parameter

from acts_core.stop_signals import StopSignals
from acts_ros.composition import parameters_from
from acts_ros.executor import run
from acts_skins.overview.diagnostics_node import SkinDiagnosticsNode, SkinDiagnosticsSettings
from acts_skins.overview.frames_node import SkinFramesNode, SkinFramesSettings

SETTINGS: dict[str, type] = {"skin_frames": SkinFramesSettings, "skin_diagnostics": SkinDiagnosticsSettings}
"""The settings classes of the nodes, by name."""


def factories(given: Mapping[str, list[Parameter]]) -> list[Callable[[], Node]]:
    """Functions that make the two nodes with their parameters."""
    return [
        lambda: SkinFramesNode(parameter_overrides=given["skin_frames"]),
        lambda: SkinDiagnosticsNode(parameter_overrides=given["skin_diagnostics"]),
    ]


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run both nodes and return the exit code."""
    words = list(sys.argv if args is None else args)
    return run(factories(parameters_from(words, SETTINGS)), words, signals)
