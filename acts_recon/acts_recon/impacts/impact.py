# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What is told of a touch, at its beginning and when it is over."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

UNKNOWN_DIRECTION_SD_RAD = math.pi / math.sqrt(3)
"""Standard deviation of a direction of which nothing is known: all are equally likely."""


class Kind(IntEnum):
    """What a touch was."""

    UNKNOWN = 0
    IMPACT = 1
    TAP = 2
    PRESS = 3
    STEP = 4
    SLIDE = 5


def _nothing() -> NDArray[np.float64]:
    return np.zeros(0)


@dataclass(frozen=True, eq=False)
class Impact:
    """A touch that has begun, has joined another, or is over; positions are in the skin's frame. No number is ever NaN.

    Attributes
    ----------
    number : int
        Which touch this is, from 1; the same at its beginning and when it is over.
    is_over : bool
        False: it has just begun, or `joined` another. Then only number, onset, place and frames are known, the force
        so far and, where it has joined another, its duration.
    kind : Kind
        UNKNOWN until it is over.
    onset_s, onset_sd_s : float
        When it first touched, on the clock of the frames, and the standard deviation [s].
    duration_s : float
        How long it touched; of an impact that stayed, how long it was watched [s].
    frames : int
        Frames in which at least one of its taxels was measured pressed.
    joined : int
        0, or the number of the touch that this one has become a part of, as where a palm comes down: it goes on as that
        one, and nothing more is told of this number.
    bounced : bool
        Whether it was an impact that left the skin again.
    x_m, y_m : float
        Centre of pressure in the frame of the largest force, before it is over in the last [m].
    peak_n, peak_sd_n : float
        Largest force, and its standard deviation [N].
    impulse_n_s, impulse_sd_n_s : float
        Force over time, of at most the time that an impact lasts, and its standard deviation [N s].
    direction_rad, direction_sd_rad : float
        Which way it came, along the skin from x towards y, -pi to pi, and its standard deviation [rad]; that is
        `UNKNOWN_DIRECTION_SD_RAD` where nothing is known of it.
    velocity_m_s, velocity_sd_m_s : tuple of float
        Velocity of the footprint along x and y, mean over the touch, and the standard deviations [m/s]; both 0 where
        the direction is not known.
    time_s, force_n, path_x_m, path_y_m : np.ndarray [shape=(n,), dtype=float64]
        Force and centre of pressure over time, of at most the time that an impact lasts. Where they could be fitted to
        the samples, once a frame and at least five times, and the path is straight; else at the end of each frame.
    """

    number: int
    is_over: bool
    kind: Kind
    onset_s: float
    onset_sd_s: float
    duration_s: float
    frames: int
    x_m: float
    y_m: float
    peak_n: float
    peak_sd_n: float
    bounced: bool = False
    joined: int = 0
    impulse_n_s: float = 0.0
    impulse_sd_n_s: float = 0.0
    direction_rad: float = 0.0
    direction_sd_rad: float = UNKNOWN_DIRECTION_SD_RAD
    velocity_m_s: tuple[float, float] = (0.0, 0.0)
    velocity_sd_m_s: tuple[float, float] = (0.0, 0.0)
    time_s: NDArray[np.float64] = field(default_factory=_nothing)
    force_n: NDArray[np.float64] = field(default_factory=_nothing)
    path_x_m: NDArray[np.float64] = field(default_factory=_nothing)
    path_y_m: NDArray[np.float64] = field(default_factory=_nothing)
