# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`skin_contacts`: merge the contacts of all skins of a file.

One process with the node of this name and those of `skin_overview` (frames of the skins, and an aggregate of their
diagnostics).
"""

from __future__ import annotations

from collections.abc import Sequence

from acts_core.stop_signals import StopSignals
from acts_ros.composition import run_nodes
from acts_skins.contacts.node import SkinContactsNode, SkinContactsSettings
from acts_skins.overview import main as overview

SETTINGS: dict[str, type] = {**overview.SETTINGS, "skin_contacts": SkinContactsSettings}
"""The settings classes of the nodes, by name."""


def main(signals: StopSignals | None = None, args: Sequence[str] | None = None) -> int:
    """Run the nodes and return the exit code."""
    return run_nodes({**overview.NODES, "skin_contacts": SkinContactsNode}, SETTINGS, signals, args)
