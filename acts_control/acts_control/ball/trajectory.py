# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the ball should be at which time: hold a point, trace letters, and move between them.

Along every stroke the arc length follows the polynomial of seventh degree from rest to rest, so that position,
velocity, acceleration and jerk are continuous throughout, also at the corners of a letter.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from math import hypot, sqrt

from acts_control.ball.reference import Reference
from acts_control.ball.strokes import Line, Point, Stroke, circle, letter
from acts_core.errors import SettingsError
from acts_core.settings import setting, validate

SEGMENTS = ("hold", "N", "B", "I", "circle")
"""Words of a trajectory. Between them the ball is led by "move" to where the next one starts."""

# Of the law over unit length and time, s = 35 t^4 - 84 t^5 + 70 t^6 - 20 t^7.
_PEAK_SPEED = 35 / 16
_PEAK_ACCELERATION = 84 / (5 * sqrt(5))

# A shorter way needs no segment of its own.
_SAME_PLACE_M = 1e-6

# Pieces into which a stroke is cut to look at its bends and its reach.
_CHECKED = 40


@dataclass(frozen=True)
class TrajectoryConfig:
    """What the ball does and how fast."""

    trajectory: str = setting("hold,N,B,I", f"what the ball does, a comma list of {', '.join(SEGMENTS)}")
    hold_s: float = setting(6.0, "how long a hold lasts [s]", minimum=0.0, maximum=3600.0)
    hold_x_m: float = setting(0.0, "where the ball is held, x [m]", minimum=-1.0, maximum=1.0)
    hold_y_m: float = setting(0.0, "where the ball is held, y [m]", minimum=-1.0, maximum=1.0)
    letter_height_m: float = setting(0.064, "height of the letters [m]", minimum=0.005, maximum=1.0)
    letter_width_m: float = setting(0.040, "width of N and B [m]", minimum=0.005, maximum=1.0)
    circle_radius_m: float = setting(0.030, "radius of the circle [m]", minimum=0.005, maximum=1.0)
    speed_m_s: float = setting(0.060, "largest speed of the reference [m/s]", minimum=0.001, maximum=1.0)
    acceleration_m_s2: float = setting(
        0.2, "largest acceleration along a stroke, and across it in its bends [m/s^2]", minimum=0.001, maximum=5.0
    )
    shortest_stroke_s: float = setting(
        1.0, "no stroke and no move takes less, however short it is [s]", minimum=0.01, maximum=60.0
    )
    reach_m: float = setting(
        0.045, "the reference never goes farther from the centre than this in x or y [m]", minimum=0.005, maximum=1.0
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass(frozen=True)
class TimedReference:
    """Reference at an instant.

    Attributes
    ----------
    reference : Reference
    segment : str
        One of `SEGMENTS`, or "move".
    segment_time_s : float
        Since the segment's start [s].
    finished : bool
        Whether the whole trajectory is over; the reference then rests.
    """

    reference: Reference
    segment: str
    segment_time_s: float
    finished: bool


@dataclass(frozen=True)
class _Piece:
    """One stroke, timed."""

    segment: str
    segment_start_s: float
    start_s: float
    duration_s: float
    stroke: Stroke

    def at(self, time_s: float) -> Reference:
        length = self.stroke.length_m
        if length == 0.0 or self.duration_s == 0.0:
            return Reference(*self.stroke.at(0.0)[:2])
        u = min(max((time_s - self.start_s) / self.duration_s, 0.0), 1.0)
        s = length * u**4 * (35.0 - 84.0 * u + 70.0 * u * u - 20.0 * u**3)
        speed = length / self.duration_s * 140.0 * (u * (1.0 - u)) ** 3
        acceleration = length / self.duration_s**2 * 420.0 * (u * (1.0 - u)) ** 2 * (1.0 - 2.0 * u)
        point = self.stroke.at(s)
        return Reference(
            point.x_m,
            point.y_m,
            speed * point.tangent_x,
            speed * point.tangent_y,
            acceleration * point.tangent_x + speed * speed * point.curvature_x,
            acceleration * point.tangent_y + speed * speed * point.curvature_y,
        )


def parse(text: str) -> list[str]:
    """The words of a comma list; a trailing comma is allowed.

    Raises
    ------
    SettingsError
        For a word that does not exist, or none at all.
    """
    words = [word.strip() for word in text.split(",")]
    if len(words) > 1 and not words[-1]:
        words.pop()
    for word in words:
        if word not in SEGMENTS:
            raise SettingsError(f"trajectory = {text!r}: {word!r} is not one of {', '.join(SEGMENTS)}")
    return words


class Trajectory:
    """The whole plan.

    Attributes
    ----------
    duration_s : float
        Until the last segment ends [s].

    Raises
    ------
    SettingsError
        For an unknown word, or when a point of it lies beyond `reach_m`.
    """

    def __init__(self, config: TrajectoryConfig) -> None:
        self._config = config
        self._pieces: list[_Piece] = []
        self.duration_s = 0.0
        place: Point | None = None
        for word in parse(config.trajectory):
            strokes = self._strokes(word)
            start = strokes[0].at(0.0)[:2]
            if place is not None and hypot(start[0] - place[0], start[1] - place[1]) > _SAME_PLACE_M:
                self._append("move", [Line(place, start)])
            self._append(word, strokes)
            place = strokes[-1].at(strokes[-1].length_m)[:2]
        self._starts = [piece.start_s for piece in self._pieces]
        self._check_reach()

    def at(self, time_s: float) -> TimedReference:
        """The reference `time_s` after the start; it rests before the start and after the end."""
        finished = time_s >= self.duration_s
        time_s = min(max(time_s, 0.0), self.duration_s)
        piece = self._pieces[max(bisect_right(self._starts, time_s) - 1, 0)]
        reference = piece.at(time_s)
        return TimedReference(
            reference.at_rest() if finished else reference, piece.segment, time_s - piece.segment_start_s, finished
        )

    def _strokes(self, word: str) -> list[Stroke]:
        config = self._config
        if word == "hold":
            point = (config.hold_x_m, config.hold_y_m)
            return [Line(point, point)]
        if word == "circle":
            return circle(config.circle_radius_m)
        return letter(word, config.letter_height_m, config.letter_width_m)

    def _append(self, segment: str, strokes: list[Stroke]) -> None:
        start_s = self.duration_s
        for stroke in strokes:
            duration_s = self._duration_s(stroke)
            self._pieces.append(_Piece(segment, start_s, self.duration_s, duration_s, stroke))
            self.duration_s += duration_s

    def _duration_s(self, stroke: Stroke) -> float:
        length, config = stroke.length_m, self._config
        if length == 0.0:
            return config.hold_s
        bend = max(hypot(*stroke.at(length * k / _CHECKED)[4:]) for k in range(_CHECKED + 1))
        speed = min(config.speed_m_s, sqrt(config.acceleration_m_s2 / bend) if bend > 0.0 else config.speed_m_s)
        return max(
            _PEAK_SPEED * length / speed,
            sqrt(_PEAK_ACCELERATION * length / config.acceleration_m_s2),
            config.shortest_stroke_s,
        )

    def _check_reach(self) -> None:
        reach = self._config.reach_m
        for piece in self._pieces:
            for k in range(_CHECKED + 1):
                x, y = piece.stroke.at(piece.stroke.length_m * k / _CHECKED)[:2]
                if max(abs(x), abs(y)) > reach * (1.0 + 1e-9):
                    raise SettingsError(
                        f"trajectory {self._config.trajectory!r}: {piece.segment!r} passes ({x:.4f}, {y:.4f}) m, "
                        f"beyond reach_m = {reach:g}; make it smaller or allow more reach"
                    )
