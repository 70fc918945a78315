# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts doctor`: check this machine."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from acts_core.errors import ActsError
from acts_tools.doctor.machine import Machine
from acts_tools.doctor.report import examine
from acts_tools.output_file import write_json

_EPILOG = """\
examples:
  acts doctor                  before the first start
  acts doctor --realtime       before realtime_priority:=40

levels:
  ok      good
  ?       unknown, for example in a container
  note    1 kHz works, but single frames may be late
  lacks   1 kHz does not work, or real time does not where --realtime asks for it

It changes nothing; commands that correct a finding are printed below it. The exit code is 1 if something is lacking,
and 0 if there are only notes. docs/real_time.md explains what real time needs.
"""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add ``doctor`` to the acts command."""
    parser = subparsers.add_parser(
        "doctor",
        help="check this machine, and say how to correct what is wrong",
        description="Check whether this machine is ready for 1 kHz, and for real time.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--realtime", action="store_true", help="also require what realtime_priority needs")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the report as JSON")
    parser.add_argument(
        "--root", type=Path, default=Path("/"), metavar="FOLDER", help="a folder in place of / (default: /)"
    )


def run(arguments: argparse.Namespace) -> int:
    """Check and report; return 1 if something is lacking."""
    if not arguments.root.is_dir():
        raise ActsError(f"--root {arguments.root}: is no folder")
    diagnosis = examine(Machine(root=arguments.root), realtime=arguments.realtime)
    print(diagnosis.text(coloured=sys.stdout.isatty() and "NO_COLOR" not in os.environ))
    write_json(arguments.json, diagnosis.as_json())
    return 0 if diagnosis.is_well else 1
