"""From samples to image and contact, by either of the methods that the node offers."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.skin import ForceResponse, MeasuredForceResponse
from acts_recon.contacts import Contact, ContactFinder
from acts_recon.fusion import FusionEstimator
from acts_recon.images import Borders
from acts_recon.sparse import Reconstructor

METHODS = ("fusion", "per_frame")
"""``fusion``: all samples so far (`FusionEstimator`); ``per_frame``: each frame alone (`Reconstructor`)."""


class Recovery(Protocol):
    """Recovers frame after frame."""

    geometry: ArrayGeometry
    """Of the image."""
    borders: Borders
    """Likewise."""
    response: ForceResponse | MeasuredForceResponse
    """From counts to newtons."""
    image: NDArray[np.float32]
    """Image of the last frame [counts], (rows, cols); overwritten by the next."""
    sigma: NDArray[np.float32] | None
    """Standard deviation of the image [counts], likewise; None from a method that does not know."""
    age_s: NDArray[np.float32] | None
    """Time since each taxel was measured [s], inf: never; likewise."""
    measured: NDArray[np.float32] | None
    """What was measured then [counts]; likewise."""

    def reset(self) -> None:
        """Forget all frames: the next one is not of the same board, or long after."""

    def step(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> Contact:
        """Recover one frame; parameters and errors as of `FusionEstimator.step`."""

    def confidence(self) -> NDArray[np.uint8] | None:
        """0 to 255 of every taxel, as `FusionEstimator.confidence`; None from a method that does not know."""


class FusedRecovery:
    """Samples fused over time, and the contact in the image.

    Parameters
    ----------
    estimator : FusionEstimator
    response : ForceResponse or MeasuredForceResponse
        From counts to newtons.
    touch_counts : float
        A taxel above it is pressed.
    """

    def __init__(
        self, estimator: FusionEstimator, response: ForceResponse | MeasuredForceResponse, touch_counts: float
    ) -> None:
        self._estimator = estimator
        self._finder = ContactFinder(
            estimator.geometry, response, touch_counts, estimator.config.noise_counts, borders=estimator.borders
        )
        self.geometry = estimator.geometry
        self.borders = estimator.borders
        self.response = response
        self.image = estimator.image
        self._flat = estimator.image.ravel(), estimator.sigma.ravel()
        self.sigma: NDArray[np.float32] | None = estimator.sigma
        self.age_s: NDArray[np.float32] | None = estimator.age_s
        self.measured: NDArray[np.float32] | None = estimator.measured

    def reset(self) -> None:
        """See `Recovery.reset`."""
        self._estimator.reset()

    def step(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> Contact:
        """See `Recovery.step`."""
        self._estimator.step(indices, counts, end_s, duration_s)
        return self._finder.find(*self._flat)

    def confidence(self) -> NDArray[np.uint8] | None:
        """See `Recovery.confidence`."""
        return self._estimator.confidence()


class PerFrameRecovery:
    """The paper's method; it needs no times.

    Parameters
    ----------
    reconstructor : Reconstructor
    """

    def __init__(self, reconstructor: Reconstructor) -> None:
        self._reconstructor = reconstructor
        self.geometry = reconstructor.geometry
        self.borders = reconstructor.borders
        self.response = reconstructor.response
        self.image = reconstructor.image
        self.sigma: NDArray[np.float32] | None = None
        self.age_s: NDArray[np.float32] | None = None
        self.measured: NDArray[np.float32] | None = None

    def reset(self) -> None:
        """Nothing is kept."""

    def step(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> Contact:
        """See `Recovery.step`."""
        return self._reconstructor.step(indices, counts)

    def confidence(self) -> NDArray[np.uint8] | None:
        """Unknown."""
        return None
