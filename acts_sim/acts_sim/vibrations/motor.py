# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A motor with an unbalanced rotor that is held onto a skin by a hand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_sim.pressing import ContactModel

Array = NDArray[np.float64]

VIBRATION_RATE_HZ = 16000.0
"""Frames per second of a vibration; of a tone of 400 Hz linear interpolation between them leaves 99.8 %."""

_AT_ONCE = 1000
# A hand: slow tones, of which the largest is of about this share of the force.
_WANDER, _WANDER_HZ = 0.03, (0.3, 3.0)
_WANDER_TONES = 4


@dataclass(frozen=True)
class Motor:
    """A motor in a case with a flat, round foot.

    The rotor's pull turns. Its part along z makes the force on the skin rise and fall; the part along the skin makes
    the case rock, so that the pressure is larger now on one side, now on the other.
    """

    frequency_hz: float = setting(100.0, "turns of the rotor a second [Hz]", minimum=0.1, maximum=2000.0)
    force_n: float = setting(6.0, "with which it is held [N]", minimum=0.01, maximum=100.0)
    amplitude_n: float = setting(0.6, "of the force [N]", minimum=0.0, maximum=100.0)
    overtone: float = setting(
        0.0, "amplitude at twice the frequency, as a share of the first", minimum=0.0, maximum=1.0
    )
    rocking: float = setting(
        0.0, "how much more the edge of the foot presses than its middle, at most, as a share", minimum=0.0, maximum=0.5
    )
    radius_m: float = setting(0.010, "of the foot [m]", minimum=0.002, maximum=0.1)
    x_m: float = setting(0.0, "where it stands [m]", minimum=-1.0, maximum=1.0)
    y_m: float = setting(0.0, "where it stands [m]", minimum=-1.0, maximum=1.0)

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True)
class Vibration:
    """A recording of a motor, and the truth.

    Attributes
    ----------
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts at `VIBRATION_RATE_HZ`; free of the noise of a reading, which whoever samples them adds.
    force_n : np.ndarray [shape=(n,), dtype=float64]
        On the skin.
    motor : Motor
    """

    frames: NDArray[np.uint16]
    force_n: Array
    motor: Motor

    @property
    def duration_s(self) -> float:
        """From the first frame to the last [s]."""
        return (len(self.frames) - 1) / VIBRATION_RATE_HZ


def vibration(skin: ContactModel, motor: Motor, duration_s: float, rng: np.random.Generator) -> Vibration:
    """Hold a motor on a skin.

    Parameters
    ----------
    skin : ContactModel
        Without noise of its own, see `acts_sim.pressing.skin_of`.
    motor : Motor
    duration_s : float
    rng : np.random.Generator
        Of the phases, and of the hand: slow tones up to 3 Hz of some percent of the force.

    Raises
    ------
    SettingsError
        When the motor's foot reaches beyond the skin: an edge cannot carry what is beside it.
    """
    time_s = np.arange(int(duration_s * VIBRATION_RATE_HZ) + 1) / VIBRATION_RATE_HZ
    angle = 2 * np.pi * motor.frequency_hz * time_s + rng.uniform(0, 2 * np.pi)
    force_n = motor.force_n + motor.amplitude_n * np.cos(angle)
    force_n += motor.overtone * motor.amplitude_n * np.cos(2 * angle + rng.uniform(0, 2 * np.pi))
    for slow_hz in rng.uniform(*_WANDER_HZ, _WANDER_TONES):
        size_n = rng.uniform(0, _WANDER) * motor.force_n
        force_n += size_n * np.cos(2 * np.pi * slow_hz * time_s + rng.uniform(0, 2 * np.pi))
    force_n = np.maximum(force_n, 0.0)
    way = rng.uniform(0, 2 * np.pi)
    tilt = motor.rocking * np.sin(angle)[:, None] * np.array([np.cos(way), np.sin(way)])
    flat, along_x, along_y = _foot(skin, motor)
    frames = np.zeros((time_s.size, *flat.shape), dtype=np.uint16)
    for first in range(0, time_s.size, _AT_ONCE):
        part = np.s_[first : first + _AT_ONCE]
        share = flat + tilt[part, 0, None, None] * along_x + tilt[part, 1, None, None] * along_y
        frames[part] = skin.counts(force_n[part, None, None] * share)
    return Vibration(frames, force_n, motor)


def _foot(skin: ContactModel, motor: Motor) -> tuple[Array, Array, Array]:
    """The share of the force on each taxel, and how it changes with the tilt along x and along y."""
    area_m2 = np.pi * motor.radius_m**2

    def part(of: int) -> Array:
        def pressure_pa(x: Array, y: Array) -> Array:
            dx, dy = x - motor.x_m, y - motor.y_m
            factor = (np.ones_like(dx), dx / motor.radius_m, dy / motor.radius_m)[of]
            pressure: Array = np.where(np.hypot(dx, dy) <= motor.radius_m, factor, 0.0) / area_m2
            return pressure

        return skin.forces_under(pressure_pa)

    flat = part(0)
    # The foam's points are coarse: the foot carries all of the force.
    whole = flat.sum()
    half_x_m = skin.geometry.cols * skin.geometry.pitch_m / 2
    half_y_m = skin.geometry.rows * skin.geometry.pitch_y_m / 2
    overhangs = abs(motor.x_m) + motor.radius_m > half_x_m or abs(motor.y_m) + motor.radius_m > half_y_m
    if overhangs or not whole > 0.0:
        raise SettingsError(
            f"a motor at x_m = {motor.x_m:g}, y_m = {motor.y_m:g} with radius_m = {motor.radius_m:g} does not stand on "
            f"the skin with all of its foot: that reaches {half_x_m:g} m along x and {half_y_m:g} m along y to both "
            "sides of its middle, which is at 0"
        )
    return flat / whole, part(1) / whole, part(2) / whole
