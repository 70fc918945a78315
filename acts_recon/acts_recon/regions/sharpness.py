# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Whether what presses a patch is a tip or blunt: the likelihoods of both, compared.

The taxels about the most pressed one are compared with what they would feel of a tip, and of something blunt with the
same force, each wherever within the taxel it fits best. What is blunt spreads over more taxels the harder it presses;
as long as both would look alike, the sharpness is about 0. It says how much likelier a tip is, as a logarithm: 3 stands
for a factor of 20. What fits neither counts as no tip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_core.skin import SkinPatch
from acts_recon.images import DeadTaxels
from acts_recon.regions import sharpness_kernels as kernels

_DEPTHS_M = np.geomspace(1e-4, 3e-3, 16)


@dataclass(frozen=True)
class SharpnessConfig:
    """What a tip and something blunt feel like through the foam over the taxels."""

    sharpness_tip_radius_m: float = setting(
        0.0015,
        "radius of a tip, and of how the cover of the skin rounds it off [m]",
        minimum=1e-4,
        maximum=0.01,
    )
    sharpness_blunt_radius_m: float = setting(
        0.008, "radius from which on the end of something is blunt [m]", minimum=1e-3, maximum=0.1
    )
    sharpness_foam_n_per_m3: float = setting(
        2.5e7,
        "pressure of the foam over the taxels per depth [N/m^3]; if in doubt take more: then less is sharp",
        minimum=1e5,
        maximum=1e10,
    )
    sharpness_spread_m: float = setting(
        0.001, "standard deviation of how the foam spreads pressure sideways [m]", minimum=1e-5, maximum=0.02
    )
    sharpness_gain_error: float = setting(
        0.1, "how much the sensitivities of taxels differ, relative to their mean", minimum=0.01, maximum=1.0
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.sharpness_tip_radius_m >= self.sharpness_blunt_radius_m:
            raise SettingsError(
                f"sharpness_tip_radius_m = {self.sharpness_tip_radius_m:g}: allowed is below sharpness_blunt_radius_m "
                f"({self.sharpness_blunt_radius_m:g})"
            )


class Sharpness:
    """Tells the sharpness of the contact on each patch.

    Parameters
    ----------
    patches : sequence of SkinPatch
    force_n : np.ndarray [shape=(1025,), dtype=float64]
        The table of `acts_core.skin.force_table`.
    touch_counts : float
        A taxel above it is pressed.
    noise_counts : float
        Standard deviation of a measurement [counts].
    config : SharpnessConfig
    dead : DeadTaxels, optional
        Those of the image: what is estimated is as smooth as something blunt, and says nothing here.
    """

    def __init__(
        self,
        patches: tuple[SkinPatch, ...],
        force_n: NDArray[np.float64],
        touch_counts: float,
        noise_counts: float,
        config: SharpnessConfig,
        dead: DeadTaxels | None = None,
    ) -> None:
        self._bounds = np.array([patch.bounds for patch in patches], dtype=np.int64).reshape(-1, 4)
        self._force_n = force_n
        self._touch_counts, self._noise_counts = touch_counts, noise_counts
        shape = self._bounds[:, [1, 3]].max(axis=0, initial=0).tolist()
        self._is_dead = np.zeros(shape, dtype=np.bool_) if dead is None else dead.in_picture
        self._gain_error = config.sharpness_gain_error
        # Patches that are alike share their tables.
        kinds = [(patch.row_pitch_m, patch.pitch_m, patch.row_radius_m, patch.radius_m) for patch in patches]
        skins = sorted(set(kinds))
        self._skin_of = np.array([skins.index(kind) for kind in kinds], dtype=np.int64)
        self._level_force_n = np.zeros((len(skins), 2, len(_DEPTHS_M)))
        self._share = np.zeros(
            (*self._level_force_n.shape, *(kernels.PLACES,) * 2, *(kernels.WINDOW,) * 2), dtype=np.float32
        )
        for k, (row_pitch_m, pitch_m, row_radius_m, radius_m) in enumerate(skins):
            for shape, end_m in enumerate((config.sharpness_tip_radius_m, config.sharpness_blunt_radius_m)):
                kernels.footprints(
                    np.array([row_pitch_m, pitch_m]),
                    np.array([1.0 / bend_m if bend_m else 0.0 for bend_m in (row_radius_m, radius_m)]),
                    end_m,
                    config.sharpness_foam_n_per_m3,
                    config.sharpness_spread_m,
                    _DEPTHS_M,
                    self._level_force_n[k, shape],
                    self._share[k, shape],
                )
        about = [(i, j) for i in range(kernels.WINDOW) for j in range(kernels.WINDOW)]
        about.sort(key=lambda at: (at[0] - kernels.REACH) ** 2 + (at[1] - kernels.REACH) ** 2)
        self._order = np.array(about[1:], dtype=np.int64)
        self._found = np.zeros(len(patches))

    def of(self, image: NDArray[np.float32]) -> NDArray[np.float64]:
        """Of every patch; shape (patches,), overwritten by the next call. `image` is as of `Regions.step`."""
        kernels.find_sharpness(
            image,
            self._bounds,
            self._skin_of,
            self._level_force_n,
            self._share,
            self._order,
            self._touch_counts,
            self._noise_counts,
            self._gain_error,
            self._force_n,
            self._is_dead,
            self._found,
        )
        return self._found
