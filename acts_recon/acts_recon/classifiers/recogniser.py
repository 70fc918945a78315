# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a classifier of frames is given, and what it answers with."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from acts_recon.methods import Method, NoSettings, SkinSetup
from acts_recon.objects import Classification, ObjectLibrary


class ObjectRecogniser(ABC):
    """Tells which object presses, frame after frame.

    Every frame is to be given, after its recovery, to either `update` or `step`.

    Parameters
    ----------
    library : ObjectLibrary
        The known objects; of the matrix, whatever the layout.
    config : Config
    skin : SkinSetup
    method : Method
        Has recovered each frame before: `image`, `sigma` and `age_s` are of the picture.
    """

    Config: ClassVar[type] = NoSettings
    """Dataclass of `acts_core.settings.setting` fields. All become parameters of one node: their names are its own."""
    is_uncertainty_needed: ClassVar[bool] = False
    """Whether it needs a method that knows `sigma` and `age_s`."""

    library: ObjectLibrary
    """The known objects."""

    @abstractmethod
    def __init__(self, library: ObjectLibrary, config: Any, skin: SkinSetup, method: Method) -> None: ...

    @abstractmethod
    def reset(self) -> None:
        """Forget all frames."""

    @abstractmethod
    def update(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float) -> None:
        """Update by a frame without classifying it: fast. The parameters are those of `step`."""

    @abstractmethod
    def step(
        self, indices: NDArray[np.uint16], counts: NDArray[np.uint16], end_s: float, duration_s: float
    ) -> Classification:
        """Update by a frame and classify it.

        Parameters
        ----------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Samples that fit the array, as `Method.step` has taken them.
        end_s, duration_s : float
            When the last measurement ended, on any clock, and how long all of them took [s].

        Returns
        -------
        Classification
            Its `residuals` are overwritten by the next frame: copy what is to be kept.
        """
