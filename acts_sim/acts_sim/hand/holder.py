# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Springs and dampers that hold the object at a pose which can move, like a person's arm."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

_STIFFNESS_N_M = 800.0
_TURN_STIFFNESS_NM = 3.0
# Largest natural frequency [rad/s], stable with steps of a millisecond: lighter objects are held less stiffly.
_FASTEST_RAD_S = 300.0
_LET_GO_S = 0.1


class Holder:
    """Critically damped springs between the object and a moving pose.

    Parameters
    ----------
    mass_kg, inertia_kg_m2 : float
        Mass of the object, and its smallest moment of inertia.
    """

    def __init__(self, mass_kg: float, inertia_kg_m2: float) -> None:
        self._stiffness = min(_STIFFNESS_N_M, mass_kg * _FASTEST_RAD_S**2)
        self._turn_stiffness = min(_TURN_STIFFNESS_NM, inertia_kg_m2 * _FASTEST_RAD_S**2)
        self._damping = 2.0 * math.sqrt(self._stiffness * mass_kg)
        self._turn_damping = 2.0 * math.sqrt(self._turn_stiffness * inertia_kg_m2)
        self._start = self._position = self._end = np.zeros(3)
        self._quaternion = self._start_quaternion = np.array([1.0, 0.0, 0.0, 0.0])
        self._turn = np.zeros(3)
        # Speed of the pose relative to the length of its path [1/s].
        self._speed_s = 0.0
        self._elapsed_s = self._duration_s = 0.0
        self._strength = 0.0
        self._letting_go = False

    @property
    def holding(self) -> bool:
        """Whether the object is held, even by springs that are fading."""
        return self._strength > 0.0

    @property
    def keeps(self) -> bool:
        """Whether it goes on to hold the object: it does, and was not told to let go."""
        return self.holding and not self._letting_go

    @property
    def strength(self) -> float:
        """Factor on the springs: 1, less while they fade after `let_go`, and 0 without."""
        return self._strength

    def hold(self, position_m: NDArray[np.float64], quaternion: NDArray[np.float64]) -> None:
        """Hold the object at a pose.

        Parameters
        ----------
        position_m : np.ndarray [shape=(3,), dtype=float64]
            In the palm's frame [m].
        quaternion : np.ndarray [shape=(4,), dtype=float64]
            Orientation in the palm's frame: w, x, y, z.
        """
        self._position = self._start = self._end = position_m.copy()
        self._quaternion = self._start_quaternion = quaternion.copy()
        self._turn = np.zeros(3)
        self._duration_s = self._speed_s = 0.0
        self._strength, self._letting_go = 1.0, False

    def let_go(self) -> None:
        """Release the object; the springs fade within a tenth of a second."""
        self._letting_go = True

    def drop(self) -> None:
        """Release the object at once."""
        self._strength = 0.0

    def move(self, by_m: NDArray[np.float64], turn_rad: NDArray[np.float64], duration_s: float) -> None:
        """Move the pose smoothly.

        Parameters
        ----------
        by_m : np.ndarray [shape=(3,), dtype=float64]
            Translation in the palm's frame [m].
        turn_rad : np.ndarray [shape=(3,), dtype=float64]
            Rotation vector in the palm's frame [rad].
        duration_s : float
            Time that it takes [s].
        """
        self._start, self._end = self._position, self._position + by_m
        self._start_quaternion, self._turn = self._quaternion, turn_rad.copy()
        self._elapsed_s, self._duration_s = 0.0, max(duration_s, 1e-3)

    def wrench(
        self,
        position_m: NDArray[np.float64],
        quaternion: NDArray[np.float64],
        velocity_m_s: NDArray[np.float64],
        turn_rad_s: NDArray[np.float64],
        dt_s: float,
    ) -> NDArray[np.float64]:
        """Advance by `dt_s`; return force [N] and torque [N m] on the object, np.ndarray [shape=(6,)]."""
        if self._letting_go:
            self._strength = max(self._strength - dt_s / _LET_GO_S, 0.0)
        if self._duration_s:
            self._advance(dt_s)
        w, x, y, z = quaternion.tolist()
        difference = _product(self._quaternion, np.array((w, -x, -y, -z)))
        turn = 2.0 * math.copysign(self._turn_stiffness, difference[0]) * difference[1:]
        out = np.empty(6)
        out[:3] = self._stiffness * (self._position - position_m) + self._damping * (
            self._speed_s * (self._end - self._start) - velocity_m_s
        )
        out[3:] = turn + self._turn_damping * (self._speed_s * self._turn - turn_rad_s)
        return self._strength * out

    def _advance(self, dt_s: float) -> None:
        self._elapsed_s = min(self._elapsed_s + dt_s, self._duration_s)
        x = self._elapsed_s / self._duration_s
        share = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)  # minimum jerk: velocity and acceleration 0 at both ends
        self._speed_s = 30.0 * (x * (1.0 - x)) ** 2 / self._duration_s
        self._position = self._start + share * (self._end - self._start)
        self._quaternion = _product(_turned(share * self._turn), self._start_quaternion)
        if x >= 1.0:
            self._duration_s = 0.0


def _turned(vector_rad: NDArray[np.float64]) -> NDArray[np.float64]:
    angle = float(np.linalg.norm(vector_rad))
    if angle == 0.0:
        return np.array([1.0, 0.0, 0.0, 0.0])
    return np.concatenate(([math.cos(angle / 2.0)], math.sin(angle / 2.0) / angle * vector_rad))


def _product(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    aw, ax, ay, az = a.tolist()
    bw, bx, by, bz = b.tolist()
    return np.array(
        [
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ]
    )
