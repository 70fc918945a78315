# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`view`: a page in the browser that shows what skins feel."""

from __future__ import annotations

from collections.abc import Sequence

from acts_core.stop_signals import StopSignals
from acts_ros.composition import run_nodes
from acts_view.nodes.view_node import ViewNode
from acts_view.settings import ViewSettings

SETTINGS: dict[str, type] = {"view": ViewSettings}
"""The settings class of the node, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the node; the exit code."""
    return run_nodes({"view": ViewNode}, SETTINGS, signals, args)
