# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The hand's skin: foam over 13 patches, and the forces on its 1024 taxels."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from acts_core.settings import setting, validate
from acts_core.skin import ForceResponse, Layout, SkinPatch
from acts_sim.hand.kinematics import SKIN_THICKNESS_M
from acts_sim.hand.model import body_index
from acts_sim.hand.skin_kernels import BLOCK, FOAM, PATCH_RESULTS, POINT, press
from acts_sim.hand.solid_kernels import NEAR, PATCH, WAVES, Bodies

# Largest distance between points of the foam along the side of a taxel.
_POINT_SPACING_M = 0.0018

# The force on a point acts on its own taxel and the neighbours.
_NEIGHBOURS = (-1, 0, 1)


@dataclass(frozen=True)
class SkinConfig:
    """The foam and the taxels under it.

    The default is a foam of 3 mm with a Young's modulus of 75 kPa, under a cover of 1 mm that rounds off sharper
    shapes.
    """

    foam_stiffness_n_per_m3: float = setting(2.5e7, "pressure of the foam per depth [N/m^3]", minimum=1e6, maximum=1e9)
    foam_spread_m: float = setting(
        0.0010, "standard deviation of the sideways spread of pressure in the foam [m]", minimum=1e-4, maximum=0.01
    )
    foam_damping_s_m: float = setting(
        8.0, "damping: relative increase of the force per speed of indentation [s/m]", minimum=0.0, maximum=100.0
    )
    foam_shear_share: float = setting(
        0.5, "shear stiffness of the foam, relative to foam_stiffness_n_per_m3", minimum=0.05, maximum=2.0
    )
    cover_m: float = setting(
        0.0010, "shapes sharper than this radius are rounded to it by the cover [m]", minimum=1e-4, maximum=0.002
    )
    friction: float = setting(0.6, "coefficient of friction between skin and object", minimum=0.05, maximum=3.0)
    gain_spread: float = setting(0.05, "standard deviation of the taxels' sensitivities", minimum=0.0, maximum=0.5)
    unevenness_m: float = setting(
        0.00015, "unevenness of objects: height of their bumps [m]", minimum=0.0, maximum=0.001
    )
    unevenness_wavelength_m: float = setting(0.010, "wavelength of the bumps [m]", minimum=0.004, maximum=0.1)

    def __post_init__(self) -> None:
        validate(self)


class Skin:
    """Foam and taxels on the links of a MuJoCo model.

    Parameters
    ----------
    model : mujoco.MjModel
        With a body for each link of the layout.
    layout : Layout
    solids : np.ndarray [shape=(solids,), dtype=SOLID]
        The pieces of the object and the tip; their waves are drawn here.
    config : SkinConfig
    rng : np.random.Generator
        Source of the random sensitivities and unevenness.

    Attributes
    ----------
    forces_n : np.ndarray [shape=(taxels,), dtype=float64]
        Force on every taxel in the order of the matrix [N]; their sum is the normal force on the skin.
    results : np.ndarray [shape=(patches, 4), dtype=float64]
        Results of `skin_kernels.press` for each patch.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        layout: Layout,
        solids: NDArray[np.void],
        config: SkinConfig,
        rng: np.random.Generator,
    ) -> None:
        taxels = layout.matrix_rows * layout.matrix_cols
        self.forces_n = np.zeros(taxels)
        self.results = np.zeros((len(layout.patches), PATCH_RESULTS))
        self._response = ForceResponse()
        self._gain = np.maximum(1.0 + config.gain_spread * rng.standard_normal(taxels), 0.1)
        self._counts = np.zeros(taxels)
        self._solids = solids
        self._root_of = np.asarray(model.body_rootid, dtype=np.int64)
        parts = [_points_of(patch, layout, config) for patch in layout.patches]
        self._points = np.concatenate(parts)
        self._patches = np.zeros(len(parts), PATCH)
        self._patches["body"] = [body_index(model, patch.link) for patch in layout.patches]
        self._patches["middle"], self._patches["reach"] = _spheres(parts)
        taxels_of = [patch.rows * patch.cols for patch in layout.patches]
        self._patches["first"], self._patches["end"] = _ends(taxels_of)
        blocks = [block for part, count in zip(parts, taxels_of, strict=True) for block in np.split(part, count)]
        self._blocks = np.zeros(len(blocks), BLOCK)
        self._blocks["middle"], self._blocks["reach"] = _spheres(blocks)
        self._blocks["first"], self._blocks["end"] = _ends([len(block) for block in blocks])
        self._foam = np.zeros(1, FOAM)
        self._foam["stiffness_n_per_m3"] = config.foam_stiffness_n_per_m3
        self._foam["dense_depth_m"] = 2.0 / 3.0 * SKIN_THICKNESS_M
        self._foam["dense_factor"] = 5.0
        self._foam["damping_s_m"] = config.foam_damping_s_m
        self._foam["shear_n_per_m3"] = config.foam_shear_share * config.foam_stiffness_n_per_m3
        self._foam["shear_damping_s"] = 0.005
        self._foam["friction"] = config.friction
        self._foam["cover_m"] = config.cover_m
        self._near = np.zeros((len(parts), len(solids)), NEAR)
        _draw_waves(solids, config, rng)

    def press(self, data: mujoco.MjData, dt_s: float) -> None:
        """Compute the contact for the poses in `data`; adds the forces of the skin to ``data.xfrc_applied``."""
        bodies = Bodies(
            pos=data.xpos,
            mat=data.xmat,
            velocity=data.cvel,
            centre=data.xipos,
            root_centre=data.subtree_com,
            root_of=self._root_of,
            wrench=data.xfrc_applied,
        )
        press(
            *bodies,
            self._patches,
            self._blocks,
            self._points,
            self._foam,
            self._solids,
            self._near,
            dt_s,
            self.forces_n,
            self.results,
        )

    def counts(self) -> NDArray[np.float64]:
        """Counts of the taxels before noise and rounding; shape (taxels,), overwritten by the next call."""
        # As `ForceResponse.counts`, but in place. The order of the operations decides about the last digit.
        response = self._response
        above = np.multiply(self.forces_n, self._gain, out=self._counts)
        above -= response.dead_n
        np.maximum(above, 0.0, out=above)
        np.divide(above, above + response.half_n, out=above)
        above *= response.full_scale_counts
        return above


def _draw_waves(solids: NDArray[np.void], config: SkinConfig, rng: np.random.Generator) -> None:
    """Fill the waves of solids with plane waves of the object's unevenness, in the frame of each."""
    direction = rng.standard_normal((WAVES, 3))
    direction /= config.unevenness_wavelength_m * np.linalg.norm(direction, axis=1, keepdims=True)
    phase = rng.uniform(0.0, 1.0, WAVES)
    for solid in solids:
        solid["wave"][:, :3] = direction @ np.ascontiguousarray(solid["mat"])
        solid["wave"][:, 3] = phase + direction @ np.ascontiguousarray(solid["pos"])


def _spheres(groups: Sequence[NDArray[np.void]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centres of groups of points [shape=(groups, 3)], and the radii about them that hold all [shape=(groups,)]."""
    positions = [np.ascontiguousarray(group["pos"]) for group in groups]
    middles = [position.mean(axis=0) for position in positions]
    reach = [
        np.linalg.norm(position - middle, axis=1).max() for position, middle in zip(positions, middles, strict=True)
    ]
    return np.array(middles), np.array(reach)


def _ends(lengths: Sequence[int]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Where parts of such lengths, one behind the other, begin and end."""
    ends = np.cumsum(np.array(lengths, dtype=np.int64))
    return ends - lengths, ends


def _points_of(patch: SkinPatch, layout: Layout, config: SkinConfig) -> NDArray[np.void]:
    across = math.ceil(patch.pitch_m / _POINT_SPACING_M)
    down = math.ceil(patch.row_pitch_m / _POINT_SPACING_M)
    fine = replace(
        patch,
        first_row=0,
        end_row=patch.rows * down,
        first_col=0,
        end_col=patch.cols * across,
        pitch_m=patch.pitch_m / across,
        row_pitch_m=patch.row_pitch_m / down,
    )

    def by_taxel(fine_grid: NDArray[Any]) -> NDArray[Any]:
        """Reorder values of the fine grid's points by taxel."""
        whole = fine_grid.reshape(patch.rows, down, patch.cols, across, -1)
        return np.ascontiguousarray(whole.swapaxes(1, 2)).reshape(fine.rows * fine.cols, -1)

    normal = by_taxel(fine.normals())
    pos = by_taxel(fine.points_m()) - config.cover_m * normal
    col, col_share = _spreading(patch.cols, across, patch.pitch_m, config.foam_spread_m)
    row, row_share = _spreading(patch.rows, down, patch.row_pitch_m, config.foam_spread_m)
    matrix = patch.of(layout.taxels).astype(np.int64)
    # For every point of the fine grid: three rows by three columns of taxels.
    taxel = matrix[row[:, None, :, None], col[None, :, None, :]]
    share = row_share[:, None, :, None] * col_share[None, :, None, :]
    points = np.zeros(len(pos), POINT)
    points["pos"], points["normal"], points["area"] = pos, normal, fine.geometry.taxel_area_m2
    points["taxel"], points["share"] = by_taxel(taxel), by_taxel(share)
    return points


def _spreading(
    taxels: int, points: int, pitch_m: float, spread_m: float
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Along one side: the three taxels on which each point acts, and their shares of its force, with sum 1.

    Parameters
    ----------
    taxels : int
        Number of taxels in the patch.
    points : int
        Number of points in a taxel.
    pitch_m, spread_m : float

    Returns
    -------
    index : np.ndarray [shape=(taxels * points, 3), dtype=int64]
    share : np.ndarray [shape=(taxels * points, 3), dtype=float64]
    """
    position = (np.arange(taxels * points) + 0.5) / points - 0.5
    index = np.floor(position + 0.5).astype(np.int64)[:, None] + np.array(_NEIGHBOURS)
    width = math.sqrt(2.0) * spread_m / pitch_m
    edges = index - position[:, None]
    share = np.vectorize(lambda a: math.erf((a + 0.5) / width) - math.erf((a - 0.5) / width))(edges) / 2.0
    share[(index < 0) | (index >= taxels)] = 0.0
    return np.clip(index, 0, taxels - 1), share / share.sum(axis=1, keepdims=True)
