# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A soft object meets a skin: full frames as a board would read them, and the true outline beside."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_sim.deforming.bodies import Body
from acts_sim.impacts import SCENE_RATE_HZ
from acts_sim.pressing import ContactModel

Array = NDArray[np.float64]

_UNTOUCHED_S = (0.045, 0.065)
_LEAST_DEPTH = 0.002
"""Of the deepest: less is no touch."""

_MIDDLE_M = 0.01
"""How far from the skin's middle a body may first touch, along x and along y."""


@dataclass(frozen=True)
class SoftContact:
    """A recording of one body, and the truth.

    Attributes
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts at `SCENE_RATE_HZ`; free of the noise of a reading, which whoever samples them adds.
    body : Body
    begin_s : float
        When it first touches, on the clock of the frames [s].
    x_m, y_m, angle_rad, size : float
        Where it first touches, how it is turned about z, and its deepest, as a share of the body's.
    """

    frames: NDArray[np.uint16]
    body: Body
    begin_s: float
    x_m: float
    y_m: float
    angle_rad: float
    size: float

    @property
    def duration_s(self) -> float:
        """From the first frame to the last [s]."""
        return (len(self.frames) - 1) / SCENE_RATE_HZ

    @property
    def end_s(self) -> float:
        """When it last touches [s]."""
        return self.begin_s + self.body.touch_s

    def depth_m(self, time_s: float) -> float:
        """How far the body is pressed together [m]: half a sine wave, as of a mass on a spring; 0 without touch."""
        share = (time_s - self.begin_s) / self.body.touch_s
        return self.size * self.body.depth_m * float(np.sin(np.pi * share)) if 0 < share < 1 else 0.0

    def outline_m(self, time_s: float) -> Array:
        """Corners of the contact's edge in the skin's frame [m]; shape (n, 2), not closed; empty without touch."""
        depth_m = self.depth_m(time_s)
        if depth_m <= _LEAST_DEPTH * self.body.depth_m:
            return np.zeros((0, 2))
        c, s = np.cos(self.angle_rad), np.sin(self.angle_rad)
        turned: Array = self.body.outline_m(depth_m) @ np.array([[c, s], [-s, c]])
        return turned + np.array([self.x_m, self.y_m])


def soft_contact(skin: ContactModel, body: Body, rng: np.random.Generator) -> SoftContact:
    """Let a body meet a skin once, somewhere near its middle.

    Parameters
    ----------
    skin : ContactModel
        Without noise of its own, see `acts_sim.pressing.skin_of`.
    body : Body
    rng : np.random.Generator
        Of place, angle, strength and the time before.
    """
    before_s, after_s = rng.uniform(*_UNTOUCHED_S, 2).tolist()
    x_m, y_m = rng.uniform(-_MIDDLE_M, _MIDDLE_M, 2).tolist()
    count = int((before_s + body.touch_s + after_s) * SCENE_RATE_HZ) + 1
    frames = np.zeros((count, skin.geometry.rows, skin.geometry.cols), dtype=np.uint16)
    shown = SoftContact(
        frames, body, before_s, x_m, y_m, float(rng.uniform(0, 2 * np.pi)), float(rng.uniform(0.8, 1.1))
    )
    c, s = np.cos(shown.angle_rad), np.sin(shown.angle_rad)
    for number in range(int(before_s * SCENE_RATE_HZ), int(shown.end_s * SCENE_RATE_HZ) + 1):
        depth_m = shown.depth_m(number / SCENE_RATE_HZ)
        if depth_m <= 0:
            continue

        def pressure_pa(x: Array, y: Array, depth_m: float = depth_m) -> Array:
            dx, dy = x - x_m, y - y_m
            return body.pressure_pa(c * dx + s * dy, -s * dx + c * dy, depth_m)

        frames[number] = skin.counts(skin.forces_under(pressure_pa))
    return shown
