"""Which object presses, frame by frame, by either of the methods that the node offers."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from acts_core.skin import Layout
from acts_recon.fusion import FusionConfig
from acts_recon.objects.classification import Classification, Classifier
from acts_recon.objects.image_classification import ImageClassifier
from acts_recon.objects.object_library import ObjectLibrary

FORGET_AFTER_S = FusionConfig().reset_after_s
"""After a gap this long nothing of earlier frames counts on, here as in the fusion."""


class ObjectRecogniser(Protocol):
    """Tells which object presses, frame after frame.

    Every frame is to be given, after its recovery, to either `update` or `step`: samples that fit the array, the end of
    the last measurement on any clock, and how long all of them took [s].
    """

    library: ObjectLibrary
    """The known objects; of the matrix, whatever the layout."""

    def reset(self) -> None:
        """Forget all frames."""

    def update(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> None:
        """Update by a frame without classifying it: fast."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> Classification:
        """Update by a frame and classify; the result's residuals are overwritten by the next."""


class PerFrameObjects:
    """The paper's SRC on the samples of each frame alone.

    Parameters
    ----------
    classifier : Classifier
    """

    def __init__(self, classifier: Classifier) -> None:
        self._classifier = classifier
        self.library = classifier.library

    def reset(self) -> None:
        """Nothing is kept."""

    def update(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> None:
        """Nothing is kept."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> Classification:
        """See `ObjectRecogniser.step`."""
        return self._classifier.step(indices, counts)


class FusedObjects:
    """The fused image against images of known objects.

    Parameters
    ----------
    classifier : ImageClassifier
    image, sigma, age_s : np.ndarray [shape=(rows, cols), dtype=float32]
        Where the fusion (`acts_recon.fusion.fusion.FusionEstimator`) leaves them after each frame.
    layout : Layout, optional
        Where the taxels of the matrix lie in them; without one they are the matrix itself.
    """

    def __init__(
        self,
        classifier: ImageClassifier,
        image: NDArray[np.float32],
        sigma: NDArray[np.float32],
        age_s: NDArray[np.float32],
        layout: Layout | None = None,
    ) -> None:
        self._classifier = classifier
        self.library = classifier.library
        self._fields = [field.ravel() for field in (image, sigma, age_s)]
        self._matrix = [image, sigma, age_s]
        self._places: NDArray[np.int64] | None = None
        if layout is not None:
            self._places = layout.places.astype(np.int64)
            shape = (layout.matrix_rows, layout.matrix_cols)
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
        if not 0 <= period_s <= FORGET_AFTER_S:
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
