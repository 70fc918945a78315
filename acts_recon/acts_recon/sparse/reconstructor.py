# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""From the samples of one frame to the full image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, TOUCH_COUNTS, ArrayGeometry
from acts_core.settings import setting, validate
from acts_core.skin import Layout
from acts_recon.images import PlacedSamples, borders_of
from acts_recon.sparse import fastomp_kernels as kernels
from acts_recon.sparse.dictionary import Dictionary
from acts_recon.sparse.fastomp import SPARSITY_RATIO
from acts_recon.sparse.fastomp_model import PatchModel, workspace
from acts_recon.sparse.patches import patch_layout


@dataclass(frozen=True)
class ReconstructorConfig:
    """Settings of the recovery; the defaults are the paper's ("Sparse Recovery and Tactile Reconstruction")."""

    touch_counts: int = setting(
        TOUCH_COUNTS, "counts above which a taxel is pressed; others are 0", minimum=0, maximum=COUNT_MAX
    )
    patch_step: int = setting(4, "distance of neighbouring patches in taxels", minimum=1, maximum=64)
    sparsity_ratio: float = setting(SPARSITY_RATIO, "atoms per measured taxel of a patch", minimum=0.01, maximum=1.0)
    keep_measured: bool = setting(True, "measured taxels keep their measured value in the image")

    def __post_init__(self) -> None:
        validate(self)


class Reconstructor:
    """Recovers frame after frame without allocating; everything is checked and compiled before the first one.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the picture; without a layout that is the matrix itself.
    dictionary : Dictionary
    config : ReconstructorConfig
    layout : Layout, optional
        Where the taxels of the matrix lie in the picture. `recover` takes matrix indices; patches are laid over the
        picture, where neighbours are neighbours, and over none of its borders; `image` is the picture's.

    Raises
    ------
    ArrayError
        When the dictionary's patches do not fit the array, or the layout is of another size.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        dictionary: Dictionary,
        config: ReconstructorConfig | None = None,
        layout: Layout | None = None,
    ) -> None:
        self.geometry = geometry
        self.config = config or ReconstructorConfig()
        self._samples = PlacedSamples(geometry, layout)
        borders = borders_of(geometry.rows, geometry.cols, layout)
        patches = patch_layout(
            geometry.rows, geometry.cols, size=dictionary.patch_size, step=self.config.patch_step, borders=borders
        )
        self._model = PatchModel.of(patches, dictionary.atoms)
        self._workspace = workspace(patches, self.config.sparsity_ratio)
        self._flat = np.zeros(geometry.size, dtype=np.float32)
        self.image: NDArray[np.float32] = self._flat.reshape(geometry.rows, geometry.cols)
        """The image of the last frame [counts, 0 to 1023]; np.ndarray [shape=(rows, cols), dtype=float32].

        Overwritten by the next frame: copy what is to be kept.
        """
        self._warm_up()

    def recover(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> NDArray[np.float32]:
        """Recover one frame into `image`, and return that.

        Parameters
        ----------
        indices : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices of the matrix, none twice; at least one.
        counts : np.ndarray [shape=(m,), dtype=uint16]
            What was measured there, 0 to 1023.

        Raises
        ------
        ArrayError
            When the frame does not fit the array or holds impossible values. `image` then is still the previous one.
        """
        config = self.config
        kernels.recover_image(
            self._model,
            *self._samples.of(indices, counts),
            config.touch_counts,
            COUNT_MAX,
            config.sparsity_ratio,
            config.keep_measured,
            self._workspace,
            self._flat,
        )
        return self.image

    def _warm_up(self) -> None:
        """Compile, or load from the cache, what the first frame would otherwise wait seconds for."""
        everything = np.arange(self.geometry.size, dtype=np.uint16)
        self.recover(everything[:1], np.full(1, COUNT_MAX, dtype=np.uint16))
        self.recover(everything[:1], np.zeros(1, dtype=np.uint16))
