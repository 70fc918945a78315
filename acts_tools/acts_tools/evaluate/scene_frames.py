# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the published board measures of a simulated scene, frame by frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_core.sampling import MEASUREMENT_US, SCHEMES, SamplingConfig, SkinMap
from acts_tools.firmware.board_sampler import sampler_of

FOLLOW_COUNTS = 15
"""Threshold above which tracking follows a taxel, just above the noise of a reading (docs/recovery.md)."""

DETECTOR_TOUCH_COUNTS = 25
"""A taxel above is pressed, for our detectors: eight times the noise of a reading."""


@dataclass(frozen=True)
class Frame:
    """What one frame has measured.

    Attributes
    ----------
    end_s, duration_s : float
        When its last measurement ended on the scene's clock, and how long all took [s].
    indices, counts : np.ndarray [shape=(m,), dtype=uint16]
        Overwritten by the next frame.
    """

    end_s: float
    duration_s: float
    indices: NDArray[np.uint16]
    counts: NDArray[np.uint16]


def frame_rate_hz(m: int) -> float:
    """Frames a second of a board that measures `m` taxels in each."""
    return 1e6 / (m * MEASUREMENT_US)


def frames_of(
    frames: NDArray[np.uint16],
    rate_hz: float,
    scheme: str,
    m: int,
    threshold_counts: int,
    noise_counts: float,
    seed: int,
    skin_map: SkinMap | None = None,
    **own: Any,
) -> Iterator[Frame]:
    """Sample a scene as fast as a board measures; one frame follows the other at once.

    Parameters
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts, without noise.
    rate_hz : float
        Of `frames`; between them what is sampled is interpolated linearly.
    scheme : str
    m : int
        Taxels per frame; all with a scheme that measures all.
    threshold_counts : int
        Of the scheme.
    noise_counts : float
        Of a reading.
    seed : int
        Of sampling and noise.
    skin_map : SkinMap, optional
        How the taxels lie on the skin; without it, as in the matrix.
    **own
        The scheme's own settings.
    """
    m = frames[0].size if SCHEMES[scheme].measures_all else m
    rows, cols = frames.shape[1:]
    config = SamplingConfig(
        scheme=scheme, rows=rows, cols=cols, m=m, threshold_counts=threshold_counts, seed=seed, **own
    )
    sampler = sampler_of(config, noise_counts, skin_map)
    sample_s = 1e-6 * MEASUREMENT_US
    duration_s = m * sample_s
    for number in range(int((len(frames) - 1) / rate_hz / duration_s)):
        begin_s = number * duration_s
        indices, counts = sampler.frame(frames, begin_s * rate_hz, sample_s * rate_hz)
        yield Frame(begin_s + duration_s, duration_s, indices, counts)
