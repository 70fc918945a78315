# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What executables do where pip has installed their packages and ROS is missing: they say so."""

from __future__ import annotations

import sys


class Program:
    """In the place of `acts_ros.executables.program.Program`: says that ROS is missing.

    Parameters
    ----------
    module : str
        Of the node.
    """

    def __init__(self, module: str) -> None:
        self._module = module

    def __call__(self) -> int:
        """Say it and return the exit code."""
        print(
            f"error: {self._module} is a node, and ROS 2 (with the package acts_ros) is not installed here; start it "
            "in the environment of a checkout of ACTS (./acts run ...) or in a ROS 2 workspace. docs/without_ros.md "
            "says what works without",
            file=sys.stderr,
        )
        return 1
