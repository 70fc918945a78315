# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The classifier ``fused_image``: the fused image, as far as it is known, against images of known objects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.settings import default_of, setting, validate
from acts_recon.classifiers.recogniser import ObjectRecogniser
from acts_recon.images import LONGEST_PAUSE_S
from acts_recon.methods import Method, SkinSetup
from acts_recon.objects import Classification, ImageClassifier, ImageClassifierConfig, ObjectLibrary


@dataclass(frozen=True)
class FusedImageConfig:
    """Settings of the classification of fused images."""

    object_touch_counts: int = setting(
        default_of(ImageClassifierConfig, "touch_counts"),
        "topic object, fusion: counts above which a taxel is pressed, as when the library was made; per_frame takes "
        "touch_counts",
        minimum=0,
        maximum=COUNT_MAX,
    )
    object_src_weight: float = setting(
        default_of(ImageClassifierConfig, "src_weight"),
        "topic object, fusion: weight of SRC on a resting image against the comparison of images; 0: none",
        minimum=0.0,
        maximum=100.0,
    )

    def __post_init__(self) -> None:
        validate(self)


class FusedImageRecogniser(ObjectRecogniser):
    """See `ObjectRecogniser` and `ImageClassifier`.

    Parameters
    ----------
    library, config, skin, method
        See `ObjectRecogniser`; the method knows how sure it is.
    classifier : ImageClassifierConfig, optional
        Used in place of what `config` says.
    """

    Config = FusedImageConfig
    is_uncertainty_needed = True

    def __init__(
        self,
        library: ObjectLibrary,
        config: FusedImageConfig,
        skin: SkinSetup,
        method: Method,
        classifier: ImageClassifierConfig | None = None,
    ) -> None:
        if classifier is None:
            classifier = ImageClassifierConfig(
                touch_counts=config.object_touch_counts, src_weight=config.object_src_weight
            )
        self.library = library
        self._classifier = ImageClassifier(library, classifier, skin.response)
        assert method.sigma is not None
        assert method.age_s is not None
        self._matrix = [method.image, method.sigma, method.age_s]
        self._fields = [field.ravel() for field in self._matrix]
        self._places: NDArray[np.int64] | None = None
        if skin.layout is not None:
            self._places = skin.layout.places.astype(np.int64)
            shape = (skin.layout.matrix_rows, skin.layout.matrix_cols)
            self._matrix = [np.zeros(shape, dtype=np.float32) for _ in self._fields]
        self._end_s: float | None = None

    def reset(self) -> None:
        """See `ObjectRecogniser.reset`."""
        self._classifier.reset()
        self._end_s = None

    def update(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> None:
        """See `ObjectRecogniser.update`."""
        period_s = self._period_s(end_s, duration_s)
        image, sigma, age_s = self._of_the_matrix()
        self._classifier.update(image, sigma, age_s, period_s)

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> Classification:
        """See `ObjectRecogniser.step`."""
        period_s = self._period_s(end_s, duration_s)
        image, sigma, age_s = self._of_the_matrix()
        return self._classifier.step(image, sigma, age_s, period_s)

    def _period_s(self, end_s: float, duration_s: float) -> float:
        """Time since the last frame; a gap, or a clock that goes back, begins anew."""
        period_s = duration_s if self._end_s is None else end_s - self._end_s
        if not 0 <= period_s <= LONGEST_PAUSE_S:
            self.reset()
            period_s = duration_s
        self._end_s = end_s
        return period_s

    def _of_the_matrix(self) -> list[NDArray[np.float32]]:
        if self._places is not None:
            for field, matrix in zip(self._fields, self._matrix, strict=True):
                # "clip" writes right into `out`; all places are in range.
                np.take(field, self._places, out=matrix.ravel(), mode="clip")
        return self._matrix
