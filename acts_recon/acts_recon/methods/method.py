# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a method of recovery is told of the skin, and what it answers with."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from acts_core.array import TOUCH_COUNTS, ArrayGeometry
from acts_core.skin import ForceResponse, Layout, Response
from acts_recon.fusion import FusionConfig
from acts_recon.images import NOISE_COUNTS, PlacedSamples


@dataclass(frozen=True)
class SkinSetup:
    """What every method may know of the skin.

    Attributes
    ----------
    geometry : ArrayGeometry
        Of the picture; without a layout that is the matrix itself.
    layout : Layout or None
        Where the taxels of the matrix lie in the picture.
    response : Response
        From counts to newtons.
    touch_counts : int
        A taxel above it is pressed.
    noise_counts : float
        Standard deviation of a reading about the truth [counts]; 0: not known.
    dead_taxels : np.ndarray [shape=(matrix rows, matrix cols), dtype=bool] or None
        Which taxels of the matrix are broken: their samples are left out. None: none.
    """

    geometry: ArrayGeometry
    layout: Layout | None = None
    response: Response = field(default_factory=ForceResponse)
    touch_counts: int = TOUCH_COUNTS
    noise_counts: float = FusionConfig().noise_counts
    dead_taxels: NDArray[np.bool_] | None = None

    @property
    def assumed_noise_counts(self) -> float:
        """`noise_counts`, or what is assumed where that is not known [counts]."""
        return self.noise_counts or NOISE_COUNTS

    def placed_samples(self) -> PlacedSamples:
        """What checks frames and tells where in the picture their samples lie."""
        return PlacedSamples(self.geometry, self.layout)


@dataclass(frozen=True)
class NoSettings:
    """Of a method that has none of its own."""


class Method(ABC):
    """Makes an image of every frame of samples.

    Parameters
    ----------
    skin : SkinSetup
    config : Config

    Attributes
    ----------
    image : np.ndarray [shape=(rows, cols), dtype=float32]
        Of the last frame [counts, 0 to 1023]; C-contiguous, and the same array all along, overwritten by the next, as
        are the others.
    sigma : np.ndarray [shape=(rows, cols), dtype=float32] or None
        Standard deviation of `image` [counts]; None from a method that does not know.
    age_s : np.ndarray [shape=(rows, cols), dtype=float32] or None
        Time since each taxel was measured [s], inf: never; likewise.
    measured : np.ndarray [shape=(rows, cols), dtype=float32] or None
        What was measured then [counts]; likewise.
    """

    Config: ClassVar[type] = NoSettings
    """Dataclass of `acts_core.settings.setting` fields. All become parameters of one node: their names are its own."""
    summary: ClassVar[str]
    """What it does, as part of a sentence for a person."""
    is_uncertainty_known: ClassVar[bool] = False
    """Whether it has `sigma` and `age_s`."""

    image: NDArray[np.float32]
    sigma: NDArray[np.float32] | None = None
    age_s: NDArray[np.float32] | None = None
    measured: NDArray[np.float32] | None = None

    @abstractmethod
    def __init__(self, skin: SkinSetup, config: Any) -> None: ...

    @abstractmethod
    def reset(self) -> None:
        """Forget all frames: the next one is not of the same board, or long after."""

    @abstractmethod
    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> NDArray[np.float32]:
        """Take one frame of samples and return `image`, as it is at its end.

        Nobody has checked the frame: `SkinSetup.placed_samples` does, and turns `indices` into places in `image`;
        `acts_recon.images.require_times` checks the times.

        Parameters
        ----------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices of the matrix in the order of measurement, and what was measured, less the baseline.
        end_s, duration_s : float
            When the last measurement ended, on any clock, and how long all of them took [s]; they are evenly spaced.

        Raises
        ------
        ArrayError
            When the frame does not fit the array or holds impossible values. Everything is left as it was.
        """

    def set_noise(self, noise_counts: NDArray[np.float32], valid: NDArray[np.bool_]) -> None:  # noqa: B027
        """Take over the calibrated noise of every taxel, as `FusionEstimator.set_noise`; by default it is not used."""

    def confidence(self) -> NDArray[np.uint8] | None:
        """0 to 255 of every taxel, as `FusionEstimator.confidence`; None from a method that does not know."""
        return None
