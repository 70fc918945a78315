# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What a sampling scheme is: name, number on the wire, own settings, limits, and which taxels it measures."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from typing import ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from acts_core.sampling.basis.settings import CommonSettings, OwnSetting
from acts_core.sampling.basis.skin_map import SkinMap

Measure: TypeAlias = Callable[[int, int], int]
"""Measures one taxel: row and column to ADC counts."""

Samples: TypeAlias = tuple[NDArray[np.uint16], NDArray[np.uint16]]
"""Row-major taxel indices in the order of measurement, and what was measured there; (m,) each."""


class SamplingScheme(ABC):
    """Samples frame after frame; holds what goes from one to the next.

    A scheme is a subclass in a module of its own in ``acts_core/sampling/schemes``, which is all that makes it known;
    what a board is to sample by has the same in C++ (`docs/extending.md`).

    Parameters
    ----------
    config : CommonSettings
        Of a frame of this scheme; checked.
    skin_map : SkinMap
        How the taxels lie on the skin, for schemes that look for neighbours.
    """

    name: ClassVar[str]
    """By which users choose it, in lower case and with _ between words."""
    number: ClassVar[int | None] = None
    """On the wire, 1 to 255; None for one that no board has."""
    description: ClassVar[str]
    """What a frame is."""
    own_settings: ClassVar[tuple[OwnSetting, ...]] = ()
    """Their names begin with its own, for all schemes' settings are in one place; `config.own` reads them."""
    measures_all: ClassVar[bool] = False
    """Whether every frame has all taxels, whatever `m` says."""
    repeats: ClassVar[bool] = False
    """Whether a frame may have a taxel several times; with other schemes that is an error."""

    def __init__(self, config: CommonSettings, skin_map: SkinMap) -> None:
        self.config = config
        self.skin_map = skin_map

    @abstractmethod
    def frame(self, measure: Measure) -> Samples:
        """Sample one frame: `config.m` taxels, each once unless the scheme `repeats`, in any order.

        Parameters
        ----------
        measure : Measure
            To be called once for each sample, in order; `measured` does.

        Returns
        -------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices of the matrix in the order of measurement, and what was measured there.
        """

    @classmethod  # noqa: B027  (most take any)
    def check_m(cls, rows: int, cols: int, m: int) -> None:
        """Refuse frames of `m` taxels that cannot be, where that is more than ``1 <= m <= rows * cols``.

        Raises
        ------
        SettingsError
        """

    def measured(self, measure: Measure, indices: Iterable[int]) -> Samples:
        """Measure these taxels in order."""
        taxels = np.fromiter(indices, dtype=np.uint16)
        counts = [measure(*divmod(int(taxel), self.config.cols)) for taxel in taxels]
        return taxels, np.array(counts, dtype=np.uint16)
