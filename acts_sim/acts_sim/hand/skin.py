# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The hand's skin: foam over 13 patches, and the forces on its 1024 taxels."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from acts_core.settings import setting, validate
from acts_core.skin import ForceResponse, Layout, SkinPatch
from acts_sim.hand.kinematics import SKIN_THICKNESS_M
from acts_sim.hand.skin_kernels import PATCH_RESULTS, WAVES, press
from acts_sim.hand.solids import Solids

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
    solids : Solids
        The pieces of the object and the tip.
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
        solids: Solids,
        config: SkinConfig,
        rng: np.random.Generator,
        response: ForceResponse | None = None,
    ) -> None:
        taxels = layout.matrix_rows * layout.matrix_cols
        self.forces_n = np.zeros(taxels)
        self.results = np.zeros((len(layout.patches), PATCH_RESULTS))
        self._response = response or ForceResponse()
        self._gain = np.maximum(1.0 + config.gain_spread * rng.standard_normal(taxels), 0.1)
        self._counts = np.zeros(taxels)
        self._solids = solids
        parts = [_foam_of(patch, layout, config) for patch in layout.patches]
        self._patch_body = np.array([_body(model, patch.link) for patch in layout.patches])
        middles = np.array([part.point_m.mean(axis=0) for part in parts])
        self._patch_middle = middles
        self._patch_reach = np.array(
            [np.linalg.norm(part.point_m - middle, axis=1).max() for part, middle in zip(parts, middles, strict=True)]
        )
        self._patch_first = np.cumsum([0, *(patch.rows * patch.cols for patch in layout.patches)])
        blocks = [
            block
            for part, patch in zip(parts, layout.patches, strict=True)
            for block in np.split(part.point_m, patch.rows * patch.cols)
        ]
        self._block_first = np.cumsum([0, *(len(block) for block in blocks)])
        self._block_middle = np.array([block.mean(axis=0) for block in blocks])
        self._block_reach = np.array([np.linalg.norm(block - block.mean(axis=0), axis=1).max() for block in blocks])
        self._point = np.concatenate([part.point_m for part in parts])
        self._normal = np.concatenate([part.normal for part in parts])
        self._area = np.concatenate([part.area_m2 for part in parts])
        self._taxel = np.concatenate([part.taxel for part in parts])
        self._share = np.concatenate([part.share for part in parts])
        self._bristle = np.zeros((len(self._point), 3))
        self._block_touched = np.zeros(len(blocks), dtype=np.bool_)
        self._foam = np.array(
            [
                config.foam_stiffness_n_per_m3,
                2.0 / 3.0 * SKIN_THICKNESS_M,
                5.0,  # densified foam
                config.foam_damping_s_m,
                config.foam_shear_share * config.foam_stiffness_n_per_m3,
                0.005,  # damping of the shear [s]
                config.friction,
                config.cover_m,
            ]
        )
        self._wave = _waves(solids, config, rng)

    def press(self, data: mujoco.MjData, dt_s: float) -> None:
        """Compute the contact for the poses in `data`; adds the forces of the skin to ``data.xfrc_applied``."""
        solids = self._solids
        press(
            data.xpos,
            data.xmat,
            data.cvel,
            data.xipos,
            data.subtree_com,
            solids.root_of,
            self._patch_body,
            self._patch_middle,
            self._patch_reach,
            self._patch_first,
            self._block_first,
            self._block_middle,
            self._block_reach,
            self._point,
            self._normal,
            self._area,
            self._taxel,
            self._share,
            self._bristle,
            self._block_touched,
            self._foam,
            solids.kind,
            solids.body,
            solids.pos,
            solids.mat,
            solids.size,
            solids.there,
            solids.travel,
            solids.uneven,
            self._wave,
            dt_s,
            self.forces_n,
            self.results,
            data.xfrc_applied,
        )

    def counts(self) -> NDArray[np.float64]:
        """Counts of the taxels before noise and rounding; shape (taxels,), overwritten by the next call."""
        response = self._response
        above = np.multiply(self.forces_n, self._gain, out=self._counts)
        above -= response.dead_n
        np.maximum(above, 0.0, out=above)
        np.divide(above, above + response.half_n, out=above)
        above *= response.full_scale_counts
        return above


def _waves(solids: Solids, config: SkinConfig, rng: np.random.Generator) -> NDArray[np.float64]:
    """Plane waves of the object's unevenness in the frame of each solid; see `skin_kernels.press`."""
    direction = rng.standard_normal((WAVES, 3))
    direction /= config.unevenness_wavelength_m * np.linalg.norm(direction, axis=1, keepdims=True)
    phase = rng.uniform(0.0, 1.0, WAVES)
    waves = np.empty((len(solids.kind), WAVES, 4))
    for k, (offset, mat) in enumerate(zip(solids.pos, solids.mat, strict=True)):
        waves[k, :, :3] = direction @ mat.reshape(3, 3)
        waves[k, :, 3] = phase + direction @ offset
    return waves


@dataclass(frozen=True)
class _Foam:
    """Points of the foam of one patch, ordered by taxel; see `skin_kernels.press`."""

    point_m: NDArray[np.float64]
    normal: NDArray[np.float64]
    area_m2: NDArray[np.float64]
    taxel: NDArray[np.int64]
    share: NDArray[np.float64]


def _foam_of(patch: SkinPatch, layout: Layout, config: SkinConfig) -> _Foam:
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
    point_m = by_taxel(fine.points_m()) - config.cover_m * normal
    col, col_share = _spreading(patch.cols, across, patch.pitch_m, config.foam_spread_m)
    row, row_share = _spreading(patch.rows, down, patch.row_pitch_m, config.foam_spread_m)
    matrix = patch.of(layout.taxels).astype(np.int64)
    # For every point of the fine grid: three rows by three columns of taxels.
    taxel = matrix[row[:, None, :, None], col[None, :, None, :]]
    share = row_share[:, None, :, None] * col_share[None, :, None, :]
    area_m2 = np.full(len(point_m), fine.geometry.taxel_area_m2)
    return _Foam(point_m, normal, area_m2, by_taxel(taxel), by_taxel(share))


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


def _body(model: mujoco.MjModel, name: str) -> int:
    return int(mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, name))
