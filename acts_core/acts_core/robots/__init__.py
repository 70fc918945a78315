# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kinematics of robots, one module each, for those that move a robot and those that simulate it.

In come joint positions or a tilt of the plate; out come poses, tilts and joint positions.
"""

from acts_core.robots import ur5e

__all__ = ["ur5e"]
