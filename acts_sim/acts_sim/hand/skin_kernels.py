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

SPHERE, CAPSULE, CYLINDER, BOX, TIP = range(5)

WAVES = 3
"""Number of plane waves in the unevenness of an object."""

# Columns of the results of each patch.
FORCE, SLIDING_FORCE, SLIDING_SPEED, TIP_FORCE = range(4)
PATCH_RESULTS = 4

# Indices of the foam's properties.
STIFFNESS, DENSE_DEPTH, DENSE_FACTOR, DAMPING, SHEAR, SHEAR_TIME, FRICTION, COVER = range(8)


@kernel(error_model="numpy")
def _gap(
    kind: int, size: NDArray[np.float64], s: int, x: float, y: float, z: float, within: float
) -> tuple[float, float, float, float]:
    """Signed distance of a point from a solid [m], and the unit vector away from it, in the solid's frame.

    Parameters
    ----------
    kind : int
    size : np.ndarray [shape=(solids, 4), dtype=float64]
        Sphere: radius. Capsule: radius, half length along z. Cylinder: radius, half length along z, rounding of the
        edges. Box: half lengths, rounding of the edges. Tip: radius, length along z. All [m].
    s : int
        Index of the solid.
    x, y, z : float
        [m]
    within : float
        Points that are certainly further away than this may get the distance 1 m [m].
    """
    if kind == CAPSULE:
        # A sphere about the nearest point of its axis.
        z -= min(max(z, -size[s, 1]), size[s, 1])
    if kind in (SPHERE, CAPSULE):
        square = x * x + y * y + z * z
        if square > (size[s, 0] + within) ** 2:
            return 1.0, 0.0, 0.0, 0.0
        distance = math.sqrt(square)
        scale = 1.0 / max(distance, 1e-12)
        return distance - size[s, 0], x * scale, y * scale, z * scale
    if kind == TIP:
        # A hemisphere whose end is the origin; its distance is measured along z, the direction in which it moves.
        across = size[s, 0] * size[s, 0] - x * x - y * y
        if across < 0.0 or z < -size[s, 1]:
            return 1.0, 0.0, 0.0, 0.0
        return z + size[s, 0] - math.sqrt(across), 0.0, 0.0, 1.0
    if kind == CYLINDER:
        square = x * x + y * y
        if abs(z) > size[s, 1] + within or square > (size[s, 0] + within) ** 2:
            return 1.0, 0.0, 0.0, 0.0
        rounding = size[s, 2]
        rho = math.sqrt(square)
        scale = 1.0 / max(rho, 1e-12)
        a, b = rho - (size[s, 0] - rounding), abs(z) - (size[s, 1] - rounding)
        up = 1.0 if z > 0.0 else -1.0
        if a > 0.0 and b > 0.0:
            distance = math.sqrt(a * a + b * b)
            return distance - rounding, a / distance * x * scale, a / distance * y * scale, b / distance * up
        if a > b:
            return a - rounding, x * scale, y * scale, 0.0
        return b - rounding, 0.0, 0.0, up
    rounding = size[s, 3]
    a, b, c = abs(x) - size[s, 0], abs(y) - size[s, 1], abs(z) - size[s, 2]
    if a > within or b > within or c > within:
        return 1.0, 0.0, 0.0, 0.0
    a, b, c = a + rounding, b + rounding, c + rounding
    sx, sy, sz = 1.0 if x > 0.0 else -1.0, 1.0 if y > 0.0 else -1.0, 1.0 if z > 0.0 else -1.0
    if a > 0.0 or b > 0.0 or c > 0.0:
        a, b, c = max(a, 0.0), max(b, 0.0), max(c, 0.0)
        distance = math.sqrt(a * a + b * b + c * c)
        return distance - rounding, a / distance * sx, b / distance * sy, c / distance * sz
    if a > b and a > c:
        return a - rounding, sx, 0.0, 0.0
    if b > c:
        return b - rounding, 0.0, sy, 0.0
    return c - rounding, 0.0, 0.0, sz


@kernel(error_model="numpy")
def _is_near(kind: int, size: NDArray[np.float64], s: int, x: float, y: float, z: float, within: float) -> bool:
    """Whether a sphere of radius `within` about a point may touch a solid; arguments as in `_gap`."""
    if kind == TIP:
        reach = size[s, 0] + within
        return x * x + y * y < reach * reach and -size[s, 1] - within < z < within
    return _gap(kind, size, s, x, y, z, within)[0] < within


@kernel(error_model="numpy")
def press(
    body_pos: NDArray[np.float64],
    body_mat: NDArray[np.float64],
    body_velocity: NDArray[np.float64],
    body_centre: NDArray[np.float64],
    root_centre: NDArray[np.float64],
    root_of: NDArray[np.int64],
    patch_body: NDArray[np.int64],
    patch_middle: NDArray[np.float64],
    patch_reach: NDArray[np.float64],
    patch_first: NDArray[np.int64],
    block_first: NDArray[np.int64],
    block_middle: NDArray[np.float64],
    block_reach: NDArray[np.float64],
    point: NDArray[np.float64],
    normal: NDArray[np.float64],
    area: NDArray[np.float64],
    taxel: NDArray[np.int64],
    share: NDArray[np.float64],
    bristle: NDArray[np.float64],
    block_touched: NDArray[np.bool_],
    foam: NDArray[np.float64],
    solid_kind: NDArray[np.int64],
    solid_body: NDArray[np.int64],
    solid_pos: NDArray[np.float64],
    solid_mat: NDArray[np.float64],
    solid_size: NDArray[np.float64],
    solid_there: NDArray[np.bool_],
    solid_travel: NDArray[np.float64],
    solid_uneven: NDArray[np.float64],
    wave: NDArray[np.float64],
    dt: float,
    forces: NDArray[np.float64],
    patch_result: NDArray[np.float64],
    wrench: NDArray[np.float64],
) -> None:
    """Compute the forces on the taxels and the wrenches on the bodies, and advance the bristles by `dt`.

    Parameters
    ----------
    body_pos, body_mat, body_velocity, body_centre, root_centre : np.ndarray
        MuJoCo's xpos, xmat, cvel, xipos and subtree_com of all bodies.
    root_of : np.ndarray [shape=(bodies,), dtype=int64]
        MuJoCo's body_rootid.
    patch_body, patch_middle, patch_reach, patch_first : np.ndarray
        Of each patch: body, centre in its frame [m], radius about it [m], first block (one more at the end).
    block_first, block_middle, block_reach : np.ndarray
        Of each block, the points of one taxel: first point (one more at the end), centre in the link's frame [m],
        radius about it [m].
    point, normal, area : np.ndarray
        Of each point of the foam: position below the cover in its link's frame [m], unit vector out of the skin,
        area [m^2].
    taxel, share : np.ndarray [shape=(points, 9)]
        Taxels on which the force of a point acts, and their shares of it.
    bristle : np.ndarray [shape=(points, 3), dtype=float64]
        State: deflection of each point along the surface, in its link's frame [m].
    block_touched : np.ndarray [shape=(blocks,), dtype=bool]
        State: whether any bristle of the block may be deflected.
    foam : np.ndarray [shape=(8,), dtype=float64]
    solid_kind, solid_body, solid_pos, solid_mat, solid_size, solid_there, solid_travel, solid_uneven : np.ndarray
        Of each solid: kind, body, pose in the body's frame, size, whether it is present, velocity in addition to
        MuJoCo's [m/s], height of its unevenness [m].
    wave : np.ndarray [shape=(solids, 3, 4), dtype=float64]
        Of the waves of the unevenness: wave vectors in the solid's frame [turns/m], and phases [turns].
    dt : float
        [s]
    forces : np.ndarray [shape=(taxels,), dtype=float64]
        Overwritten [N].
    patch_result : np.ndarray [shape=(patches, 4), dtype=float64]
        Overwritten: normal force [N], normal force of sliding points [N], mean speed of sliding [m/s], force of the
        tip [N].
    wrench : np.ndarray [shape=(bodies, 6), dtype=float64]
        Forces [N] and torques about the body's centre of mass [N m] are added.
    """
    forces[:] = 0.0
    patch_result[:] = 0.0
    solids = len(solid_kind)
    near, here = np.empty(solids, dtype=np.int64), np.empty(solids, dtype=np.int64)
    middle = np.empty((solids, 3))
    # Of each solid near a patch, in the frame of its link: position, rotation, velocities, force and torque.
    at, turn = np.empty((solids, 3)), np.empty((solids, 3, 3))
    spin, drift = np.empty((solids, 3)), np.empty((solids, 3))
    push, twist = np.empty((solids, 3)), np.empty((solids, 3))
    for s in range(solids):
        b = solid_body[s]
        for i in range(3):
            middle[s, i] = body_pos[b, i]
            for j in range(3):
                middle[s, i] += body_mat[b, 3 * i + j] * solid_pos[s, j]
    stiffness, damping = foam[STIFFNESS], foam[DAMPING]
    dense_depth, dense_factor = foam[DENSE_DEPTH], foam[DENSE_FACTOR]
    shear, shear_time, friction, cover = foam[SHEAR], foam[SHEAR_TIME], foam[FRICTION], foam[COVER]
    for p in range(len(patch_body)):
        link = patch_body[p]
        count = 0
        for s in range(solids):
            if not solid_there[s]:
                continue
            k = count
            _bring_near(
                body_pos, body_mat, body_velocity, root_centre, root_of, link, solid_body[s], middle, solid_mat, s,
                solid_travel, at, turn, spin, drift, k,
            )  # fmt: skip
            x, y, z = _in_solid(at, turn, k, patch_middle[p, 0], patch_middle[p, 1], patch_middle[p, 2])
            if _is_near(solid_kind[s], solid_size, s, x, y, z, patch_reach[p] + cover + solid_uneven[s]):
                near[k] = s
                for i in range(3):
                    push[k, i] = 0.0
                    twist[k, i] = 0.0
                count += 1
        total, tips, sliding, slid = 0.0, 0.0, 0.0, 0.0
        for block in range(patch_first[p], patch_first[p + 1]):
            close = 0
            for k in range(count):
                s = near[k]
                x, y, z = _in_solid(at, turn, k, block_middle[block, 0], block_middle[block, 1], block_middle[block, 2])
                if _is_near(solid_kind[s], solid_size, s, x, y, z, block_reach[block] + cover + solid_uneven[s]):
                    here[close] = k
                    close += 1
            if close == 0:
                if block_touched[block]:
                    bristle[block_first[block] : block_first[block + 1]] = 0.0
                    block_touched[block] = False
                continue
            block_touched[block] = True
            for i in range(block_first[block], block_first[block + 1]):
                px, py, pz = point[i, 0], point[i, 1], point[i, 2]
                depth, by = 0.0, -1
                nx, ny, nz = 0.0, 0.0, 0.0
                for one in range(close):
                    k = here[one]
                    s = near[k]
                    x, y, z = _in_solid(at, turn, k, px, py, pz)
                    uneven = solid_uneven[s]
                    gap, ax, ay, az = _gap(solid_kind[s], solid_size, s, x, y, z, cover + uneven)
                    if gap >= cover + uneven:
                        continue
                    if uneven > 0.0:
                        height = 0.0
                        for w in range(WAVES):
                            turns = wave[s, w, 0] * x + wave[s, w, 1] * y + wave[s, w, 2] * z + wave[s, w, 3]
                            turns -= math.floor(turns + 0.5)
                            height += turns * (8.0 - 16.0 * abs(turns))  # parabolas in place of a sine
                        gap -= uneven * height / WAVES
                    if cover - gap > depth:
                        depth, by = cover - gap, k
                        nx = turn[k, 0, 0] * ax + turn[k, 0, 1] * ay + turn[k, 0, 2] * az
                        ny = turn[k, 1, 0] * ax + turn[k, 1, 1] * ay + turn[k, 1, 2] * az
                        nz = turn[k, 2, 0] * ax + turn[k, 2, 1] * ay + turn[k, 2, 2] * az
                # A solid at the back of the link does not press its skin.
                if by < 0 or nx * normal[i, 0] + ny * normal[i, 1] + nz * normal[i, 2] > 0.0:
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
                # Deflection of the bristle in the plane of the contact.
                ux, uy, uz = bristle[i, 0] + vx * dt, bristle[i, 1] + vy * dt, bristle[i, 2] + vz * dt
                along = ux * nx + uy * ny + uz * nz
                ux, uy, uz = ux - along * nx, uy - along * ny, uz - along * nz
                stiff = shear * area[i]
                most = friction * force
                drawn = stiff * math.sqrt(ux * ux + uy * uy + uz * uz)
                if drawn > most:
                    scale = most / drawn
                    ux, uy, uz = ux * scale, uy * scale, uz * scale
                    sliding += force
                    slid += force * math.sqrt(vx * vx + vy * vy + vz * vz)
                bristle[i, 0], bristle[i, 1], bristle[i, 2] = ux, uy, uz
                fx, fy, fz = (
                    stiff * (ux + shear_time * vx),
                    stiff * (uy + shear_time * vy),
                    stiff * (uz + shear_time * vz),
                )
                drawn = math.sqrt(fx * fx + fy * fy + fz * fz)
                if drawn > most:
                    scale = most / drawn
                    fx, fy, fz = fx * scale, fy * scale, fz * scale
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
                if solid_kind[near[by]] == TIP:
                    tips += force
        if total > 0.0:
            patch_result[p, FORCE], patch_result[p, SLIDING_FORCE] = total, sliding
            patch_result[p, SLIDING_SPEED], patch_result[p, TIP_FORCE] = slid / max(total, 1e-12), tips
            for k in range(count):
                _add(wrench, body_pos, body_mat, body_centre, link, link, push, twist, k, 1.0)
                _add(wrench, body_pos, body_mat, body_centre, link, solid_body[near[k]], push, twist, k, -1.0)


@kernel(error_model="numpy")
def _in_solid(
    at: NDArray[np.float64], turn: NDArray[np.float64], k: int, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """A point of the link's frame in the frame of a solid, whose position and rotation are `at[k]` and `turn[k]`."""
    dx, dy, dz = x - at[k, 0], y - at[k, 1], z - at[k, 2]
    return (
        turn[k, 0, 0] * dx + turn[k, 1, 0] * dy + turn[k, 2, 0] * dz,
        turn[k, 0, 1] * dx + turn[k, 1, 1] * dy + turn[k, 2, 1] * dz,
        turn[k, 0, 2] * dx + turn[k, 1, 2] * dy + turn[k, 2, 2] * dz,
    )


@kernel(error_model="numpy")
def _bring_near(
    body_pos: NDArray[np.float64],
    body_mat: NDArray[np.float64],
    body_velocity: NDArray[np.float64],
    root_centre: NDArray[np.float64],
    root_of: NDArray[np.int64],
    link: int,
    body: int,
    middle: NDArray[np.float64],
    mat: NDArray[np.float64],
    s: int,
    travel: NDArray[np.float64],
    at: NDArray[np.float64],
    turn: NDArray[np.float64],
    spin: NDArray[np.float64],
    drift: NDArray[np.float64],
    row: int,
) -> None:
    """Position, rotation, angular velocity (spin) and velocity at the origin (drift) of solid `s` in a link's frame."""
    for i in range(3):
        at[row, i] = drift[row, i] = spin[row, i] = 0.0
        for j in range(3):
            turn[row, i, j] = 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        place = middle[s, i] - body_pos[link, i]
        # Velocity of the body at the link's origin, relative to the link.
        velocity = body_velocity[body, 3 + i] - body_velocity[link, 3 + i] + travel[s, i]
        rj, rk = body_pos[link, j] - root_centre[root_of[body], j], body_pos[link, k] - root_centre[root_of[body], k]
        velocity += body_velocity[body, j] * rk - body_velocity[body, k] * rj
        rj, rk = body_pos[link, j] - root_centre[root_of[link], j], body_pos[link, k] - root_centre[root_of[link], k]
        velocity -= body_velocity[link, j] * rk - body_velocity[link, k] * rj
        turning = body_velocity[body, i] - body_velocity[link, i]
        for j in range(3):
            whole = 0.0
            for k in range(3):
                whole += body_mat[body, 3 * i + k] * mat[s, 3 * k + j]
            for k in range(3):
                turn[row, k, j] += body_mat[link, 3 * i + k] * whole
        for k in range(3):
            at[row, k] += body_mat[link, 3 * i + k] * place
            drift[row, k] += body_mat[link, 3 * i + k] * velocity
            spin[row, k] += body_mat[link, 3 * i + k] * turning


@kernel(error_model="numpy")
def _add(
    wrench: NDArray[np.float64],
    body_pos: NDArray[np.float64],
    body_mat: NDArray[np.float64],
    body_centre: NDArray[np.float64],
    link: int,
    body: int,
    push: NDArray[np.float64],
    twist: NDArray[np.float64],
    row: int,
    sign: float,
) -> None:
    """Add a force and its torque about the link's origin, in its frame, to the wrench on a body."""
    force, torque = np.zeros(3), np.zeros(3)
    for i in range(3):
        for j in range(3):
            force[i] += sign * body_mat[link, 3 * i + j] * push[row, j]
            torque[i] += sign * body_mat[link, 3 * i + j] * twist[row, j]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        rj, rk = body_pos[link, j] - body_centre[body, j], body_pos[link, k] - body_centre[body, k]
        wrench[body, i] += force[i]
        wrench[body, 3 + i] += torque[i] + rj * force[k] - rk * force[j]
