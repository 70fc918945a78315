# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The solids that press the skin, as arrays for the kernel: pieces of the object, and the tip."""

from __future__ import annotations

import mujoco
import numpy as np

from acts_sim.hand.kinematics import rotation_of
from acts_sim.hand.objects import HeldObject
from acts_sim.hand.skin_kernels import TIP


class Solids:
    """The pieces of an object, and last the tip; see `skin_kernels.press` for the arrays.

    Parameters
    ----------
    model : mujoco.MjModel
    thing : HeldObject or None
    thing_body, tip_body : int
        Bodies of the model.
    cover_m, unevenness_m : float
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        thing: HeldObject | None,
        thing_body: int,
        tip_body: int,
        cover_m: float,
        unevenness_m: float,
    ) -> None:
        pieces = () if thing is None else thing.pieces
        count = len(pieces) + 1
        self.root_of = np.asarray(model.body_rootid, dtype=np.int64)
        self.kind = np.array([*(piece.kind for piece in pieces), TIP])
        self.body = np.array([*([thing_body] * len(pieces)), tip_body])
        self.pos = np.array([*(piece.offset_m for piece in pieces), (0.0, 0.0, 0.0)])
        self.mat = np.array([*(rotation_of(piece.quaternion).ravel() for piece in pieces), np.eye(3).ravel()])
        self.size = np.zeros((count, 4))
        for k, piece in enumerate(pieces):
            self.size[k, : len(piece.size_m)] = piece.size_m
        self.there = np.array([*([True] * len(pieces)), False])
        self.travel = np.zeros((count, 3))
        height_m = 0.0 if thing is None else thing.unevenness * unevenness_m
        self.uneven = np.array([*([height_m] * len(pieces)), 0.0])
        self._cover_m = cover_m

    def set_tip(self, radius_m: float, length_m: float) -> None:
        """Add a tip of a radius [m] at the end of a rod of a length [m]."""
        self.size[-1, :2] = radius_m + self._cover_m, length_m
        self.there[-1] = True

    def remove_tip(self) -> None:
        """Remove the tip."""
        self.there[-1] = False
