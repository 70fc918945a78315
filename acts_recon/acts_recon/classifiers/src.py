# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The classifier ``src``: the paper's sparse representation-based classification of each frame's samples alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.settings import default_of, setting, validate
from acts_recon.classifiers.recogniser import ObjectRecogniser
from acts_recon.methods import Method, SkinSetup
from acts_recon.objects import Classification, Classifier, ClassifierConfig, ObjectLibrary


@dataclass(frozen=True)
class SrcConfig:
    """Settings of the classification of samples."""

    object_columns: int = setting(
        default_of(ClassifierConfig, "max_columns"),
        "topic object, per_frame: library columns that explain a frame at most; 0: a quarter as many as samples; 2 as "
        "on the board",
        minimum=0,
        maximum=1024,
    )

    def __post_init__(self) -> None:
        validate(self)


class SrcRecogniser(ObjectRecogniser):
    """See `ObjectRecogniser` and `Classifier`."""

    Config = SrcConfig

    def __init__(self, library: ObjectLibrary, config: SrcConfig, skin: SkinSetup, method: Method) -> None:
        self.library = library
        self._classifier = Classifier(
            library, ClassifierConfig(touch_counts=skin.touch_counts, max_columns=config.object_columns)
        )

    def reset(self) -> None:
        """Nothing is kept."""

    def update(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> None:
        """Nothing is kept."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> Classification:
        """See `ObjectRecogniser.step`."""
        return self._classifier.step(indices, counts)
