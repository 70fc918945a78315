# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The options of `acts bench skins`."""

from __future__ import annotations

import argparse
from dataclasses import dataclass

from acts_core.errors import ActsError
from acts_tools.arguments import whole

NAME = "skins"
SUMMARY = "1 to 16 skins at 1 kHz, M = 55, to a subscriber of their contacts"
SECONDS = 60.0
"""Default duration [s]."""


@dataclass(frozen=True)
class SkinsOptions:
    """Numbers of skins and busy loops, and their scheduling.

    Attributes
    ----------
    skins : int
        Number of skins.
    load : int
        Number of processes with busy loops.
    realtime : bool
        Whether boards, skins and subscriber run under SCHED_FIFO; the load never does.
    """

    skins: int
    load: int
    realtime: bool

    @property
    def names(self) -> list[str]:
        """The skins' names, which are their namespaces."""
        return [f"skin_{number}" for number in range(1, self.skins + 1)]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options in a group of their own. Options that are not given are None."""
    group = parser.add_argument_group(f"options of {NAME}, which is measured by itself")
    group.add_argument("--skins", type=whole(1, 16), metavar="N", help="number of skins (default: 1)")
    group.add_argument(
        "--load", type=whole(0, 64), metavar="L", help="number of processes with busy loops (default: 0)"
    )
    group.add_argument(
        "--realtime", choices=("on", "off"), help="run boards, skins and subscriber in real time (default: off)"
    )


def is_chosen(arguments: argparse.Namespace) -> bool:
    """Whether the command line selects this measurement.

    Raises
    ------
    ActsError
        When it also selects another measurement, or has options of this one without selecting it.
    """
    if NAME in arguments.names:
        others = [name for name in dict.fromkeys(arguments.names) if name != NAME]
        if others:
            raise ActsError(f"{NAME} is measured by itself; leave out {', '.join(others)}")
        return True
    for name in ("skins", "load", "realtime"):
        if getattr(arguments, name) is not None:
            raise ActsError(f"--{name} is an option of `acts bench {NAME}` only")
    return False


def options_from(arguments: argparse.Namespace) -> SkinsOptions:
    """Options from a command line."""
    return SkinsOptions(arguments.skins or 1, arguments.load or 0, arguments.realtime == "on")
