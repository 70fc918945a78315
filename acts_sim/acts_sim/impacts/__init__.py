# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Balls that are dropped and thrown on a skin: flight, contact, footprint, and the frames that a board would read.

In come a ball and how it is thrown; out come full frames at a high rate, and what really happened: force, centre, time.
Edges strike as well.
"""

from acts_sim.impacts.balls import BALLS, DROP_HEIGHT_M, Ball, ball_named
from acts_sim.impacts.edges import Edge, struck
from acts_sim.impacts.scene import SCENE_RATE_HZ, Scene, footprint_n, scene
from acts_sim.impacts.throw import GRAVITY_M_S2, Collision, Throw, collide, dropped, thrown

__all__ = [
    "BALLS",
    "DROP_HEIGHT_M",
    "GRAVITY_M_S2",
    "SCENE_RATE_HZ",
    "Ball",
    "Collision",
    "Edge",
    "Scene",
    "Throw",
    "ball_named",
    "collide",
    "dropped",
    "footprint_n",
    "scene",
    "struck",
    "thrown",
]
