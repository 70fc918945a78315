# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A rod with a round tip that pokes a patch of the skin in a straight line."""

from __future__ import annotations

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from acts_core.skin import Layout, SkinPatch
from acts_sim.hand import model as hand_model

SHARP_RADIUS_M = 0.0005
"""Radius of a tip of 1 mm diameter [m]."""

BLUNT_RADIUS_M = 0.008

_ROD_M = 0.04  # as in the model

LARGEST_RADIUS_M = _ROD_M / 2
"""Radius with which the rod is a ball [m]."""


class Tip:
    """Moves the tip and measures its depth in the skin.

    Attributes
    ----------
    patch : str
        Name of the patch that it is pushed into; empty without a tip.
    depth_m : float
        Depth of its end below the untouched surface of that patch [m]; negative above it, NaN without a tip.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, solid: np.void, layout: Layout, cover_m: float
    ) -> None:
        self.patch = ""
        self.depth_m = math.nan
        self._model, self._data, self._solid, self._cover_m = model, data, solid, cover_m
        self._patches = {patch.name: patch for patch in layout.patches}
        self._mocap = int(model.body_mocapid[hand_model.body_index(model, hand_model.TIP)])
        self._geom = int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, hand_model.TIP))
        self._end = np.array(hand_model.PARKED_M)
        self._along = np.array([0.0, 0.0, 1.0])
        self._speed_m_s = 0.0
        self._left_m = 0.0

    def poke(
        self,
        patch: str,
        radius_m: float,
        speed_m_s: float,
        travel_m: float,
        start_m: float = 0.005,
        row: float | None = None,
        col: float | None = None,
    ) -> None:
        """Push a tip into a patch, against the patch's present normal.

        Parameters
        ----------
        patch : str
            Name of the patch.
        radius_m : float
            Radius of the tip [m].
        speed_m_s : float
            Constant speed, independent of the force [m/s].
        travel_m : float
            Travel beyond the initial surface, after which it stops [m].
        start_m : float
            Height above the surface at which it starts [m].
        row, col : float, optional
            Position on the patch, as fractional indices of its taxels; by default its centre.
        """
        where = self._patches[patch]
        row = (where.rows - 1) / 2 if row is None else row
        col = (where.cols - 1) / 2 if col is None else col
        point, normal = self._surface(where, row, col)
        self.patch = patch
        self._along = -normal
        self._end = point + start_m * normal
        self._speed_m_s, self._left_m = speed_m_s, start_m + travel_m
        self._model.geom_size[self._geom, :2] = radius_m, (_ROD_M - 2.0 * radius_m) / 2.0
        self._model.geom_rbound[self._geom] = _ROD_M / 2.0
        self._solid["size"][:2] = radius_m + self._cover_m, _ROD_M
        self._solid["there"] = True
        self._place()

    def withdraw(self) -> None:
        """Remove the tip."""
        self.patch, self.depth_m = "", math.nan
        self._end, self._left_m = np.array(hand_model.PARKED_M), 0.0
        self._solid["there"] = False
        self._place()

    def advance(self, dt_s: float) -> None:
        """Advance by `dt_s`."""
        if not self.patch:
            return
        step_m = min(self._speed_m_s * dt_s, self._left_m)
        self._left_m -= step_m
        self._end = self._end + step_m * self._along
        self._solid["travel"] = step_m / dt_s * self._along
        self._place()

    def measure(self) -> None:
        """Update `depth_m` by the present poses of the links."""
        if self.patch:
            self.depth_m = self._depth(self._patches[self.patch])

    def _place(self) -> None:
        self._data.mocap_pos[self._mocap] = self._end
        self._data.mocap_quat[self._mocap] = _quaternion_to(self._along)

    def _surface(self, patch: SkinPatch, row: float, col: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """A position on a patch and the normal there, in the palm's frame, both shape (3,)."""
        origin, rotation = self._frame(patch)
        x_m = float(patch.geometry.x_m(col))
        y_m = float(patch.geometry.y_m(row))
        z_m, radius_m, row_radius_m = 0.0, patch.radius_m, patch.row_radius_m
        # As `SkinPatch.points_m` and `normals`, between the taxels, too.
        along = x_m / radius_m if radius_m else 0.0
        across = y_m / row_radius_m if row_radius_m else 0.0
        if radius_m:
            x_m, z_m = radius_m * math.sin(along), radius_m * (math.cos(along) - 1.0)
        if row_radius_m:
            y_m, z_m = (row_radius_m + z_m) * math.sin(across), (row_radius_m + z_m) * math.cos(across) - row_radius_m
        normal = (math.sin(along), math.cos(along) * math.sin(across), math.cos(along) * math.cos(across))
        return origin + rotation @ (x_m, y_m, z_m), rotation @ normal

    def _depth(self, patch: SkinPatch) -> float:
        origin, rotation = self._frame(patch)
        x_m, y_m, z_m = ((self._end - origin) @ rotation).tolist()
        if patch.row_radius_m:
            z_m = math.copysign(math.hypot(y_m, z_m + patch.row_radius_m), patch.row_radius_m) - patch.row_radius_m
        if not patch.radius_m:
            return float(-z_m)
        return float(patch.radius_m - math.hypot(x_m, z_m + patch.radius_m))

    def _frame(self, patch: SkinPatch) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Position and rotation of a patch, in the palm's frame."""
        body = hand_model.body_index(self._model, patch.link)
        turn = self._data.xmat[body].reshape(3, 3)
        return self._data.xpos[body] + turn @ patch.origin_m, turn @ patch.rotation


def _quaternion_to(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quaternion w, x, y, z of a rotation of the z axis to a direction."""
    x, y, z = direction.tolist()
    if z < -0.999999:
        return np.array([0.0, 1.0, 0.0, 0.0])
    quaternion = np.array([1.0 + z, -y, x, 0.0])
    return quaternion / np.linalg.norm(quaternion)
