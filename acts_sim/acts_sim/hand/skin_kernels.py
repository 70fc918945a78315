# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kernels of the hand's skin: depth and force at every point of the foam, and the forces on taxels and bodies.

The foam is an elastic (Winkler) foundation of many points: the pressure at a point grows with the depth there. Along
the surface it is a brush model: each point is an elastic bristle that the object deflects until friction is overcome.
Points with little pressure, at the rim of a contact, slide first.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel
from acts_sim.hand.solid_kernels import (
    TIP,
    WAVES,
    Bodies,
    add_wrenches,
    bumps,
    find_near,
    gap,
    in_solid,
    is_near,
    tip_depth,
)

# Columns of the results of each patch.
FORCE, SLIDING_FORCE, SLIDING_SPEED, TIP_FORCE = range(4)
PATCH_RESULTS = 4

BLOCK = np.dtype(
    [
        ("middle", np.float64, 3),
        ("reach", np.float64),
        ("first", np.int64),
        ("end", np.int64),
        ("close", np.int64),
        ("touched", np.bool_),
    ],
    align=True,
)
"""The points of the foam under one taxel.

middle, reach
    Centre in the link's frame, and radius about it [m].
first, end
    Its first point, and the one after its last.
close, touched
    State: number of solids that may touch it, and whether any bristle may be deflected.
"""

POINT = np.dtype(
    [
        ("pos", np.float64, 3),
        ("normal", np.float64, 3),
        ("area", np.float64),
        ("taxel", np.int64, 9),
        ("share", np.float64, 9),
        ("bristle", np.float64, 3),
    ],
    align=True,
)
"""A point of the foam.

pos, normal, area
    Position below the cover in the link's frame [m], unit vector out of the skin, area [m^2].
taxel, share
    Taxels on which its force acts, and their shares of it.
bristle
    State: deflection along the surface, in the link's frame [m].
"""

FOAM = np.dtype(
    [
        ("stiffness_n_per_m3", np.float64),
        ("dense_depth_m", np.float64),
        ("dense_factor", np.float64),
        ("damping_s_m", np.float64),
        ("shear_n_per_m3", np.float64),
        ("shear_damping_s", np.float64),
        ("friction", np.float64),
        ("cover_m", np.float64),
    ]
)
"""Properties of the foam and of its cover; beyond the dense depth it is stiffer by the dense factor."""


@kernel(error_model="numpy")
def press(
    body_pos: NDArray[np.float64],
    body_mat: NDArray[np.float64],
    body_velocity: NDArray[np.float64],
    body_centre: NDArray[np.float64],
    root_centre: NDArray[np.float64],
    root_of: NDArray[np.int64],
    wrench: NDArray[np.float64],
    patches: NDArray[np.void],
    blocks: NDArray[np.void],
    points: NDArray[np.void],
    foams: NDArray[np.void],
    solids: NDArray[np.void],
    near: NDArray[np.void],
    dt: float,
    forces: NDArray[np.float64],
    results: NDArray[np.float64],
) -> None:
    """Compute the forces on the taxels and the wrenches on the bodies, and advance the bristles by `dt`.

    Parameters
    ----------
    body_pos, body_mat, body_velocity, body_centre, root_centre, root_of, wrench : np.ndarray
        ``*Bodies``, one by one: numba takes 2.5 us longer for the whole. To the wrenches is added.
    patches : np.ndarray [shape=(patches,), dtype=PATCH]
    blocks : np.ndarray [shape=(taxels,), dtype=BLOCK]
    points : np.ndarray [shape=(points,), dtype=POINT]
    foams : np.ndarray [shape=(1,), dtype=FOAM]
    solids : np.ndarray [shape=(solids,), dtype=SOLID]
    near : np.ndarray [shape=(patches, solids), dtype=NEAR]
        Overwritten.
    dt : float
        [s]
    forces : np.ndarray [shape=(taxels,), dtype=float64]
        Overwritten [N].
    results : np.ndarray [shape=(patches, 4), dtype=float64]
        Overwritten, of each patch: normal force [N], normal force of sliding points [N], mean speed of sliding [m/s],
        force of the tip [N].
    """
    bodies = Bodies(body_pos, body_mat, body_velocity, body_centre, root_centre, root_of, wrench)
    cover = foams[0]["cover_m"]
    forces[:] = 0.0
    results[:] = 0.0
    find_near(bodies, patches, solids, cover, near)
    here = np.empty((len(blocks), len(solids)), dtype=np.int64)
    for p in range(len(patches)):
        if patches[p]["near"] > 0 or patches[p]["touched"]:
            _find_close(patches[p], blocks, solids, near[p], cover, here)
            _press_patch(patches[p], blocks, points, foams[0], solids, near[p], here, dt, forces, results[p])
    add_wrenches(bodies, patches, solids, near, results[:, FORCE])


@kernel(error_model="numpy")
def _find_close(
    patch: np.void,
    blocks: NDArray[np.void],
    solids: NDArray[np.void],
    near: NDArray[np.void],
    cover: float,
    here: NDArray[np.int64],
) -> None:
    """Write which solids near a patch may touch each of its blocks into `here`, and how many into the block."""
    middle, reach, close = blocks["middle"], blocks["reach"], blocks["close"]
    kind, size, uneven = solids["kind"], solids["size"], solids["uneven"]
    solid, pos, turn, count = near["solid"], near["pos"], near["turn"], patch["near"]
    for b in range(patch["first"], patch["end"]):
        n = 0
        for k in range(count):
            s = solid[k]
            x, y, z = in_solid(pos, turn, k, middle[b, 0], middle[b, 1], middle[b, 2])
            if is_near(kind[s], size, s, x, y, z, reach[b] + cover + uneven[s]):
                here[b, n] = k
                n += 1
        close[b] = n


@kernel(error_model="numpy")
def _press_patch(
    patch: np.void,
    blocks: NDArray[np.void],
    points: NDArray[np.void],
    foam: np.void,
    solids: NDArray[np.void],
    near: NDArray[np.void],
    here: NDArray[np.int64],
    dt: float,
    forces: NDArray[np.float64],
    result: NDArray[np.float64],
) -> None:
    """Press the points of one patch; `near` and `result` are its own, all else is as in `press`.

    `here` is np.ndarray [shape=(blocks, solids), dtype=int64]: which of `near` may touch each block.
    """
    # Fields are read once: at every point that would take longer than the arithmetic. The search for the deepest solid
    # stays here for the same reason: as a function, which needs a dozen of these fields, it took a third longer.
    first, end, close, touched = blocks["first"], blocks["end"], blocks["close"], blocks["touched"]
    point, normal, area = points["pos"], points["normal"], points["area"]
    bristle, taxel, share = points["bristle"], points["taxel"], points["share"]
    kind, size, uneven, wave = solids["kind"], solids["size"], solids["uneven"], solids["wave"]
    solid, pos, turn, spin, drift = near["solid"], near["pos"], near["turn"], near["spin"], near["drift"]
    push, twist, cover = near["push"], near["twist"], foam["cover_m"]
    stiffness, dense_depth, dense_factor = foam["stiffness_n_per_m3"], foam["dense_depth_m"], foam["dense_factor"]
    damping, shear, shear_damping = foam["damping_s_m"], foam["shear_n_per_m3"], foam["shear_damping_s"]
    friction = foam["friction"]
    patch["touched"] = False
    total, tips, sliding, slid = 0.0, 0.0, 0.0, 0.0
    for b in range(patch["first"], patch["end"]):
        if close[b] == 0:
            if touched[b]:
                bristle[first[b] : end[b]] = 0.0
                touched[b] = False
            continue
        touched[b] = patch["touched"] = True
        for i in range(first[b], end[b]):
            px, py, pz = point[i, 0], point[i, 1], point[i, 2]
            mx, my, mz = normal[i, 0], normal[i, 1], normal[i, 2]
            by, depth, nx, ny, nz = -1, 0.0, 0.0, 0.0, 0.0
            for one in range(close[b]):
                k = here[b, one]
                s = solid[k]
                x, y, z = in_solid(pos, turn, k, px, py, pz)
                if kind[s] == TIP:
                    ax = turn[k, 0, 0] * mx + turn[k, 1, 0] * my + turn[k, 2, 0] * mz
                    ay = turn[k, 0, 1] * mx + turn[k, 1, 1] * my + turn[k, 2, 1] * mz
                    az = turn[k, 0, 2] * mx + turn[k, 1, 2] * my + turn[k, 2, 2] * mz
                    deep = tip_depth(size[s, 0], size[s, 1], x, y, z - cover, ax, ay, az)
                    if deep > depth:
                        depth, by, nx, ny, nz = deep, k, -mx, -my, -mz
                    continue
                distance, ax, ay, az = gap(kind[s], size, s, x, y, z, cover + uneven[s])
                if distance >= cover + uneven[s]:
                    continue
                if uneven[s] > 0.0:
                    distance -= uneven[s] * bumps(wave, s, x, y, z) / WAVES
                if cover - distance > depth:
                    depth, by = cover - distance, k
                    nx = turn[k, 0, 0] * ax + turn[k, 0, 1] * ay + turn[k, 0, 2] * az
                    ny = turn[k, 1, 0] * ax + turn[k, 1, 1] * ay + turn[k, 1, 2] * az
                    nz = turn[k, 2, 0] * ax + turn[k, 2, 1] * ay + turn[k, 2, 2] * az
            # A solid at the back of the link does not press its skin.
            if by < 0 or nx * mx + ny * my + nz * mz > 0.0:
                bristle[i, 0] = bristle[i, 1] = bristle[i, 2] = 0.0
                continue
            # Velocity of the solid relative to the skin at this point.
            vx = drift[by, 0] + spin[by, 1] * pz - spin[by, 2] * py
            vy = drift[by, 1] + spin[by, 2] * px - spin[by, 0] * pz
            vz = drift[by, 2] + spin[by, 0] * py - spin[by, 1] * px
            deeper = vx * nx + vy * ny + vz * nz
            vx, vy, vz = vx - deeper * nx, vy - deeper * ny, vz - deeper * nz
            if depth > dense_depth:
                depth += (dense_factor - 1.0) * (depth - dense_depth)
            force = stiffness * area[i] * depth * min(max(1.0 + damping * deeper, 0.0), 2.0)
            stiff, most = shear * area[i], friction * force
            ux, uy, uz = bristle[i, 0] + vx * dt, bristle[i, 1] + vy * dt, bristle[i, 2] + vz * dt
            ux, uy, uz, slides = _deflected(stiff, most, ux, uy, uz, nx, ny, nz)
            if slides:
                sliding += force
                slid += force * math.sqrt(vx * vx + vy * vy + vz * vz)
            bristle[i, 0], bristle[i, 1], bristle[i, 2] = ux, uy, uz
            fx, fy, fz = _bristle_force(stiff, most, shear_damping, ux, uy, uz, vx, vy, vz)
            fx, fy, fz = fx + force * nx, fy + force * ny, fz + force * nz
            push[by, 0] += fx
            push[by, 1] += fy
            push[by, 2] += fz
            twist[by, 0] += py * fz - pz * fy
            twist[by, 1] += pz * fx - px * fz
            twist[by, 2] += px * fy - py * fx
            for k in range(9):
                forces[taxel[i, k]] += force * share[i, k]
            total += force
            if kind[solid[by]] == TIP:
                tips += force
    if total > 0.0:
        result[FORCE], result[SLIDING_FORCE], result[TIP_FORCE] = total, sliding, tips
        result[SLIDING_SPEED] = slid / max(total, 1e-12)


@kernel(error_model="numpy")
def _deflected(
    stiff: float, most: float, ux: float, uy: float, uz: float, nx: float, ny: float, nz: float
) -> tuple[float, float, float, bool]:
    """Deflection of a bristle of a stiffness [N/m] in the plane with unit normal n, and whether it slides.

    Where u [m] would draw with more than `most` [N], the bristle slides until it draws with that.
    """
    along = ux * nx + uy * ny + uz * nz
    ux, uy, uz = ux - along * nx, uy - along * ny, uz - along * nz
    drawn = stiff * math.sqrt(ux * ux + uy * uy + uz * uz)
    if drawn > most:
        scale = most / drawn
        return ux * scale, uy * scale, uz * scale, True
    return ux, uy, uz, False


@kernel(error_model="numpy")
def _bristle_force(
    stiff: float, most: float, damping_s: float, ux: float, uy: float, uz: float, vx: float, vy: float, vz: float
) -> tuple[float, float, float]:
    """Force of a bristle of a stiffness [N/m], at most `most` [N], from its deflection u [m] and velocity v [m/s]."""
    fx, fy, fz = stiff * (ux + damping_s * vx), stiff * (uy + damping_s * vy), stiff * (uz + damping_s * vz)
    drawn = math.sqrt(fx * fx + fy * fy + fz * fz)
    if drawn > most:
        scale = most / drawn
        fx, fy, fz = fx * scale, fy * scale, fz * scale
    return fx, fy, fz
