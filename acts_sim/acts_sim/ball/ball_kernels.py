# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kernels of the ball's world: the plate's motion, a step of the rolling ball, and the counts under it.

The tests compare `press` with a reference implementation, and the other two with closed solutions.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel

STANDARD_GRAVITY_M_S2 = 9.80665

SUBPOINTS = 4
"""Points along a taxel's side at which the pressure is evaluated, at least."""

LARGEST_SPACING_M = 0.0125
"""Largest distance of these points [m]: between points much further apart a ball would press nothing, or too much."""

# Three-point Gauss-Hermite rule of a Gaussian with standard deviation 1: exact for polynomials up to the fifth degree.
SPREAD_OFFSETS = (-math.sqrt(3.0), 0.0, math.sqrt(3.0))
SPREAD_WEIGHTS = (1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0)


@kernel
def plate_pose(
    q_rad: NDArray[np.float64], dh: NDArray[np.float64], yaw_rad: float, height_m: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pose of the plate's surface in the robot's base frame.

    Parameters
    ----------
    q_rad : np.ndarray [shape=(n,), dtype=float64]
    dh : np.ndarray [shape=(n, 3), dtype=float64]
        Denavit-Hartenberg parameters a [m], d [m], alpha [rad] of every joint.
    yaw_rad, height_m : float
        Angle of the plate about the flange's z axis, and distance of its surface from the flange.

    Returns
    -------
    rotation : np.ndarray [shape=(3, 3), dtype=float64]
        Columns are the skin's x, y and z.
    origin : np.ndarray [shape=(3,), dtype=float64]
        The pad's centre [m].
    """
    rotation = np.eye(3)
    origin = np.zeros(3)
    turned = np.empty((3, 3))
    for joint in range(q_rad.shape[0]):
        a_m, d_m, alpha_rad = dh[joint, 0], dh[joint, 1], dh[joint, 2]
        c, s = math.cos(q_rad[joint]), math.sin(q_rad[joint])
        ca, sa = math.cos(alpha_rad), math.sin(alpha_rad)
        for i in range(3):
            x, y, z = rotation[i, 0], rotation[i, 1], rotation[i, 2]
            along = c * x + s * y
            across = c * y - s * x
            origin[i] += a_m * along + d_m * z
            turned[i, 0] = along
            turned[i, 1] = ca * across + sa * z
            turned[i, 2] = ca * z - sa * across
        rotation[:] = turned
    c, s = math.cos(yaw_rad), math.sin(yaw_rad)
    for i in range(3):
        x, y = rotation[i, 0], rotation[i, 1]
        rotation[i, 0] = c * x + s * y
        rotation[i, 1] = c * y - s * x
        origin[i] += height_m * rotation[i, 2]
    return rotation, origin


@kernel
def _small_turn(start: NDArray[np.float64], end: NDArray[np.float64], turn: NDArray[np.float64]) -> None:
    # Rotation vector of start' end for a small angle: the antisymmetric part. The axis is the same in both frames.
    turn[0] = turn[1] = turn[2] = 0.0
    for k in range(3):
        turn[0] += 0.5 * (start[k, 2] * end[k, 1] - start[k, 1] * end[k, 2])
        turn[1] += 0.5 * (start[k, 0] * end[k, 2] - start[k, 2] * end[k, 0])
        turn[2] += 0.5 * (start[k, 1] * end[k, 0] - start[k, 0] * end[k, 1])


@kernel
def plate_motion(
    q_rad: NDArray[np.float64],
    qd_rad_s: NDArray[np.float64],
    qdd_rad_s2: NDArray[np.float64],
    dh: NDArray[np.float64],
    yaw_rad: float,
    height_m: float,
    difference_s: float,
) -> NDArray[np.float64]:
    """Motion of the plate while its joints move with constant acceleration, by central differences.

    Returns
    -------
    np.ndarray [shape=(4, 3), dtype=float64]
        All in the skin's frame: gravity minus the acceleration of the surface's origin [m/s^2], the plate's angular
        velocity [rad/s], its angular acceleration [rad/s^2], and the upward vertical (a unit vector).
    """
    h = difference_s
    change = 0.5 * h * h * qdd_rad_s2
    rotation, origin = plate_pose(q_rad, dh, yaw_rad, height_m)
    rotation_after, origin_after = plate_pose(q_rad + h * qd_rad_s + change, dh, yaw_rad, height_m)
    rotation_before, origin_before = plate_pose(q_rad - h * qd_rad_s + change, dh, yaw_rad, height_m)
    turn_after, turn_before = np.empty(3), np.empty(3)
    _small_turn(rotation, rotation_after, turn_after)
    _small_turn(rotation_before, rotation, turn_before)
    motion = np.zeros((4, 3))
    for i in range(3):
        pull = -(origin_after[i] - 2.0 * origin[i] + origin_before[i]) / (h * h)
        if i == 2:
            pull -= STANDARD_GRAVITY_M_S2
        for j in range(3):
            motion[0, j] += rotation[i, j] * pull
        motion[1, i] = (turn_after[i] + turn_before[i]) / (2.0 * h)
        motion[2, i] = (turn_after[i] - turn_before[i]) / (h * h)
        motion[3, i] = rotation[2, i]
    return motion


@kernel
def roll(
    x: float, y: float, vx: float, vy: float, motion: NDArray[np.float64], radius: float, resistance: float, dt: float
) -> tuple[float, float, float, float, float]:
    """One step of a sphere that rolls without slipping on the moving plate.

    Newton's law for the centre, Euler's for the spin, and the rolling condition in the turning frame of the plate give,
    with the centre at r = (x, y, radius), n the normal and 2/5 the sphere's moment of inertia over m radius^2::

        7/5 r'' = (g - a_P - 2 W x r' - W' x r - W x (W x r)) + 2/5 radius n x W' - 2/5 W_z n x r'     (in the plane)

    The spin about the normal is assumed to be zero relative to the plate.

    Parameters
    ----------
    x, y, vx, vy : float
        Position [m] and velocity [m/s] in the skin's frame.
    motion : np.ndarray [shape=(4, 3), dtype=float64]
        As `plate_motion` returns it.
    radius : float
        [m]
    resistance : float
        Coefficient of rolling resistance.
    dt : float
        [s]

    Returns
    -------
    x, y, vx, vy : float
        One step later.
    load : float
        Normal force over mass during the step [m/s^2]; 0 where the plate drops away faster than the ball falls.
    """
    gx, gy, gz = motion[0]
    wx, wy, wz = motion[1]
    ax, ay, az = motion[2]
    # W x r, then W x (W x r)
    ux, uy, uz = wy * radius - wz * y, wz * x - wx * radius, wx * y - wy * x
    fx = gx + 2.0 * wz * vy - (ay * radius - az * y) - (wy * uz - wz * uy)
    fy = gy - 2.0 * wz * vx - (az * x - ax * radius) - (wz * ux - wx * uz)
    load = max(-gz + 2.0 * (wx * vy - wy * vx) + (ax * y - ay * x) + (wx * uy - wy * ux), 0.0)
    rx = (fx + 0.4 * (-radius * ay + wz * vy)) / 1.4
    ry = (fy + 0.4 * (radius * ax - wz * vx)) / 1.4
    new_vx, new_vy = vx + rx * dt, vy + ry * dt
    # Rolling resistance never reverses the motion: at rest it balances any smaller force.
    speed = math.hypot(new_vx, new_vy)
    loss = resistance * load / 1.4 * dt
    share = 0.0 if speed <= loss else 1.0 - loss / speed
    new_vx *= share
    new_vy *= share
    return x + 0.5 * (vx + new_vx) * dt, y + 0.5 * (vy + new_vy) * dt, new_vx, new_vy, load


@kernel
def _points(pitch_m: float, spread_m: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points along a taxel's side, each three times for the spread: their places from its middle [m], their weights."""
    count = max(SUBPOINTS, math.ceil(pitch_m / LARGEST_SPACING_M))
    offset, weight = np.empty(3 * count), np.empty(3 * count)
    for i in range(count):
        for j in range(3):
            offset[3 * i + j] = ((i + 0.5) / count - 0.5) * pitch_m + SPREAD_OFFSETS[j] * spread_m
            weight[3 * i + j] = SPREAD_WEIGHTS[j] / count
    return offset, weight


@kernel
def press(
    counts: NDArray[np.float64],
    pitch_m: float,
    row_pitch_m: float,
    x_m: float,
    y_m: float,
    radius_m: float,
    depth_m: float,
    stiffness_n_per_m3: float,
    spread_m: float,
    full_scale_counts: float,
    dead_n: float,
    half_n: float,
) -> None:
    """Compute the counts of every taxel under a sphere in foam; see `ball_contact` for the model.

    Parameters
    ----------
    counts : np.ndarray [shape=(rows, cols), dtype=float64]
        Overwritten.
    pitch_m, row_pitch_m : float
        Distances of neighbouring columns and rows [m].
    x_m, y_m, radius_m, depth_m, stiffness_n_per_m3, spread_m : float
        Of the sphere's centre, the sphere and the foam.
    full_scale_counts, dead_n, half_n : float
        Parameters of the force response.
    """
    rows, cols = counts.shape
    counts[:] = 0.0
    if depth_m <= 0.0:
        return
    reach = math.sqrt(2.0 * radius_m * depth_m) + SPREAD_OFFSETS[2] * spread_m
    reach_x, reach_y = (reach + 0.5 * pitch_m) / pitch_m, (reach + 0.5 * row_pitch_m) / row_pitch_m
    col_middle = x_m / pitch_m + 0.5 * (cols - 1)
    row_middle = 0.5 * (rows - 1) - y_m / row_pitch_m
    first_col = max(math.ceil(col_middle - reach_x), 0)
    last_col = min(math.floor(col_middle + reach_x), cols - 1)
    first_row = max(math.ceil(row_middle - reach_y), 0)
    last_row = min(math.floor(row_middle + reach_y), rows - 1)
    offset_x, weight_x = _points(pitch_m, spread_m)
    offset_y, weight_y = _points(row_pitch_m, spread_m)
    rise_x = np.empty(len(offset_x))
    for col in range(first_col, last_col + 1):
        for i in range(len(offset_x)):
            distance = (col - col_middle) * pitch_m + offset_x[i]
            rise_x[i] = depth_m - distance * distance / (2.0 * radius_m)
        for row in range(first_row, last_row + 1):
            total = 0.0
            for j in range(len(offset_y)):
                distance = (row_middle - row) * row_pitch_m + offset_y[j]
                rise_y = distance * distance / (2.0 * radius_m)
                line = 0.0
                for i in range(len(offset_x)):
                    line += weight_x[i] * max(rise_x[i] - rise_y, 0.0)
                total += weight_y[j] * line
            above = stiffness_n_per_m3 * total * pitch_m * row_pitch_m - dead_n
            if above > 0.0:
                counts[row, col] = full_scale_counts * above / (above + half_n)
