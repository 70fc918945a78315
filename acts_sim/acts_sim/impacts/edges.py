# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Edges that strike a skin: full frames, as `scene` makes them of balls."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_sim.impacts.scene import SCENE_RATE_HZ, Scene
from acts_sim.pressing import ContactModel


@dataclass(frozen=True)
class Edge:
    """What strikes, and how: it comes straight down, and touches where it touches at once.

    Attributes
    ----------
    x_m, y_m : float
        Where its middle strikes [m].
    length_m, width_m : float
        Axes of the ellipse that it presses, before the foam spreads it [m].
    angle_rad : float
        Of its length, from x towards y.
    peak_n : float
        Largest force.
    touch_s : float
        How long it touches [s].
    """

    x_m: float
    y_m: float
    length_m: float
    width_m: float
    angle_rad: float
    peak_n: float
    touch_s: float


def struck(skin: ContactModel, edge: Edge, *, untouched_s: float) -> Scene:
    """The frames of a skin that an edge strikes; without collisions, which are those of balls.

    The pressure is half an ellipsoid over the ellipse. The depth is half a sine wave over time, and the force goes with
    it to the power 3/2, as of a ball.

    Parameters
    ----------
    skin : ContactModel
    edge : Edge
    untouched_s : float
        How long the skin is untouched before and after [s].
    """
    cos, sin = math.cos(edge.angle_rad), math.sin(edge.angle_rad)

    def pressure_pa(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
        along, across = cos * (x - edge.x_m) + sin * (y - edge.y_m), cos * (y - edge.y_m) - sin * (x - edge.x_m)
        inside = 1.0 - (2.0 * along / edge.length_m) ** 2 - (2.0 * across / edge.width_m) ** 2
        pressure: NDArray[np.float64] = np.sqrt(np.maximum(inside, 0.0))
        return pressure

    pressed = skin.forces_under(pressure_pa)
    # So that the taxels carry the force, however few points the foam is made of.
    pressed *= edge.peak_n / pressed.sum()
    at_s = np.arange(int((edge.touch_s + 2.0 * untouched_s) * SCENE_RATE_HZ) + 1) / SCENE_RATE_HZ
    depth = np.sin(np.pi * np.clip((at_s - untouched_s) / edge.touch_s, 0.0, 1.0))
    return Scene(np.stack([skin.counts(pressed * share) for share in np.maximum(depth, 0.0) ** 1.5]), ())
