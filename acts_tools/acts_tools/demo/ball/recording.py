# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The recorded data of a run of the ball-balancing demo."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass
class Track:
    """A path over time, built sample by sample.

    Attributes
    ----------
    time_s : list of float
        ROS time of every sample [s].
    x_m, y_m : list of float
        Position in the skin's plane [m].
    """

    time_s: list[float] = field(default_factory=list)
    x_m: list[float] = field(default_factory=list)
    y_m: list[float] = field(default_factory=list)

    def add(self, time_s: float, x_m: float, y_m: float) -> None:
        """Append one sample, unless it is not newer than the last: interpolation needs increasing times."""
        if not self.time_s or time_s > self.time_s[-1]:
            self.time_s.append(time_s)
            self.x_m.append(x_m)
            self.y_m.append(y_m)

    def at(self, time_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Positions at other times, linearly interpolated; shape (n, 2) [m]."""
        return np.column_stack([np.interp(time_s, self.time_s, self.x_m), np.interp(time_s, self.time_s, self.y_m)])


@dataclass
class Recording:
    """All data that the demo scores and draws.

    Attributes
    ----------
    truth : Track
        True position of the simulated ball.
    reference : Track
        Reference position, only while the control loop was closed.
    segments : list of str
        Name of the reference's segment, one per sample of `reference`.
    tilt_time_s, tilt_commanded_rad, tilt_measured_rad : lists
        Tilt about the skin's x and y axes.
    latencies_s : list of arrays
        Time from the last measurement of a frame to the reception of its contact by the control node's process.
    touch_age_s : list of float
        Age of the newest contact when a control step used it, 50 times a second.
    contacts_received, contacts_lost : int
        Counts of the control node.
    contact_rate_hz : float
        Contacts received per second over the run.
    frames_lost : int
        Frames missing between board and driver, counted by the driver.
    crc_errors : int
        Damaged packets, counted by the driver.
    segment_pressure : dict of str to np.ndarray [shape=(rows, cols), dtype=float64]
        Sum of the tactile images of each segment [ADC counts].
    cpu_percent : dict of str to float
        Mean load of every process [% of one core].
    stop_reason : str
        Reason why the controller stopped; empty if it did not.
    finished : bool
        Whether the reference reached its end.
    has_fallen : bool
        Whether the ball fell off the plate.
    """

    truth: Track = field(default_factory=Track)
    reference: Track = field(default_factory=Track)
    segments: list[str] = field(default_factory=list)
    tilt_time_s: list[float] = field(default_factory=list)
    tilt_commanded_rad: list[tuple[float, float]] = field(default_factory=list)
    tilt_measured_rad: list[tuple[float, float]] = field(default_factory=list)
    latencies_s: list[NDArray[np.float32]] = field(default_factory=list)
    touch_age_s: list[float] = field(default_factory=list)
    contacts_received: int = 0
    contacts_lost: int = 0
    contact_rate_hz: float = 0.0
    frames_lost: int = 0
    crc_errors: int = 0
    segment_pressure: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    cpu_percent: dict[str, float] = field(default_factory=dict)
    stop_reason: str = ""
    finished: bool = False
    has_fallen: bool = False
