# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated LEAP hand, the object in it, and its skin.

In come goals of motors and commands; out come angles, currents, counts of 1024 taxels, and the truth for evaluation.
The world depends on no clock and no process: the same seed gives the same bits.
"""

from acts_sim.hand.commands import carry_out
from acts_sim.hand.kinematics import PALM, SOLIDS, frames, rotation_of
from acts_sim.hand.objects import HeldObject, Piece, held_object
from acts_sim.hand.solid_kernels import BOX, CAPSULE, CYLINDER
from acts_sim.hand.tip import BLUNT_RADIUS_M, LARGEST_RADIUS_M, SHARP_RADIUS_M
from acts_sim.hand.truth import COLUMN, PATCH_COLUMNS, PATCHES_FROM, HandTruth, PatchTruth, TruthFollower, row_width
from acts_sim.hand.world import STEP_S, HandWorld, HandWorldConfig

__all__ = [
    "BLUNT_RADIUS_M",
    "BOX",
    "CAPSULE",
    "COLUMN",
    "CYLINDER",
    "LARGEST_RADIUS_M",
    "PALM",
    "PATCHES_FROM",
    "PATCH_COLUMNS",
    "SHARP_RADIUS_M",
    "SOLIDS",
    "STEP_S",
    "HandTruth",
    "HandWorld",
    "HandWorldConfig",
    "HeldObject",
    "PatchTruth",
    "Piece",
    "TruthFollower",
    "carry_out",
    "frames",
    "held_object",
    "rotation_of",
    "row_width",
]
