# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What to do about a package that a ROS installation lacks, because rosdep does not know it."""

from __future__ import annotations

_FROM_PIP = ("mujoco", "rosbags", "websockets")
"""Modules of requirements-ros.txt; what needs ur_rtde says so by itself."""


def advice_about(error: ImportError) -> str:
    """What to install, or nothing where that is not known.

    A package that is there, but too old, lacks a module or a name in it.
    """
    package = (error.name or "").partition(".")[0]
    if package not in _FROM_PIP:
        return ""
    return f"{error.name} is not installed, or too old: pip install -r requirements-ros.txt (README.md, On ROS 2)"
