# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate`: the evaluations, each a module with ``add_parser(commands)``."""

from __future__ import annotations

import argparse
from typing import Any

from acts_tools.evaluate.classification import classification_command
from acts_tools.evaluate.gait import gait_command
from acts_tools.evaluate.hand import hand_command
from acts_tools.evaluate.images import events_command, objects_command, recovery_command
from acts_tools.evaluate.impacts import edges_command, impacts_command, ricochet_command
from acts_tools.evaluate.outlines import outlines_command
from acts_tools.evaluate.public import convert_command
from acts_tools.evaluate.slip import slip_command, slip_sampled_command
from acts_tools.evaluate.spectra import spectra_command
from acts_tools.evaluate.wearables import wearables_command

_EPILOG = """\
examples:
  acts evaluate recovery --presses 30 --scheme adaptive tracking --m 55 128
  acts evaluate slip --frames FILE.npz --pitch-m 0.0034
  acts evaluate impacts --seeds 1 --m 64 --recordings scenes

`acts evaluate WHAT --help` explains one of them.
"""


def add_parser(subparsers: Any) -> None:
    """Add ``acts evaluate`` to the acts command."""
    parser = subparsers.add_parser(
        "evaluate",
        help="score what is made of touch, recorded or simulated",
        description="Sample recorded or simulated touch like the board, and score images, objects, slip, impacts, "
        "outlines, spectra, gait or reflexes. docs/recovery.md explains the numbers of images and objects; the others "
        "have pages of their own.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    commands = parser.add_subparsers(title="what to evaluate", metavar="WHAT", required=True)
    for module in (
        recovery_command,
        events_command,
        objects_command,
        classification_command,
        slip_command,
        hand_command,
        slip_sampled_command,
        impacts_command,
        ricochet_command,
        edges_command,
        spectra_command,
        outlines_command,
        gait_command,
        wearables_command,
        convert_command,
    ):
        module.add_parser(commands)


def run(arguments: argparse.Namespace) -> int:
    """Run the chosen evaluation and return the exit code."""
    return int(arguments.evaluate(arguments))
