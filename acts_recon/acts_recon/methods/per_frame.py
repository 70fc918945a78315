# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The method ``per_frame``: the paper's, each frame alone (`acts_recon.sparse`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import DictionaryError, SettingsError
from acts_core.files import path_of
from acts_core.settings import default_of, setting, validate
from acts_recon.images import require_times
from acts_recon.methods.method import Method, SkinSetup
from acts_recon.sparse import Dictionary, Reconstructor, ReconstructorConfig, load_dictionary, shipped_dictionary_path


@dataclass(frozen=True)
class PerFrameConfig:
    """Settings of recovery by patches."""

    dictionary: str = setting(
        "", "path of a dictionary file made by `acts train`, for per_frame; empty for the shipped one"
    )
    patch_step: int = setting(
        default_of(ReconstructorConfig, "patch_step"),
        "distance of neighbouring patches in taxels",
        minimum=1,
        maximum=64,
    )
    sparsity_ratio: float = setting(
        default_of(ReconstructorConfig, "sparsity_ratio"),
        "atoms per measured taxel of a patch",
        minimum=0.01,
        maximum=1.0,
    )
    keep_measured: bool = setting(True, "measured taxels keep their measured value in the image")

    def __post_init__(self) -> None:
        validate(self)


class PerFrame(Method):
    """See `Method` and `Reconstructor`; it uses no times.

    Parameters
    ----------
    skin : SkinSetup
    config : PerFrameConfig
    dictionary : Dictionary, optional
        Used in place of the file that `config` names.

    Raises
    ------
    DictionaryError
        When the dictionary cannot be used.
    ArrayError
        When it, or the layout, does not fit the array.
    """

    Config = PerFrameConfig
    summary = "from each frame alone, as in the paper, with dictionary, patch_step, sparsity_ratio and keep_measured"

    def __init__(self, skin: SkinSetup, config: PerFrameConfig, dictionary: Dictionary | None = None) -> None:
        if dictionary is None:
            given = path_of(config.dictionary, error=SettingsError) if config.dictionary else shipped_dictionary_path()
            dictionary = load_dictionary(given)
            try:
                dictionary.require_unit_atoms()
            except DictionaryError as error:
                raise DictionaryError(f"{given}: {error}") from None
        self._reconstructor = Reconstructor(
            skin.geometry,
            dictionary,
            ReconstructorConfig(
                touch_counts=skin.touch_counts,
                patch_step=config.patch_step,
                sparsity_ratio=config.sparsity_ratio,
                keep_measured=config.keep_measured,
            ),
            skin.layout,
        )
        self.image = self._reconstructor.image

    def reset(self) -> None:
        """Nothing is kept."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        require_times(end_s, duration_s)
        return self._reconstructor.recover(indices, counts)
