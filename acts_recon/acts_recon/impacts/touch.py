# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""One touch while it goes on: what is kept of its frames, and what they say when it is over."""

from __future__ import annotations

import math
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from acts_recon.contacts import TrackedBlob
from acts_recon.impacts.config import ImpactConfig
from acts_recon.impacts.impact import Kind
from acts_recon.impacts.onset_fit import FollowedBack

MAX_FRAMES = 16384
"""Frames that are kept of a touch at most: those of the longest impact that can be set, at up to 32,000 frames/s."""

# Room for so many at first.
_FRAMES = 512

# A force that stands still at its largest for most of the time is held: nothing that flies does that.
_HELD_SHARE, _HELD_TIME, _HELD_S = 0.8, 0.7, 0.015
_FALLEN_SHARE = 0.5
# A contact so many times as long as wide is a long one; in the image of a few samples a round one may be twice.
_LONG = 4.0
# Hertz: the force of what meets the skin at a steady speed grows with time to this power.
_RISE_POWER = 1.5

_TIME, _FORCE, _X, _Y = range(4)

Places = TypeVar("Places", float, NDArray[np.float64])

Force = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Times and forces [s, N]."""


def reach_m_of(blob: TrackedBlob) -> float:
    """How far a contact reaches from its centre, about: the radius of a disc of its area, and a third more [m]."""
    return 1.3 * math.sqrt(blob.area_m2 / math.pi)


def _sides_m(blob: TrackedBlob) -> tuple[float, float]:
    """Length and width of the rectangle of a contact's area and spread; where it is round, those of a square [m]."""
    square_m2 = 12 * blob.spread_m**2
    both_m = math.sqrt(square_m2 + 2 * blob.area_m2)
    apart_m = math.sqrt(max(square_m2 - 2 * blob.area_m2, 0.0))
    return (both_m + apart_m) / 2, (both_m - apart_m) / 2


def lies_along(blob: TrackedBlob, x_m: float, y_m: float) -> bool:
    """Whether a place lies on a contact that is long: a rectangle of its area, spread and direction, twice as wide."""
    length_m, width_m = _sides_m(blob)
    along_m, across_m = turned(x_m - blob.x_m, y_m - blob.y_m, blob.angle_rad)
    return bool(abs(along_m) <= length_m / 2 and abs(across_m) <= width_m)


def turned(x: Places, y: Places, angle_rad: float) -> tuple[Places, Places]:
    """Parts of a vector along a direction, and across it."""
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return x * cos + y * sin, y * cos - x * sin


class Area(NamedTuple):
    """Where contacts lie: an ellipse about a place, its half axes [m], and the direction of the first of them [rad]."""

    x_m: float
    y_m: float
    along_m: float
    across_m: float
    angle_rad: float = 0.0

    @property
    def is_long(self) -> bool:
        """Whether it is no disc."""
        return self.along_m > self.across_m

    def holds(self, x_m: Places, y_m: Places) -> NDArray[np.bool_]:
        """Which places lie in it."""
        along_m, across_m = turned(x_m - self.x_m, y_m - self.y_m, self.angle_rad)
        is_in: NDArray[np.bool_] = np.hypot(along_m / self.along_m, across_m / self.across_m) <= 1.0
        return is_in


def area_of(blobs: list[TrackedBlob]) -> Area:
    """Of one that is long an ellipse, as long for its width; else a disc around the first, which is the strongest."""
    strongest = blobs[0]
    length_m, width_m = _sides_m(strongest)
    if len(blobs) == 1 and length_m > _LONG * width_m:
        longer, reach_m = math.sqrt(length_m / width_m), reach_m_of(strongest)
        return Area(strongest.x_m, strongest.y_m, reach_m * longer, reach_m / longer, strongest.angle_rad)
    reach_m = max(math.hypot(b.x_m - strongest.x_m, b.y_m - strongest.y_m) + reach_m_of(b) for b in blobs)
    return Area(strongest.x_m, strongest.y_m, reach_m, reach_m)


class Touch:
    """A touch from its first frame on.

    Parameters
    ----------
    number : int
    patch : int
        Rectangle of the image that it lies in.
    began_s, before_s : float
        End of its first frame and of the frame before [s].
    """

    def __init__(self, number: int, patch: int, began_s: float, before_s: float) -> None:
        self.number, self.patch = number, patch
        self.began_s, self.before_s = began_s, before_s
        self.last_s = began_s
        self.first_sample_s = self.last_sample_s = began_s
        self.is_told = False
        self.is_followed_back = False
        self.slow_onset: tuple[float, float] | None = None
        self.frames_seen = 0
        self.x_m = self.y_m = 0.0
        self.start_m = 0.0, 0.0
        self.reach_m = self.most_reach_m = 0.0
        self.area: Area | None = None
        self.most_area_m2 = 0.0
        self.way_m = 0.0
        self.spread_m = 0.0
        self.peak_n = self.peak_sd_n = 0.0
        self.peak_s = began_s
        self.peak_x_m = self.peak_y_m = 0.0
        self.peak_image = np.zeros((0, 0), dtype=np.float32)
        self._settled_m: tuple[float, float] | None = None
        self._rows = np.zeros((_FRAMES, 4))
        self._n = 0

    @property
    def rows(self) -> NDArray[np.float64]:
        """Time, force, x and y of the frames that are kept; shape (n, 4)."""
        return self._rows[: self._n]

    def see(self, pressed_s: NDArray[np.float64]) -> None:
        """Count a frame that has measured it pressed, at these times [s]."""
        if not self.frames_seen:
            self.first_sample_s = float(pressed_s.min())
        self.frames_seen += 1
        self.last_sample_s = float(pressed_s.max())

    def add(self, time_s: float, blobs: list[TrackedBlob], image: NDArray[np.float32], config: ImpactConfig) -> None:
        """Take what was found of it in the next frame: one contact, or several near each other."""
        age_s = time_s - self.began_s
        force_n = sum(blob.force_n for blob in blobs)
        x_m = sum(blob.force_n * blob.x_m for blob in blobs) / force_n
        y_m = sum(blob.force_n * blob.y_m for blob in blobs) / force_n
        sd_n = math.sqrt(sum(blob.force_sd_n**2 for blob in blobs))
        self.last_s, self.x_m, self.y_m = time_s, x_m, y_m
        if not self._n:
            self.start_m = x_m, y_m
        self.reach_m = max(math.hypot(b.x_m - x_m, b.y_m - y_m) + reach_m_of(b) for b in blobs)
        self.most_reach_m = max(self.most_reach_m, self.reach_m)
        self.area = area_of(blobs)
        self.most_area_m2 = max(self.most_area_m2, sum(blob.area_m2 for blob in blobs))
        if force_n > self.peak_n:
            self.peak_n, self.peak_sd_n, self.peak_s = force_n, sd_n, time_s
            self.peak_x_m, self.peak_y_m = x_m, y_m
            self.spread_m = max(blob.spread_m for blob in blobs)
            if age_s <= config.impact_longest_s:
                self.peak_image = image.copy()
        if age_s >= config.impact_rise_s:
            # While a contact begins, its centre moves though it does not.
            self._settled_m = self._settled_m or (x_m, y_m)
            self.way_m = max(self.way_m, math.dist(self._settled_m, (x_m, y_m)))
        if age_s <= config.impact_longest_s and self._n < MAX_FRAMES:
            if self._n == len(self._rows):
                self._rows = np.concatenate((self._rows, np.zeros_like(self._rows)))
            self._rows[self._n] = time_s, force_n, x_m, y_m
            self._n += 1

    def onset(
        self,
        untouched_s: NDArray[np.float64],
        force: Force | None = None,
        followed: FollowedBack | None = None,
    ) -> tuple[float, float]:
        """When it first touched, and the standard deviation [s].

        Parameters
        ----------
        untouched_s : np.ndarray [shape=(n,), dtype=float64]
            When the taxels there were measured and not pressed, before its first sample.
        force : (time_s, force_n), optional
            Its force in images: from the first two values it is followed back to 0.
        followed : FollowedBack, optional
            As its samples say; then `force` is not used.
        """
        latest_s = self.first_sample_s
        # Of images without samples each has seen all.
        frame_s = self.began_s - self.before_s
        earliest_s = float(untouched_s.max()) if untouched_s.size else latest_s - frame_s
        if followed is None:
            return _between(earliest_s, latest_s, None if force is None else _zero(force, 0, 1))
        return _weighed(earliest_s, latest_s, followed)

    def end(self, untouched_s: NDArray[np.float64], after_s: float, force: Force | None = None) -> tuple[float, float]:
        """When it was last touched, and the standard deviation [s]; as `onset`. `after_s`: not later."""
        earliest_s = self.last_sample_s
        latest_s = float(untouched_s.min(initial=max(after_s, earliest_s)))
        return _between(earliest_s, latest_s, None if force is None else _zero(force, -1, -2))

    def stays_after_impact(self) -> bool:
        """Whether what still touches came as an impact: its force was soon largest and has fallen since."""
        return bool(self.rows[-1, _FORCE] <= _FALLEN_SHARE * self.peak_n)

    def kind(self, onset_s: float, end_s: float, frame_s: float, config: ImpactConfig) -> Kind:
        """What it was, now that it is over; `frame_s`: how long the measurements of a frame take."""
        duration_s = certain_s = end_s - onset_s
        # What lies beyond the samples is a guess: an impact may be seen by one long frame. So may a tap by one that is
        # longer than an impact.
        if frame_s <= config.impact_longest_s:
            certain_s = min(duration_s, self.last_sample_s - self.first_sample_s)
        if certain_s <= config.impact_longest_s and not self._is_held(certain_s):
            return Kind.IMPACT
        is_large = self.most_area_m2 > config.impact_step_m2
        # The weight of a foot rolls over it, but not beyond it.
        is_rolled = is_large and self.way_m <= 2 * self.most_reach_m
        if self.way_m > max(config.impact_slide_m, 2 * self.spread_m) and not is_rolled:
            return Kind.SLIDE
        if is_large:
            return Kind.STEP
        return Kind.TAP if duration_s <= config.impact_tap_s else Kind.PRESS

    def _is_held(self, duration_s: float) -> bool:
        if duration_s < _HELD_S:
            return False
        return bool(np.mean(self.rows[:, _FORCE] > _HELD_SHARE * self.peak_n) > _HELD_TIME)

    def path(self) -> tuple[NDArray[np.float64], ...]:
        """Time, force, x and y of the frames that are kept."""
        return tuple(self.rows[:, column].copy() for column in (_TIME, _FORCE, _X, _Y))


def impulse_of(force: Force, onset_s: float, end_s: float) -> float:
    """Force over time, 0 at the first touch and at the last [N s]."""
    time_s, force_n = force
    before_s, after_s = min(onset_s, float(time_s[0])), max(end_s, float(time_s[-1]))
    times, forces = np.concatenate(([before_s], time_s, [after_s])), np.concatenate(([0.0], force_n, [0.0]))
    return float(np.diff(times) @ (forces[1:] + forces[:-1]) / 2)


def _zero(force: Force, outer: int, inner: int) -> float | None:
    """When the force is 0 that has these two values, by Hertz's law [s]; None where it does not lead there."""
    time_s, force_n = force
    if time_s.size < 2 or not 0 < force_n[outer] < force_n[inner]:
        return None
    small, large = (float(force_n[k]) ** (1 / _RISE_POWER) for k in (outer, inner))
    if small == large:  # by rounding
        return None
    return float(time_s[outer] - (time_s[inner] - time_s[outer]) * small / (large - small))


def _between(earliest_s: float, latest_s: float, guess_s: float | None) -> tuple[float, float]:
    """A moment that lies between two, and its standard deviation [s]."""
    middle_s, sd_s = (earliest_s + latest_s) / 2, (latest_s - earliest_s) / math.sqrt(12)
    return (middle_s, sd_s) if guess_s is None else (min(max(guess_s, earliest_s), latest_s), sd_s)


def _weighed(earliest_s: float, latest_s: float, followed: FollowedBack) -> tuple[float, float]:
    """A first touch, and its standard deviation, of when samples were not pressed yet and when the force was 0 [s]."""
    zero_s, zero_sd_s = min(followed.zero_s, latest_s), followed.zero_sd_s
    # A taxel that was not pressed may have been touched: the earliest moment is uncertain, too.
    gap_sd_s = math.hypot(latest_s - earliest_s, followed.wait_s) / math.sqrt(12)
    share = zero_sd_s**2 / (zero_sd_s**2 + gap_sd_s**2)
    return share * (earliest_s + latest_s) / 2 + (1 - share) * zero_s, math.sqrt(share) * gap_sd_s
