# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated plate with its ball, from the robot's joints to the board's taxels.

In come joint angles; out come the counts of every taxel and the ball's true position. The physics depends on no clock
and no process.
"""

from acts_sim.ball.ball_plate import JointMotion
from acts_sim.ball.world import Phase, World, WorldConfig

__all__ = ["JointMotion", "Phase", "World", "WorldConfig"]
