"""The methods that turn samples into images, by name; each behind the same small interface."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import SettingsError
from acts_recon.fusion import FusionEstimator
from acts_recon.sparse import Dictionary, Reconstructor, ReconstructorConfig
from acts_tools.evaluate.estimators.dictionaries import cosine_dictionary, haar_dictionary
from acts_tools.evaluate.estimators.interpolation import GaussianProcess, Linear


class Method(Protocol):
    """Makes an image of every frame of samples.

    How to add one: a class with these, and a line in `METHODS`.
    """

    @property
    def sigma(self) -> NDArray[np.float32] | None:
        """Standard deviation of the last image [counts], (rows, cols); None from a method that does not know."""

    def reset(self) -> None:
        """Forget everything: another recording begins."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """Take one frame of samples and return the image at its end.

        Parameters
        ----------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices in the order of measurement, and what was measured.
        end_s, duration_s : float
            When the last measurement ended, and how long all of them took [s]; they are evenly spaced.

        Returns
        -------
        np.ndarray [shape=(rows, cols), dtype=float32]
            Counts, 0 to 1023. May be overwritten by the next call.
        """


class ZeroFill:
    """What was not measured in this frame is 0."""

    sigma = None

    def __init__(self, geometry: ArrayGeometry) -> None:
        self._image = np.zeros((geometry.rows, geometry.cols), dtype=np.float32)

    def reset(self) -> None:
        """Nothing is kept."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        self._image.fill(0)
        self._image.ravel()[indices] = counts
        return self._image


class LastValue(ZeroFill):
    """Every taxel keeps what was last measured there."""

    def reset(self) -> None:
        """Forget all values."""
        self._image.fill(0)

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        self._image.ravel()[indices] = counts
        return self._image


class PerFrame:
    """The paper's method: FastOMP over patches, each frame alone."""

    sigma = None

    def __init__(self, geometry: ArrayGeometry, dictionary: Dictionary, config: ReconstructorConfig) -> None:
        self._reconstructor = Reconstructor(geometry, dictionary, config)

    def reset(self) -> None:
        """Nothing is kept."""

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        self._reconstructor.step(indices, counts)
        return self._reconstructor.image


class Fused:
    """ACTS' own: samples fused over time."""

    def __init__(self, geometry: ArrayGeometry) -> None:
        self._estimator = FusionEstimator(geometry)
        self.sigma: NDArray[np.float32] | None = self._estimator.sigma

    def reset(self) -> None:
        """Forget everything."""
        self._estimator.reset()

    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """See `Method.step`."""
        return self._estimator.step(indices, counts, end_s, duration_s)


MethodFactory = Callable[[ArrayGeometry, Dictionary, ReconstructorConfig], Method]
"""From geometry, dictionary and the settings of recovery by patches to a method."""

METHODS: dict[str, MethodFactory] = {
    "paper": PerFrame,
    "acts": lambda geometry, dictionary, config: Fused(geometry),
    "dct": lambda geometry, dictionary, config: PerFrame(geometry, cosine_dictionary(), config),
    "haar": lambda geometry, dictionary, config: PerFrame(geometry, haar_dictionary(), config),
    "zero": lambda geometry, dictionary, config: ZeroFill(geometry),
    "linear": lambda geometry, dictionary, config: Linear(geometry),
    "gp": lambda geometry, dictionary, config: GaussianProcess(geometry),
    "last": lambda geometry, dictionary, config: LastValue(geometry),
}


def method_named(name: str) -> MethodFactory:
    """Look a method up.

    Raises
    ------
    SettingsError
        Naming those that exist.
    """
    if name not in METHODS:
        raise SettingsError(f"method {name!r}: allowed is one of {', '.join(METHODS)}")
    return METHODS[name]
