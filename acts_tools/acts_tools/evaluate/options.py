# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Command-line options that several evaluations share."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from acts_tools.arguments import at_least_one, random_seed, real, simulated_taxels


def add_scene_arguments(parser: argparse.ArgumentParser, seeds: int, what: str) -> None:
    """Add options of evaluations on simulated scenes; `seeds` of them by default, of which `what` tells the kind."""
    parser.add_argument(
        "--noise-counts",
        # More is refused by the reconstruction, but later.
        type=real(0, 100),
        default=3.0,
        metavar="X",
        help="noise of a reading (default: %(default)s)",
    )
    add_seeds(parser, seeds, what)


def add_seeds(parser: argparse.ArgumentParser, seeds: int, what: str) -> None:
    """Add what all have that repeat something random: how often, from which seed on, and a file of the results."""
    parser.add_argument("--seeds", type=at_least_one, default=seeds, metavar="N", help=f"{what} (default: %(default)s)")
    add_seed_and_json(parser)


def add_seed_and_json(parser: argparse.ArgumentParser) -> None:
    """Add the seed, and a file of the results."""
    parser.add_argument(
        "--seed", type=random_seed, default=1, metavar="X", help="of everything random (default: %(default)s)"
    )
    add_json(parser)


def add_json(parser: argparse.ArgumentParser) -> None:
    """Add a file of the results."""
    parser.add_argument("--json", type=Path, metavar="OUT", help="also write the results to a JSON file")


def add_m(parser: argparse.ArgumentParser, default: Sequence[int]) -> None:
    """Add ``--m``, one or several."""
    parser.add_argument(
        "--m",
        type=simulated_taxels,
        nargs="+",
        default=list(default),
        help=f"taxels per frame (default: {' '.join(map(str, default))})",
    )
