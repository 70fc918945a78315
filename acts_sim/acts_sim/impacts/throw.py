# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The flight of a ball that bounces: a rigid sphere on a spring with losses, and friction where it touches."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_sim.impacts.balls import DROP_HEIGHT_M, Ball

GRAVITY_M_S2 = 9.81

_STEP_S = 5e-6
_LONGEST_S = 0.5
# Slower than this the contact point sticks: friction falls to 0 with the speed.
_STICK_M_S = 0.005


@dataclass(frozen=True)
class Throw:
    """A ball at the moment of its first touch, in the skin's frame.

    Attributes
    ----------
    x_m, y_m : float
        Where it first touches [m].
    velocity_m_s : tuple of float
        x, y, z [m/s]; z is below 0: towards the skin.
    spin_rad_s : tuple of float
        About x, y and z [rad/s], right-handed. A spin about z changes nothing: the footprint's own friction against
        turning is not modelled.
    """

    x_m: float = 0.0
    y_m: float = 0.0
    velocity_m_s: tuple[float, float, float] = (0.0, 0.0, -math.sqrt(2 * GRAVITY_M_S2 * DROP_HEIGHT_M))
    spin_rad_s: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        numbers = (self.x_m, self.y_m, *self.velocity_m_s, *self.spin_rad_s)
        if not all(map(math.isfinite, numbers)) or self.velocity_m_s[2] >= 0:
            raise SettingsError(f"{self}: needed are finite numbers, and a velocity along z below 0")

    @property
    def direction_rad(self) -> float:
        """Which way it flies along the skin, from x towards y, -pi to pi [rad]; 0 where it falls straight."""
        return math.atan2(self.velocity_m_s[1], self.velocity_m_s[0])


def dropped(height_m: float = DROP_HEIGHT_M, x_m: float = 0.0, y_m: float = 0.0) -> Throw:
    """Let a ball fall from rest [m].

    Raises
    ------
    SettingsError
        When the height is not above 0.
    """
    if not 0 < height_m < math.inf:
        raise SettingsError(f"height {height_m} m: allowed is above 0 m")
    return Throw(x_m, y_m, (0.0, 0.0, -math.sqrt(2 * GRAVITY_M_S2 * height_m)))


def thrown(
    speed_m_s: float,
    direction_rad: float,
    descent_rad: float,
    x_m: float = 0.0,
    y_m: float = 0.0,
    *,
    rolling: float = 0.0,
    radius_m: float = 0.0,
) -> Throw:
    """Throw a ball at an angle.

    Parameters
    ----------
    speed_m_s : float
    direction_rad : float
        Along the skin, from x towards y [rad].
    descent_rad : float
        Angle to the skin: pi/2 is straight down [rad].
    x_m, y_m : float
        Where it first touches [m].
    rolling : float
        Spin, as a share of that of a ball of `radius_m` that rolls along the skin as fast as it flies along it: 1 is
        what comes off a long ramp, below 0 is backspin.
    radius_m : float
        Of the ball, where it spins [m].

    Raises
    ------
    SettingsError
        When speed and descent do not lead to the skin, or a spin is asked for without a radius.
    """
    if rolling and not radius_m > 0:
        raise SettingsError(f"rolling = {rolling} of a ball of {radius_m} m: give its radius")
    along_m_s = speed_m_s * math.cos(descent_rad)
    c, s = math.cos(direction_rad), math.sin(direction_rad)
    turn_rad_s = rolling * along_m_s / radius_m if rolling else 0.0
    velocity_m_s = (along_m_s * c, along_m_s * s, -speed_m_s * math.sin(descent_rad))
    return Throw(x_m, y_m, velocity_m_s, (-turn_rad_s * s, turn_rad_s * c, 0.0))


@dataclass(frozen=True)
class Collision:
    """One touch, from the first moment to the last.

    Attributes
    ----------
    time_s : np.ndarray [shape=(n,), dtype=float64]
        From the first touch of the throw on, evenly spaced.
    x_m, y_m : np.ndarray [shape=(n,), dtype=float64]
        The centre of the footprint [m].
    depth_m, force_n : np.ndarray [shape=(n,), dtype=float64]
        How far ball and foam are pressed together [m], normal force [N].
    after : Throw or None
        The next touch; None where it is no longer thrown up.
    after_s : float
        When that is [s].
    """

    time_s: NDArray[np.float64]
    x_m: NDArray[np.float64]
    y_m: NDArray[np.float64]
    depth_m: NDArray[np.float64]
    force_n: NDArray[np.float64]
    after: Throw | None
    after_s: float

    @property
    def duration_s(self) -> float:
        """How long it touches [s]."""
        return float(self.time_s[-1] - self.time_s[0])

    @property
    def impulse_n_s(self) -> float:
        """Normal force over time [N s]."""
        return float(self.force_n.sum() * _STEP_S)


def collide(ball: Ball, throw: Throw, begin_s: float = 0.0) -> Collision:
    """Let a ball meet the skin once.

    Raises
    ------
    SettingsError
        When it stays on the skin for half a second: this is a model of what bounces.
    """
    x_m, y_m, depth_m = throw.x_m, throw.y_m, 0.0
    vx, vy, vz = throw.velocity_m_s
    wx, wy, wz = throw.spin_rad_s
    radius_m, inertia_kg = ball.radius_m, ball.inertia * ball.mass_kg * ball.radius_m
    rows = []
    for number in range(round(_LONGEST_S / _STEP_S)):
        spring_n = ball.stiffness_n_per_m15 * depth_m**1.5
        force_n = max(spring_n * (1.0 - ball.damping_s_per_m * vz), 0.0)
        rows.append((begin_s + number * _STEP_S, x_m, y_m, depth_m, force_n))
        if depth_m <= 0.0 and number:
            break
        # The lowest point of the ball, -radius along z from its middle.
        slip_x, slip_y = vx - wy * radius_m, vy + wx * radius_m
        slip_m_s = math.hypot(slip_x, slip_y)
        share = ball.friction * force_n / max(slip_m_s, _STICK_M_S)
        drag_x, drag_y = -share * slip_x, -share * slip_y
        vx += _STEP_S * drag_x / ball.mass_kg
        vy += _STEP_S * drag_y / ball.mass_kg
        vz += _STEP_S * (force_n / ball.mass_kg - GRAVITY_M_S2)
        wx += _STEP_S * drag_y / inertia_kg
        wy -= _STEP_S * drag_x / inertia_kg
        x_m += _STEP_S * vx
        y_m += _STEP_S * vy
        depth_m = max(depth_m - _STEP_S * vz, 0.0)
    else:
        raise SettingsError(f"{throw} does not bounce off within {_LONGEST_S} s: throw it faster, or a stiffer ball")
    table = np.array(rows).T
    flight_s = 2 * vz / GRAVITY_M_S2
    after_s = float(table[0, -1]) + flight_s
    after = Throw(x_m + vx * flight_s, y_m + vy * flight_s, (vx, vy, -vz), (wx, wy, wz)) if vz > 0 else None
    time_s, xs_m, ys_m, depths_m, forces_n = table
    return Collision(time_s, xs_m, ys_m, depths_m, forces_n, after, after_s)
