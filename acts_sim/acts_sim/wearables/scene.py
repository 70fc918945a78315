# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A worn skin to which something happens: full frames as a board would read them, with what really happened beside."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX
from acts_core.registry import named
from acts_core.skin import Layout, layout
from acts_sim.pressing import ContactModel, FoamConfig
from acts_sim.wearables.contacts import Contact
from acts_sim.wearables.resting_skin import RestingSkin
from acts_sim.wearables.scenes import SCENES, SceneKind

WORN_RATE_HZ = 4000.0
"""Frames per second of a scene; between them what is sampled is interpolated linearly."""

_UNTOUCHED_S = (0.15, 0.25)

# For so long after a first touch anything is fast; later all is slow but what is over by then.
_FAST_S = 0.025
_SLOW_STEP = 12

# The driver's baseline follows drift with this time constant, and was measured in 2 s: some 100 readings of 3 counts.
_LAG_S = 60.0
_CALIBRATION_COUNTS = 0.3


@dataclass(frozen=True)
class WornScene:
    """A recording of a worn skin, and the truth.

    Attributes
    ----------
    kind : SceneKind
    layout : Layout
    frames : np.ndarray [shape=(n, rows, cols), dtype=uint16]
        Counts of the matrix at `WORN_RATE_HZ`, with the offsets of an untouched skin; free of the noise of a reading,
        which whoever samples them adds.
    baseline : np.ndarray [shape=(rows * cols,), dtype=float32]
        What the driver takes each taxel of the matrix to read untouched: measured, and a minute behind the drift.
    contacts : tuple of Contact
        In the order of time, which counts from the first frame.
    skin : ContactModel
        Of the picture.
    """

    kind: SceneKind
    layout: Layout
    frames: NDArray[np.uint16]
    baseline: NDArray[np.float32]
    contacts: tuple[Contact, ...]
    skin: ContactModel

    @property
    def duration_s(self) -> float:
        """From the first frame to the last [s]."""
        return (len(self.frames) - 1) / WORN_RATE_HZ

    @property
    def events(self) -> tuple[Contact, ...]:
        """Contacts whose onset is to be told."""
        return tuple(one for one in self.contacts if one.is_event)

    def is_touched(self, first_s: float, last_s: float) -> bool:
        """Whether anything touches between two times."""
        return any(one.onset_s < last_s and first_s < one.end_s for one in self.contacts)

    def force_n(self, time_s: float) -> float:
        """True force on all of the skin at a time [N]."""
        return float(_forces_n(self.skin, self.contacts, time_s).sum())


def worn_scene(name: str, rng: np.random.Generator) -> WornScene:
    """Make a scene.

    Parameters
    ----------
    name : str
        One of `SCENES`.
    rng : np.random.Generator

    Raises
    ------
    SettingsError
        When there is no such scene.
    """
    kind = named(name, SCENES, "scene")
    arranged = layout(kind.layout)
    foam = FoamConfig(stiffness_n_per_m3=kind.stiffness_n_per_m3, noise_counts=0.0, subsamples=2)
    skin = ContactModel(arranged.geometry(), foam, seed=int(rng.integers(2**31)))
    before_s, after_s = rng.uniform(*_UNTOUCHED_S, 2).tolist()
    contacts = tuple(kind.make(rng, arranged, before_s))
    count = int((max(one.end_s for one in contacts) + after_s) * WORN_RATE_HZ) + 1
    resting = RestingSkin(arranged.taxels.size, rng)
    now_s = float(rng.uniform(_LAG_S, 10 * _LAG_S))
    baseline = resting.counts(now_s - _LAG_S) + _CALIBRATION_COUNTS * rng.standard_normal(arranged.taxels.size)
    np.clip(baseline, 0, COUNT_MAX, out=baseline)  # a mean of readings
    untouched = np.rint(resting.counts(now_s)).astype(np.uint16).reshape(arranged.matrix_rows, arranged.matrix_cols)
    frames = np.tile(untouched, (count, 1, 1))
    _add_touch(frames, skin, arranged, contacts)
    np.minimum(frames, COUNT_MAX, out=frames)
    return WornScene(kind, arranged, frames, baseline.astype(np.float32), contacts, skin)


def _add_touch(frames: NDArray[np.uint16], skin: ContactModel, arranged: Layout, contacts: Sequence[Contact]) -> None:
    """Add the counts of the contacts, of every frame while something is fast, else of every few and between linear."""
    known, known_counts = 0, np.zeros(frames.shape[1:])
    for number in range(1, len(frames)):
        time_s = number / WORN_RATE_HZ
        on = [one for one in contacts if one.is_on(time_s)]
        is_fast = any(one.end_s - one.onset_s < _FAST_S or time_s - one.onset_s < _FAST_S for one in on)
        if on and not is_fast and number - known < _SLOW_STEP:
            continue
        counts = np.zeros(frames.shape[1:])
        if on:
            counts += arranged.matrix(skin.counts(_forces_n(skin, on, time_s))).astype(np.float64)
        if counts.any() or known_counts.any():
            share = (np.arange(known + 1, number + 1) - known)[:, None, None] / (number - known)
            frames[known + 1 : number + 1] += np.rint(known_counts + share * (counts - known_counts)).astype(np.uint16)
        known, known_counts = number, counts


def _forces_n(skin: ContactModel, contacts: Sequence[Contact], time_s: float) -> NDArray[np.float64]:
    forces_n = np.zeros((skin.geometry.rows, skin.geometry.cols))
    for one in contacts:
        if one.is_on(time_s):
            forces_n += one.forces_n(skin, time_s)
    return forces_n
