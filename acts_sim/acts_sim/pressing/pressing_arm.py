# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Objects pressed repeatedly by an arm at nearly the same spot, as in the paper's trials.

"The robot repeatedly moved the object into the sensor at a repetitive spot and speed for each object" (paper, methods).
Every object is held straight and has a spot near the centre of the skin. Each press has small random errors of position
and angle, and a random tilt. It goes down at constant speed to a random depth and stays there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_sim.pressing.contact_model import ContactModel, FoamConfig, Press
from acts_sim.pressing.objects import OBJECTS, ContactObject

RATE_HZ = 1000.0
"""Frames per second of a recorded press."""


@dataclass(frozen=True)
class PressingConfig:
    """How an arm presses objects.

    The precision of the paper's arm and gripper is not published. `miss_taxels` and `miss_deg` are chosen such that the
    paper's method has about its published accuracies (docs/recovery.md).
    """

    spot_taxels: float = setting(
        1.0, "largest distance of an object's spot from the centre, per axis [taxels]", minimum=0, maximum=32
    )
    miss_taxels: float = setting(
        0.15, "standard deviation of a press's position about its spot, per axis [taxels]", minimum=0, maximum=32
    )
    miss_deg: float = setting(1.5, "standard deviation of the angle of a press [degrees]", minimum=0, maximum=180)
    tilt: float = setting(0.015, "standard deviation of the slope of an object, per axis", minimum=0, maximum=1)
    shallowest: float = setting(
        0.75, "smallest depth of a press, relative to the object's largest", minimum=0.01, maximum=1
    )
    rise_min_s: float = setting(0.020, "shortest time to the full depth [s]", minimum=0.001, maximum=10)
    rise_max_s: float = setting(0.030, "longest time to the full depth [s]", minimum=0.001, maximum=10)

    def __post_init__(self) -> None:
        validate(self)
        if self.rise_min_s > self.rise_max_s:
            raise SettingsError(
                f"rise_min_s = {self.rise_min_s:g}: allowed is rise_max_s = {self.rise_max_s:g} or less"
            )


class PressingArm:
    """An arm, a skin, and a spot for every object.

    Parameters
    ----------
    objects : sequence of ContactObject, optional
        By default all registered ones.
    config : PressingConfig, optional
    foam : FoamConfig, optional
    seed : int
        Seed of the spots, the presses, the skin's sensitivities and its noise: the same calls in the same order give
        the same frames.
    """

    def __init__(
        self,
        objects: Sequence[ContactObject] | None = None,
        config: PressingConfig | None = None,
        foam: FoamConfig | None = None,
        *,
        seed: int = 0,
    ) -> None:
        self.objects = tuple(OBJECTS.values()) if objects is None else tuple(objects)
        self.config = config or PressingConfig()
        self.model = ContactModel(config=foam, seed=seed)
        self._rng = np.random.default_rng(np.random.SeedSequence(seed).spawn(1)[0])
        self._spots = (2 * self._rng.random((len(self.objects), 2)) - 1) * self.config.spot_taxels

    def press(self, number: int) -> Press:
        """A new press of an object, by its index in `objects`."""
        config, pitch_m = self.config, self.model.geometry.pitch_m
        place_m = (self._spots[number] + config.miss_taxels * self._rng.standard_normal(2)) * pitch_m
        turn, tilt_x, tilt_y = self._rng.standard_normal(3)
        depth = config.shallowest + (1 - config.shallowest) * self._rng.random()
        return Press(
            x_m=float(place_m[0]),
            y_m=float(place_m[1]),
            angle_rad=math.radians(config.miss_deg * turn),
            depth_m=float(depth * self.objects[number].depth_m[1]),
            tilt_x=float(config.tilt * tilt_x),
            tilt_y=float(config.tilt * tilt_y),
        )

    def held_frame(self, number: int) -> NDArray[np.uint16]:
        """A full frame from the middle of a new press; np.ndarray [shape=(rows, cols), dtype=uint16]."""
        return self.model.counts(self.model.forces_n(self.objects[number], self.press(number)))

    def held_frames(self, presses: int) -> tuple[NDArray[np.uint16], list[str]]:
        """Full frames from the middle of presses of every object.

        Parameters
        ----------
        presses : int
            Of each object.

        Returns
        -------
        frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        names : list of str
            The object in each.
        """
        frames = [self.held_frame(number) for number in range(len(self.objects)) for _ in range(presses)]
        return np.stack(frames), [item.name for item in self.objects for _ in range(presses)]

    def recording(self, number: int, before_s: float, after_s: float) -> NDArray[np.uint16]:
        """Record a new press.

        Parameters
        ----------
        number : int
            Index of the object in `objects`.
        before_s, after_s : float
            Time before and after the object touches the foam [s].

        Returns
        -------
        np.ndarray [shape=(n, rows, cols), dtype=uint16]
            `RATE_HZ` frames per second.
        """
        item, press = self.objects[number], self.press(number)
        rise_s = self.config.rise_min_s + (self.config.rise_max_s - self.config.rise_min_s) * self._rng.random()
        times_s = np.arange(round((before_s + after_s) * RATE_HZ)) / RATE_HZ - before_s
        nothing = np.zeros((self.model.geometry.rows, self.model.geometry.cols))
        held = self.model.forces_n(item, press)
        frames = []
        for time_s in times_s:
            share = time_s / rise_s
            if share <= 0:
                forces_n = nothing
            elif share >= 1:
                forces_n = held
            else:
                forces_n = self.model.forces_n(item, replace(press, depth_m=press.depth_m * share))
            frames.append(self.model.counts(forces_n))
        return np.stack(frames)
