# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The arm's joints at any time, interpolated from the ring that the simulated robot writes."""

from __future__ import annotations

import math
from enum import Enum
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError
from acts_sim.ball.ball_plate import JointMotion
from acts_sim.shared import JOINT_RING_WIDTH, TimedRingReader

_RETRY_NS = 100_000_000
# A ring whose newest slot is older than this is stale.
_STALE_AFTER_NS = 100_000_000
# A robot that misses a few of its 2 ms cycles is extrapolated; one that is silent for longer has stopped.
_LONGEST_EXTRAPOLATION_NS = 20_000_000
# Two slots further apart than this give no acceleration.
_LONGEST_SLOT_NS = 50_000_000
_ACCELERATION_LAG_S = 0.004
# A UR5e reaches about 40 rad/s^2; larger values come from a jump of the velocity, not from a motion.
_LARGEST_ACCELERATION_RAD_S2 = 200.0


class JointSource(Enum):
    """Present source of the joints."""

    NONE = "there is no robot"
    MISSING = "there is no joint ring"
    STALE = "the robot has stopped writing its joints"
    FOLLOWED = "following the robot"


class JointFollower:
    """Reads the joint ring, interpolates and extrapolates, and retries while the ring is missing.

    Parameters
    ----------
    path : Path or None
        The ring; None where there is no robot.

    Attributes
    ----------
    source : JointSource
        At the last call of `at`.
    problem : str
        Why there is no ring, for messages; empty where there is one.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self.source = JointSource.NONE if path is None else JointSource.MISSING
        self.problem = ""
        self._reader: TimedRingReader | None = None
        self._retry_ns: int | None = None
        self._asked_ns: int | None = None
        self._slot_ns: int | None = None
        self._slot = np.zeros(JOINT_RING_WIDTH)
        self._slot_acceleration = np.zeros(6)
        self._acceleration = np.zeros(6)

    def at(self, time_ns: int) -> JointMotion | None:
        """State of the joints at a time.

        Between slots, positions and velocities are linear. After the newest slot, velocities are constant for at most
        20 ms, then the joints rest. The acceleration is the smoothed difference of velocity of the newest two slots.

        Parameters
        ----------
        time_ns : int
            CLOCK_MONOTONIC [ns], increasing from call to call.

        Returns
        -------
        JointMotion or None
            None where there is no robot, no ring, or nothing in it yet. May contain NaN if the ring does.
        """
        if self.path is None:
            return None
        dt_s = 0.0 if self._asked_ns is None else max(time_ns - self._asked_ns, 0) / 1e9
        self._asked_ns = time_ns
        found = self._read(self.path, time_ns)
        if found is None:
            self.source = JointSource.MISSING
            return None
        slot_ns, slot, now = found
        ahead_ns = time_ns - slot_ns
        self.source = JointSource.STALE if ahead_ns > _STALE_AFTER_NS else JointSource.FOLLOWED
        if ahead_ns > _LONGEST_EXTRAPOLATION_NS:
            self._acceleration = np.zeros(6)
            return JointMotion.still(slot[:6] + slot[6:] * (_LONGEST_EXTRAPOLATION_NS / 1e9))
        self._smooth(slot_ns, slot, dt_s)
        if ahead_ns <= 0:
            return JointMotion(now[:6], now[6:], self._acceleration)
        return JointMotion(slot[:6] + slot[6:] * (ahead_ns / 1e9), slot[6:], self._acceleration)

    def _read(self, path: Path, time_ns: int) -> tuple[int, NDArray[np.float64], NDArray[np.float64]] | None:
        """Time and values of the newest slot, and the values at `time_ns`; None where there are none."""
        if self._reader is None:
            if self._retry_ns is not None and time_ns < self._retry_ns:
                return None
            self._retry_ns = time_ns + _RETRY_NS
        try:
            if self._reader is None:
                self._reader = TimedRingReader(path, JOINT_RING_WIDTH)
            newest = self._reader.newest()
            if newest is None:
                self.problem = f"{path}: nothing is written to the ring yet"
                return None
            now = self._reader.sample(time_ns) if newest[0] > time_ns else newest[1]
        except ActsError as error:
            self.problem = str(error)
            self._reader = None
            return None
        self.problem = ""
        return None if now is None else (newest[0], newest[1], now)

    def _smooth(self, slot_ns: int, slot: NDArray[np.float64], dt_s: float) -> None:
        # The caller refuses a slot of NaN; here it must not enter the filter.
        if self._slot_ns != slot_ns and np.isfinite(slot).all():
            between_ns = 0 if self._slot_ns is None else slot_ns - self._slot_ns
            if 0 < between_ns <= _LONGEST_SLOT_NS:
                change = (slot[6:] - self._slot[6:]) / (between_ns / 1e9)
                self._slot_acceleration = np.clip(change, -_LARGEST_ACCELERATION_RAD_S2, _LARGEST_ACCELERATION_RAD_S2)
            else:
                self._slot_acceleration = np.zeros(6)
            self._slot_ns, self._slot = slot_ns, slot
        share = -math.expm1(-dt_s / _ACCELERATION_LAG_S)
        self._acceleration = self._acceleration + share * (self._slot_acceleration - self._acceleration)
