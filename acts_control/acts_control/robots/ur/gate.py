# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The last look at the arm's joint angles before they are sent."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

from acts_control.robots.ur.config import UrConfig
from acts_core.robots import ur5e

# The four joints that do not tilt stay where they are.
_FIXED_RAD = 1e-6


class JointGate:
    """Lets through six finite angles near the level pose, each near the one before.

    Parameters
    ----------
    config : UrConfig
        With the level pose, from which the first command counts.
    """

    def __init__(self, config: UrConfig) -> None:
        self._config = config
        self._last = tuple(config.level_q_rad)

    def fault(self, q_rad: Sequence[float]) -> str:
        """Why a command must not be sent, in words; empty when it may, and it then counts as sent."""
        config = self._config
        if len(q_rad) != ur5e.JOINTS:
            return f"command of {len(q_rad)} joints"
        for joint, (angle, level, last) in enumerate(zip(q_rad, config.level_q_rad, self._last, strict=True)):
            if not isfinite(angle):
                return f"command for joint {joint} is {angle}"
            allowed = config.max_wrist_offset_rad if joint in (ur5e.WRIST_1, ur5e.WRIST_2) else _FIXED_RAD
            if abs(angle - level) > allowed:
                return (
                    f"command for joint {joint} is {angle - level:+.4f} rad off the level pose, allowed is {allowed:g}"
                )
            if abs(angle - last) > config.max_joint_step_rad:
                return (
                    f"command for joint {joint} jumps by {angle - last:+.4f} rad, "
                    f"allowed is {config.max_joint_step_rad:g}"
                )
        self._last = tuple(q_rad)
        return ""
