# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Kernels of the solids that press the hand's skin: which are near a patch, and how far a point is from them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.kernels import kernel

SPHERE, CAPSULE, CYLINDER, BOX, TIP = range(5)

WAVES = 3
"""Number of plane waves in the unevenness of an object."""

# Structured arrays instead of tuples of arrays: to pass those takes numba 10 us longer, where a whole call takes 16.

SOLID = np.dtype(
    [
        ("kind", np.int64),
        ("body", np.int64),
        ("pos", np.float64, 3),
        ("mat", np.float64, (3, 3)),
        ("size", np.float64, 4),
        ("there", np.bool_),
        ("travel", np.float64, 3),
        ("uneven", np.float64),
        ("wave", np.float64, (WAVES, 4)),
    ],
    align=True,
)
"""A piece of an object, or the tip.

kind
    `SPHERE`, `CAPSULE`, `CYLINDER`, `BOX` or `TIP`.
body, pos, mat
    MuJoCo's body, and position [m] and rotation in its frame.
size
    Sphere: radius. Capsule: radius, half length along z. Cylinder: radius, half length along z, rounding of the edges.
    Box: half lengths, rounding of the edges. Tip: radius, length along z. All [m].
there
    Whether it is present.
travel
    Velocity in addition to MuJoCo's [m/s].
uneven, wave
    Height of its unevenness [m]; of each of its waves the wave vector in the solid's frame [turns/m], and the phase
    [turns].
"""

PATCH = np.dtype(
    [
        ("body", np.int64),
        ("middle", np.float64, 3),
        ("reach", np.float64),
        ("first", np.int64),
        ("end", np.int64),
        ("near", np.int64),
        ("touched", np.bool_),
    ],
    align=True,
)
"""A patch of the skin.

body, middle, reach
    Body of its link; centre in the link's frame, and radius about it [m].
first, end
    Its first block, and the one after its last.
near, touched
    State: number of solids near it, and whether any block of it is touched.
"""

NEAR = np.dtype(
    [
        ("solid", np.int64),
        ("pos", np.float64, 3),
        ("turn", np.float64, (3, 3)),
        ("spin", np.float64, 3),
        ("drift", np.float64, 3),
        ("push", np.float64, 3),
        ("twist", np.float64, 3),
    ],
    align=True,
)
"""A solid near a patch, in the frame of the patch's link.

solid, pos, turn
    Its index; position [m] and rotation.
spin, drift
    Angular velocity [rad/s], and velocity at the link's origin [m/s].
push, twist
    Its force on the link [N], and the torque about the link's origin [N m].
"""


class Bodies(NamedTuple):
    """The bodies of MuJoCo.

    Attributes
    ----------
    pos, centre, root_centre : np.ndarray [shape=(bodies, 3), dtype=float64]
        MuJoCo's xpos, xipos and subtree_com [m].
    mat : np.ndarray [shape=(bodies, 9), dtype=float64]
        MuJoCo's xmat.
    velocity : np.ndarray [shape=(bodies, 6), dtype=float64]
        MuJoCo's cvel: angular [rad/s], then linear [m/s].
    root_of : np.ndarray [shape=(bodies,), dtype=int64]
        MuJoCo's body_rootid.
    wrench : np.ndarray [shape=(bodies, 6), dtype=float64]
        MuJoCo's xfrc_applied: force [N], and torque about the body's centre of mass [N m].
    """

    pos: NDArray[np.float64]
    mat: NDArray[np.float64]
    velocity: NDArray[np.float64]
    centre: NDArray[np.float64]
    root_centre: NDArray[np.float64]
    root_of: NDArray[np.int64]
    wrench: NDArray[np.float64]


@kernel(error_model="numpy")
def gap(
    kind: int, size: NDArray[np.float64], s: int, x: float, y: float, z: float, within: float
) -> tuple[float, float, float, float]:
    """Signed distance of a point from a solid [m], and the unit vector away from it, in the solid's frame.

    Parameters
    ----------
    kind : int
        Of a `TIP`, `tip_depth` tells how deep it is.
    size : np.ndarray [shape=(solids, 4), dtype=float64]
        Of all solids, as in `SOLID`.
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
def tip_depth(radius: float, length: float, x: float, y: float, z: float, mx: float, my: float, mz: float) -> float:
    """How deep a rod presses foam at a point: how far beyond the point it reaches into the skin [m]; 0 for not at all.

    A point in the middle under a thin rod is nearer to its side than to its end, so the distance from its surface would
    not tell. Measured along the rod, as deep as this would seem what only brushes a slanting skin.

    Parameters
    ----------
    radius, length : float
        Of the rod: along z, up to its round end at the origin [m].
    x, y, z : float
        The point [m].
    mx, my, mz : float
        The unit vector out of the skin there.
    """
    across = radius * radius - x * x - y * y
    if across < 0.0 or z < -length or z + radius >= math.sqrt(across):
        return 0.0
    depth = _way_out(radius, length, x, y, z, -mx, -my, -mz)
    # What reaches farther into the skin than out of it comes from behind and does not press.
    return depth if depth < _way_out(radius, length, x, y, z, mx, my, mz) else 0.0


@kernel(error_model="numpy")
def _way_out(radius: float, length: float, x: float, y: float, z: float, ux: float, uy: float, uz: float) -> float:
    """How far it is from a point of the rod along a unit vector until the rod ends; otherwise as in `tip_depth`."""
    square = radius * radius - x * x - y * y - (z + radius) ** 2
    along = x * ux + y * uy
    whole = along + (z + radius) * uz
    if whole * whole + square >= 0.0:
        way = math.sqrt(whole * whole + square) - whole
        if way >= 0.0 and z + way * uz >= -radius:
            return way
    # Not by the round end: by the side or the other end.
    way = -(length + z) / uz if uz < 0.0 else math.inf
    slant = ux * ux + uy * uy
    if slant > 1e-9:
        across = radius * radius - x * x - y * y
        way = min(way, (math.sqrt(along * along + slant * across) - along) / slant)
    return way


@kernel(error_model="numpy")
def is_near(kind: int, size: NDArray[np.float64], s: int, x: float, y: float, z: float, within: float) -> bool:
    """Whether a sphere of radius `within` about a point may touch a solid; arguments as in `gap`."""
    if kind == TIP:
        reach = size[s, 0] + within
        return x * x + y * y < reach * reach and -size[s, 1] - within < z < within
    return gap(kind, size, s, x, y, z, within)[0] < within


@kernel(error_model="numpy")
def bumps(wave: NDArray[np.float64], s: int, x: float, y: float, z: float) -> float:
    """Sum of the waves of solid `s` at a point of its frame, each -1 to 1."""
    height = 0.0
    for w in range(WAVES):
        turns = wave[s, w, 0] * x + wave[s, w, 1] * y + wave[s, w, 2] * z + wave[s, w, 3]
        turns -= math.floor(turns + 0.5)
        height += turns * (8.0 - 16.0 * abs(turns))  # parabolas in place of a sine
    return height


@kernel(error_model="numpy")
def in_solid(
    pos: NDArray[np.float64], turn: NDArray[np.float64], k: int, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """A point of the link's frame in the frame of a solid, whose position and rotation are `pos[k]` and `turn[k]`."""
    dx, dy, dz = x - pos[k, 0], y - pos[k, 1], z - pos[k, 2]
    return (
        turn[k, 0, 0] * dx + turn[k, 1, 0] * dy + turn[k, 2, 0] * dz,
        turn[k, 0, 1] * dx + turn[k, 1, 1] * dy + turn[k, 2, 1] * dz,
        turn[k, 0, 2] * dx + turn[k, 1, 2] * dy + turn[k, 2, 2] * dz,
    )


@kernel(error_model="numpy")
def find_near(
    bodies: Bodies, patches: NDArray[np.void], solids: NDArray[np.void], cover: float, near: NDArray[np.void]
) -> None:
    """Write the solids that may touch each patch under a cover [m] into `near`, and how many they are into the patch.

    Parameters
    ----------
    bodies : Bodies
    patches : np.ndarray [shape=(patches,), dtype=PATCH]
    solids : np.ndarray [shape=(solids,), dtype=SOLID]
    cover : float
    near : np.ndarray [shape=(patches, solids), dtype=NEAR]
        Forces and torques are 0.
    """
    # Read once: in the loops that would take longer than the arithmetic.
    body_pos, body_mat, velocity = bodies.pos, bodies.mat, bodies.velocity
    root_centre, root_of, kind, size = bodies.root_centre, bodies.root_of, solids["kind"], solids["size"]
    for p in range(len(patches)):
        patch = patches[p]
        patch["near"] = 0
        middle = patch["middle"]
        for s in range(len(solids)):
            if not solids[s]["there"]:
                continue
            one = near[p, patch["near"]]
            _bring_near(body_pos, body_mat, velocity, root_centre, root_of, patch["body"], solids[s], one)
            x, y, z = in_solid(near[p]["pos"], near[p]["turn"], patch["near"], middle[0], middle[1], middle[2])
            if is_near(kind[s], size, s, x, y, z, patch["reach"] + cover + solids[s]["uneven"]):
                one["solid"] = s
                patch["near"] += 1


@kernel(error_model="numpy")
def _bring_near(
    body_pos: NDArray[np.float64],
    body_mat: NDArray[np.float64],
    body_velocity: NDArray[np.float64],
    root_centre: NDArray[np.float64],
    root_of: NDArray[np.int64],
    link: int,
    solid: np.void,
    one: np.void,
) -> None:
    """Write the pose and the velocities of a solid in a link's frame into `one`, whose dtype is `NEAR`."""
    body, mat, offset = solid["body"], solid["mat"], solid["pos"]
    pos, turn, spin, drift = one["pos"], one["turn"], one["spin"], one["drift"]
    push, twist, travel = one["push"], one["twist"], solid["travel"]
    for i in range(3):
        pos[i] = drift[i] = spin[i] = push[i] = twist[i] = 0.0
        for j in range(3):
            turn[i, j] = 0.0
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        place = body_pos[body, i]
        for m in range(3):
            place += body_mat[body, 3 * i + m] * offset[m]
        place -= body_pos[link, i]
        # Velocity of the body at the link's origin, relative to the link.
        velocity = body_velocity[body, 3 + i] - body_velocity[link, 3 + i] + travel[i]
        rj, rk = body_pos[link, j] - root_centre[root_of[body], j], body_pos[link, k] - root_centre[root_of[body], k]
        velocity += body_velocity[body, j] * rk - body_velocity[body, k] * rj
        rj, rk = body_pos[link, j] - root_centre[root_of[link], j], body_pos[link, k] - root_centre[root_of[link], k]
        velocity -= body_velocity[link, j] * rk - body_velocity[link, k] * rj
        turning = body_velocity[body, i] - body_velocity[link, i]
        for j in range(3):
            whole = 0.0
            for k in range(3):
                whole += body_mat[body, 3 * i + k] * mat[k, j]
            for k in range(3):
                turn[k, j] += body_mat[link, 3 * i + k] * whole
        for k in range(3):
            pos[k] += body_mat[link, 3 * i + k] * place
            drift[k] += body_mat[link, 3 * i + k] * velocity
            spin[k] += body_mat[link, 3 * i + k] * turning


@kernel(error_model="numpy")
def add_wrenches(
    bodies: Bodies,
    patches: NDArray[np.void],
    solids: NDArray[np.void],
    near: NDArray[np.void],
    pressed: NDArray[np.float64],
) -> None:
    """Add the forces in `near` to the wrenches on the links, and their opposites to those on the solids' bodies.

    Only of the patches whose `pressed`, shape (patches,), is above 0.
    """
    pos, mat, centre, wrench = bodies.pos, bodies.mat, bodies.centre, bodies.wrench
    force, torque = np.empty(3), np.empty(3)
    for p in range(len(patches)):
        link = patches[p]["body"]
        for k in range(patches[p]["near"] if pressed[p] > 0.0 else 0):
            push, twist = near[p, k]["push"], near[p, k]["twist"]
            for body, sign in ((link, 1.0), (solids[near[p, k]["solid"]]["body"], -1.0)):
                for i in range(3):
                    force[i] = torque[i] = 0.0
                    for j in range(3):
                        force[i] += sign * mat[link, 3 * i + j] * push[j]
                        torque[i] += sign * mat[link, 3 * i + j] * twist[j]
                for i in range(3):
                    a, b = (i + 1) % 3, (i + 2) % 3
                    ra, rb = pos[link, a] - centre[body, a], pos[link, b] - centre[body, b]
                    wrench[body, i] += force[i]
                    wrench[body, 3 + i] += torque[i] + ra * force[b] - rb * force[a]
