# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Balls on a skin: full frames as a board would read them, with what really happened beside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_sim.impacts.balls import Ball
from acts_sim.impacts.throw import Collision, Throw, collide
from acts_sim.pressing import ContactModel

SCENE_RATE_HZ = 8000.0
"""Frames per second of a scene; between them what is sampled is interpolated linearly."""

_UNTOUCHED_S = (0.010, 0.030)


@dataclass(frozen=True)
class Scene:
    """A recording of balls, and the truth.

    Attributes
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts at `SCENE_RATE_HZ`; free of the noise of a reading, which whoever samples them adds.
    collisions : tuple of Collision
        In the order of time, which counts from the first frame.
    """

    frames: NDArray[np.uint16]
    collisions: tuple[Collision, ...]

    @property
    def duration_s(self) -> float:
        """From the first frame to the last [s]."""
        return (len(self.frames) - 1) / SCENE_RATE_HZ


def scene(
    skin: ContactModel,
    ball: Ball,
    throw: Throw,
    *,
    bounces: int = 1,
    untouched_s: float | None = None,
    rng: np.random.Generator,
) -> Scene:
    """Let a ball bounce on a skin.

    Parameters
    ----------
    skin : ContactModel
    ball : Ball
    throw : Throw
    bounces : int
        How often it meets the skin, at most; it is caught after the last, or where it leaves the array or rests.
    untouched_s : float, optional
        How long the skin is untouched before and after [s]; without it random, 10 to 30 ms each, so that a bounce
        begins at any moment of a board's frame.
    rng : np.random.Generator

    Raises
    ------
    SettingsError
        When fewer than one bounce is asked for, or the ball does not bounce (see `collide`).
    """
    if bounces < 1:
        raise SettingsError(f"bounces = {bounces}: allowed is 1 or more")
    before_s, after_s = (untouched_s,) * 2 if untouched_s is not None else rng.uniform(*_UNTOUCHED_S, 2)
    collisions: list[Collision] = []
    coming: Throw | None = throw
    at_s = float(before_s)
    while coming is not None and len(collisions) < bounces and (not collisions or _is_on(skin, coming)):
        collisions.append(collide(ball, coming, at_s))
        coming, at_s = collisions[-1].after, collisions[-1].after_s
    count = int((collisions[-1].time_s[-1] + after_s) * SCENE_RATE_HZ) + 1
    frames = np.zeros((count, skin.geometry.rows, skin.geometry.cols), dtype=np.uint16)
    for collision in collisions:
        _draw(frames, skin, ball, collision)
    return Scene(frames, tuple(collisions))


def _is_on(skin: ContactModel, throw: Throw) -> bool:
    geometry = skin.geometry
    half_x_m, half_y_m = geometry.cols * geometry.pitch_m / 2, geometry.rows * geometry.pitch_y_m / 2
    return abs(throw.x_m) <= half_x_m and abs(throw.y_m) <= half_y_m


def _draw(frames: NDArray[np.uint16], skin: ContactModel, ball: Ball, collision: Collision) -> None:
    """Write the counts of one collision into the frames it lies in."""
    first = int(np.ceil(collision.time_s[0] * SCENE_RATE_HZ))
    last = min(int(collision.time_s[-1] * SCENE_RATE_HZ), len(frames) - 1)
    at_s = np.arange(first, last + 1) / SCENE_RATE_HZ
    columns = (collision.x_m, collision.y_m, collision.depth_m, collision.force_n)
    states = np.column_stack([np.interp(at_s, collision.time_s, column) for column in columns])
    for number, state in enumerate(states.tolist(), start=first):
        frames[number] = skin.counts(footprint_n(skin, ball, state))


def footprint_n(skin: ContactModel, ball: Ball, state: Sequence[float]) -> NDArray[np.float64]:
    """Force on every taxel under a ball: Hertz's pressure on a disc that grows with the depth, spread by the foam.

    Parameters
    ----------
    skin : ContactModel
    ball : Ball
    state : sequence of float
        x, y and depth [m], and normal force [N].

    Returns
    -------
    np.ndarray [shape=(rows, cols), dtype=float64]
    """
    x_m, y_m, depth_m, force_n = state
    # Not smaller than the points that the model's foam is made of.
    point_m = skin.geometry.pitch_m / skin.config.subsamples
    square_m2 = max(ball.radius_m * depth_m, point_m**2)
    top_pa = 1.5 * force_n / (np.pi * square_m2)

    def pressure_pa(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
        inside = np.maximum(1.0 - ((x - x_m) ** 2 + (y - y_m) ** 2) / square_m2, 0.0)
        pressure: NDArray[np.float64] = top_pa * np.sqrt(inside)
        return pressure

    return skin.forces_under(pressure_pa)
