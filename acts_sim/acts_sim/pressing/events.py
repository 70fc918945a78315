# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Fast events on a skin, as full frames at a high rate: bounces, slides, taps, one contact after another.

Frames contain no noise, so that it can be added to each sample. To add a kind of event, write a function from a random
generator to frames and register it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.registry import named, registering
from acts_sim.pressing.contact_model import ContactModel, Press, skin_of
from acts_sim.pressing.event_contacts import GOLF_BALL, SLIDING
from acts_sim.pressing.objects import ContactObject

EVENT_RATE_HZ = 4000.0
"""Frames per second of every event."""

BOUNCE_S = 0.0087
"""Duration of a contact of a bouncing ball, in the paper's shortest recordings [s]."""

_SIDE = 32

Frames = NDArray[np.uint16]
Make = Callable[[np.random.Generator], Frames]


@dataclass(frozen=True)
class Event:
    """A kind of event.

    Attributes
    ----------
    name : str
    recordings : int
        Number of recordings that is enough for steady figures.
    make : callable
        Function from a random generator to one recording (n, 32, 32) uint16 at `EVENT_RATE_HZ`.
    """

    name: str
    recordings: int
    make: Make


EVENTS: dict[str, Event] = {}
"""Every registered kind of event, in order of definition."""


def register(name: str, recordings: int) -> Callable[[Make], Make]:
    """Register the decorated function in `EVENTS`.

    Raises
    ------
    SettingsError
        When there is an event of this name already.
    """
    return registering(name, EVENTS, "event", lambda make: Event(name, recordings, make))


def event_recordings(name: str, recordings: int, seed: int) -> list[Frames]:
    """Recordings of one kind of event; each depends on its index and the seed only, not on their number.

    Raises
    ------
    SettingsError
        When there is no such kind.
    """
    event = named(name, EVENTS, "event")
    return [event.make(np.random.default_rng([seed, number])) for number in range(recordings)]


@register("bounce", 40)
def _bounce(rng: np.random.Generator) -> Frames:
    """A golf ball hits a random position three times for 8.7 ms; its depth is a half sine."""
    model = skin_of(rng)
    x_m, y_m = rng.uniform(-0.055, 0.055, 2)
    depth_m = rng.uniform(0.001, 0.003)
    contact = np.sin(np.pi * np.arange(_n(BOUNCE_S) + 1) / _n(BOUNCE_S))
    once = np.stack([_frame(model, GOLF_BALL, Press(x_m, y_m, depth_m=depth_m * share)) for share in contact])
    return np.concatenate([part for _ in range(3) for part in (_untouched(rng), once)] + [_untouched(rng)])


def _slide(speed_m_s: float) -> Make:
    """An object of random size comes down, rests for 20 ms, and slides straight for up to 100 mm or 400 ms."""

    def make(rng: np.random.Generator) -> Frames:
        model = skin_of(rng)
        item = SLIDING[int(rng.integers(len(SLIDING)))]
        depth_m = item.depth_m[0] + rng.uniform(0.4, 1.0) * (item.depth_m[1] - item.depth_m[0])
        course = rng.uniform(0, 2 * np.pi)
        length_m = min(0.1, 0.4 * speed_m_s)
        aside_m, first_m = rng.uniform(-0.02, 0.02), -length_m / 2
        standing = np.concatenate((np.linspace(0, 1, _n(0.005)), np.ones(_n(0.015))))
        along_m = first_m + np.arange(int(length_m / speed_m_s * EVENT_RATE_HZ)) * speed_m_s / EVENT_RATE_HZ
        shares = np.concatenate((standing, np.ones(len(along_m))))
        along_m = np.concatenate((np.full(len(standing), first_m), along_m))
        c, s = math.cos(course), math.sin(course)
        path = [
            _frame(
                model,
                item,
                Press(a * c - aside_m * s, a * s + aside_m * c, angle_rad=course, depth_m=depth_m * share),
            )
            for a, share in zip(along_m.tolist(), shares.tolist(), strict=True)
        ]
        return np.concatenate((_untouched(rng), np.stack(path)))

    return make


for _speed_m_s in (0.1, 0.5, 1.0, 2.0):
    register(f"slide_{_speed_m_s:g}_m_s", 10)(_slide(_speed_m_s))


def _tap(side: int) -> Make:
    """Exactly `side` x `side` taxels at a random position and time are pressed for 30 ms, rising in 0.5 ms."""

    def make(rng: np.random.Generator) -> Frames:
        return np.concatenate((_untouched(rng), _tapped(rng, side, 0.030), _untouched(rng)))

    return make


register("tap_2x2", 400)(_tap(2))
register("tap_4x4", 400)(_tap(4))


@register("two_taps", 100)
def _two_taps(rng: np.random.Generator) -> Frames:
    """A tap of 4 x 4 taxels stays, and another of 2 x 2 comes elsewhere."""
    while True:
        first, second = _tapped(rng, 4, 0.150), _tapped(rng, 2, 0.060)
        if not _near(first[-1] > 0, second[-1] > 0):
            break
    begin = int(rng.integers(_n(0.030), _n(0.080)))
    first[begin : begin + len(second)] += second
    return np.concatenate((_untouched(rng), first, _untouched(rng)))


def _near(one: NDArray[np.bool_], other: NDArray[np.bool_]) -> bool:
    """Whether two contacts are less than three taxels apart."""
    (rows, cols), (other_rows, other_cols) = np.nonzero(one), np.nonzero(other)
    apart = np.maximum(abs(rows[:, None] - other_rows), abs(cols[:, None] - other_cols))
    return bool(apart.min() < 4)


def _tapped(rng: np.random.Generator, side: int, duration_s: float) -> Frames:
    frames = np.zeros((_n(duration_s), _SIDE, _SIDE), dtype=np.uint16)
    row, col = rng.integers(0, _SIDE - side + 1, 2)
    counts = int(rng.integers(150, 800))
    frames[:, row : row + side, col : col + side] = counts
    frames[0] //= 2
    return frames


def _untouched(rng: np.random.Generator) -> Frames:
    """10 to 50 ms without touch, so that events begin at a random phase of the search."""
    return np.zeros((int(rng.integers(_n(0.010), _n(0.050))), _SIDE, _SIDE), dtype=np.uint16)


def _frame(model: ContactModel, item: ContactObject, press: Press) -> Frames:
    return model.counts(model.forces_n(item, press))


def _n(duration_s: float) -> int:
    return round(duration_s * EVENT_RATE_HZ)
