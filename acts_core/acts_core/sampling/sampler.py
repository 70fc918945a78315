# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Samples as a board does.

The firmware (``acts_firmware``, C++) does this on the board. This is its reference: the same taxels in the same order,
readable, and usable where there is no board. A test compares the two on random and on recorded fields.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from acts_core.errors import ArrayError
from acts_core.sampling.basis import CommonSettings, Measure, OwnSetting, Samples, SkinMap, with_fields
from acts_core.sampling.registry import OWN_SETTINGS, SCHEMES, check_sampling, frame_size
from acts_core.settings import setting

MEASUREMENT_US = 17.877
"""Time of one measurement on the paper's board (55,936 samples per second) [us]."""


def _quota(own: OwnSetting) -> property:
    return property(lambda config: config.own(own), doc=own.description)


# The schemes' own settings, and the numbers of taxels that are given as shares.
_Own: Any = with_fields(
    "_Own",
    {own.parameter: own.as_parameter() for own in OWN_SETTINGS},
    **{own.name: _quota(own) for own in OWN_SETTINGS if own.share},
)


@dataclass(frozen=True)
class SamplingConfig(_Own, CommonSettings):  # type: ignore[misc]
    """What a board is told about sampling; every scheme's own settings are among it, by their names."""

    scheme: str = setting("adaptive", "how the taxels of a frame are chosen", choices=tuple(SCHEMES))

    def __post_init__(self) -> None:
        check_sampling(self.scheme, self)

    @property
    def frame_size(self) -> int:
        """Taxels that a frame holds."""
        return frame_size(self.scheme, self.rows, self.cols, self.m)


class Sampler:
    """Samples frame after frame.

    Parameters
    ----------
    config : SamplingConfig
    skin_map : SkinMap, optional
        How the taxels lie on the skin, for the schemes that look for neighbours; without it, as in the matrix.
    """

    def __init__(self, config: SamplingConfig, skin_map: SkinMap | None = None) -> None:
        self.config = config
        skin_map = skin_map or SkinMap.of_matrix(config.rows, config.cols)
        if len(skin_map.taxels) != config.rows * config.cols:
            raise ArrayError(
                f"map of {len(skin_map.taxels)} taxels: the matrix is {config.rows} x {config.cols}; give one of that"
            )
        self._scheme = SCHEMES[config.scheme](config, skin_map)

    def frame(self, measure: Measure) -> Samples:
        """Sample one frame.

        Parameters
        ----------
        measure : Measure
            Called once for each taxel measured, in order.

        Returns
        -------
        indices, counts : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices in the order of measurement, and what was measured there. None is there twice,
            unless the scheme `repeats`.
        """
        return self._scheme.frame(measure)


def measure_in(field: ArrayLike) -> Measure:
    """Measure in a still field.

    Parameters
    ----------
    field : array_like [shape=(rows, cols), dtype=any integer]
        ADC counts of every taxel.

    Raises
    ------
    ArrayError
        For any other shape or type; from what is returned, for a taxel beyond the field.
    """
    image = np.asarray(field)
    if image.ndim != 2 or image.dtype.kind not in "iu":
        raise ArrayError(f"field of shape {image.shape} and type {image.dtype}: a field is (rows, cols) whole counts")
    values = image.tolist()

    def measure(row: int, col: int) -> int:
        try:
            return int(values[row][col])
        except IndexError:
            raise ArrayError(
                f"taxel in row {row}, column {col} of a field of {image.shape[0]} x {image.shape[1]}: give a field as "
                "large as the array"
            ) from None

    return measure
