# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What touches a worn skin: something pressed in by a motion, a ball, or a bullet of foam."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from acts_sim.impacts import Ball, Collision, footprint_n
from acts_sim.pressing import ContactModel, ContactObject, Field, Press
from acts_sim.wearables.bodies import Depth

Forces = NDArray[np.float64]


class Contact(ABC):
    """One thing that touches the skin once.

    Attributes
    ----------
    onset_s, end_s : float
        When it first and last touches, on the scene's clock [s].
    x_m, y_m : float
        Where it first touches, in the skin's frame [m].
    is_event : bool
        Whether its first touch is an event of the scene; else it is a part of one that began before.
    """

    def __init__(self, onset_s: float, end_s: float, x_m: float, y_m: float, *, is_event: bool = True) -> None:
        self.onset_s, self.end_s = onset_s, end_s
        self.x_m, self.y_m = x_m, y_m
        self.is_event = is_event

    def is_on(self, time_s: float) -> bool:
        """Whether it touches at a time."""
        return self.onset_s < time_s < self.end_s

    @abstractmethod
    def forces_n(self, skin: ContactModel, time_s: float) -> Forces:
        """Force on every taxel of the picture [N] at a time between the two; shape (rows, cols)."""


class Pressing(Contact):
    """An object that is pressed in by a motion: a hand, a foot."""

    def __init__(
        self,
        item: ContactObject,
        depth: Depth,
        span_s: tuple[float, float],
        place_m: tuple[float, float],
        angle_rad: float = 0.0,
        *,
        is_event: bool = True,
    ) -> None:
        super().__init__(*span_s, *place_m, is_event=is_event)
        self._item, self._depth, self._angle_rad = item, depth, angle_rad

    def forces_n(self, skin: ContactModel, time_s: float) -> Forces:
        """See `Contact`."""
        depth_m = self._depth(time_s - self.onset_s)
        return skin.forces_n(self._item, Press(self.x_m, self.y_m, angle_rad=self._angle_rad, depth_m=depth_m))


class Bouncing(Contact):
    """A ball that collides."""

    def __init__(self, ball: Ball, collision: Collision) -> None:
        time_s = collision.time_s
        place_m = float(collision.x_m[0]), float(collision.y_m[0])
        super().__init__(float(time_s[0]), float(time_s[-1]), *place_m)
        self._ball, self._collision = ball, collision

    def forces_n(self, skin: ContactModel, time_s: float) -> Forces:
        """See `Contact`."""
        one = self._collision
        columns = (one.x_m, one.y_m, one.depth_m, one.force_n)
        return footprint_n(skin, self._ball, [float(np.interp(time_s, one.time_s, column)) for column in columns])


class Caught(Bouncing):
    """A ball that collides and is held from then on: with the larger of the force of the collision and that of a grip.

    `grip_n` is the force of the grip [N] by the time since the first touch [s].
    """

    def __init__(self, ball: Ball, collision: Collision, grip_n: Callable[[float], float], end_s: float) -> None:
        super().__init__(ball, collision)
        self.end_s = end_s
        self._grip_n = grip_n

    def forces_n(self, skin: ContactModel, time_s: float) -> Forces:
        """See `Contact`."""
        one = self._collision
        force_n = float(np.interp(time_s, one.time_s, one.force_n, right=0.0))
        force_n = max(force_n, self._grip_n(time_s - self.onset_s))
        # Hertz's law back from the force, since a grip has no depth of its own.
        depth_m = (force_n / self._ball.stiffness_n_per_m15) ** (2 / 3)
        return footprint_n(skin, self._ball, (self.x_m, self.y_m, depth_m, force_n))


class Bullet(Contact):
    """A column of foam with a flat end: its footprint does not grow with its force."""

    def __init__(self, radius_m: float, collision: Collision) -> None:
        time_s = collision.time_s
        super().__init__(float(time_s[0]), float(time_s[-1]), float(collision.x_m[0]), float(collision.y_m[0]))
        self._radius_m, self._collision = radius_m, collision

    def forces_n(self, skin: ContactModel, time_s: float) -> Forces:
        """See `Contact`."""

        def flat(x_m: Field, y_m: Field) -> Field:
            return (np.hypot(x_m - self.x_m, y_m - self.y_m) <= self._radius_m).astype(float)

        share = skin.forces_under(flat)
        force_n = float(np.interp(time_s, self._collision.time_s, self._collision.force_n))
        # The foam's points are coarse: the end carries all of the force.
        return share * (force_n / share.sum())
