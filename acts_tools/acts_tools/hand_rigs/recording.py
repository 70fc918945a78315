# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The recorded data of a run of a simulated hand. All times are CLOCK_MONOTONIC [s]."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from acts_core.skin import RegionContact
from acts_sim.hand import COLUMN, PATCH_COLUMNS, PATCHES_FROM
from acts_tools.percentiles import percentiles

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StatusSample:
    """A status of the hand.

    Attributes
    ----------
    time_s : float
    state : int
        As in acts_msgs/HandStatus.
    reason : str
    active : tuple of str
        Active reflexes.
    events : dict of str to int
        Number of times that each reflex was triggered.
    """

    time_s: float
    state: int
    reason: str
    active: tuple[str, ...]
    events: dict[str, int]


@dataclass
class HandRecording:
    """All data that are scored and drawn.

    Attributes
    ----------
    patches : tuple of str
        Names of the skin's patches, in the layout's order.
    truth_times, truth_rows : list of arrays
        The true state in pieces: times [s], and rows as in `acts_sim.hand.truth`.
    regions : list of (float, list of RegionContact)
        Time of a frame [s], and the contact on every patch; one frame in ten.
    fields : list of (float, np.ndarray [shape=(taxels,)])
        Counts of the taxels before noise, ten times a second.
    statuses : list of StatusSample
    regions_received : int
        Messages on the topic `regions`.
    durations_s, latencies_s : list of arrays
        Durations of the hand's cycles, and times from the last measurement to the goals [s].
    cpu_percent : dict of str to float
        Mean load of every process [% of one core].
    marks : list of (float, str)
        Time [s] and name of every commanded event.
    """

    patches: tuple[str, ...] = ()
    truth_times: list[Array] = field(default_factory=list)
    truth_rows: list[Array] = field(default_factory=list)
    regions: list[tuple[float, list[RegionContact]]] = field(default_factory=list)
    fields: list[tuple[float, Array]] = field(default_factory=list)
    statuses: list[StatusSample] = field(default_factory=list)
    regions_received: int = 0
    durations_s: list[NDArray[np.float32]] = field(default_factory=list)
    latencies_s: list[NDArray[np.float32]] = field(default_factory=list)
    cpu_percent: dict[str, float] = field(default_factory=dict)
    marks: list[tuple[float, str]] = field(default_factory=list)

    def timing_ms(self) -> dict[str, object]:
        """``cycle_ms`` and ``latency_ms``: median and percentiles of durations and latencies [ms]."""
        return {
            name: percentiles(1e3 * np.concatenate(pieces)) if pieces else percentiles([])
            for name, pieces in (("cycle_ms", self.durations_s), ("latency_ms", self.latencies_s))
        }

    def truth_between(self, begin_s: float = -np.inf, end_s: float = np.inf) -> tuple[Array, Array]:
        """Times and rows of the truth in an interval, both of length n."""
        if not self.truth_times:
            return np.empty(0), np.empty((0, PATCHES_FROM))
        times_s, rows = np.concatenate(self.truth_times), np.concatenate(self.truth_rows)
        inside = (times_s >= begin_s) & (times_s <= end_s)
        return times_s[inside], rows[inside]


def column(rows: Array, name: str) -> Array:
    """A quantity of rows of truth, see `acts_sim.hand.truth.COLUMN`; shape (n,) for a single number."""
    values = rows[:, COLUMN[name]]
    return values[:, 0] if values.shape[1] == 1 else values


def patch_column(rows: Array, name: str) -> Array:
    """A quantity of every patch, see `acts_sim.hand.truth.PATCH_COLUMNS`; shape (n, patches)."""
    return rows[:, PATCHES_FROM + PATCH_COLUMNS.index(name) :: len(PATCH_COLUMNS)]
