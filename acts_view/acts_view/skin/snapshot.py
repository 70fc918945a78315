# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the page is told of a skin: what it is like, and its newest state. Knows no ROS."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_core.array import MAX_SIDE, TOUCH_COUNTS
from acts_core.errors import ActsError, ArrayError
from acts_core.skin import LAYOUTS, ForceResponse, Layout, MeasuredForceResponse, TrackedBlob, force_table, layout
from acts_view.skin.arrangement import arrangement
from acts_view.skin.history import COLUMNS
from acts_view.web.codec import encode

CONTACT_COLUMNS = ("x_m", "y_m", "force_n", "peak_counts", "area_m2", "spread_m", "speed_m_s", "age_s")
"""Of a contact, besides its number."""


_LARGEST_PITCH_M = 1.0
_LAYOUT_FILES = (".yaml", ".yml")
_AGE_STEP_S = 1e-4
_AGE_STEPS_MAX = 65535


class Sample(NamedTuple):
    """One frame of the 1 kHz stream, as `acts_view.skin.history.History.add` takes it."""

    stamp_s: float
    force_n: float
    latency_ms: float
    lost: int


@dataclass(frozen=True)
class RegionState:
    """What one patch of a hand feels."""

    name: str
    force_n: float
    slip_m: float
    is_slipping: bool


@dataclass(frozen=True)
class Frame:
    """The newest state of a skin; what nobody publishes is None or empty.

    Attributes
    ----------
    stamp_s : float
        Of the newest of what it is made of, by the clock of the stamps [s].
    image : np.ndarray [shape=(rows, cols), dtype=uint16] or None
        Counts.
    confidence : np.ndarray [shape=(rows, cols), dtype=uint8] or None
        255: sure.
    age_s : np.ndarray [shape=(rows, cols), dtype=float32] or None
        How long ago each taxel was measured [s]; 0: by the newest frame, inf or NaN: not known.
    contact_numbers : np.ndarray [shape=(n,), dtype=uint32]
    contacts : np.ndarray [shape=(n, 8), dtype=float32]
        `CONTACT_COLUMNS`.
    outlines : sequence of np.ndarray [shape=(n, 2), dtype=float32]
        Corners of closed polygons around what touches, x and y [m].
    touch : tuple of float or None
        Of all that presses: centre of pressure x and y [m], force [N], peak [counts], area [m^2]; None without contact.
    is_touch_known : bool
        False: nobody tells whether anything presses, as in a bag that has images only.
    regions : sequence of RegionState
    hand : mapping
        State of a hand in words, and the angles of its joints; empty for none.
    ball : mapping
        Ball on the skin, where it should be, and the tilt of the plate; empty for none.
    object : mapping
        Which known object presses; empty where nobody classifies.
    """

    stamp_s: float = 0.0
    image: NDArray[np.uint16] | None = None
    confidence: NDArray[np.uint8] | None = None
    age_s: NDArray[np.float32] | None = None
    contact_numbers: NDArray[np.uint32] = field(default_factory=lambda: np.zeros(0, np.uint32))
    contacts: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, len(CONTACT_COLUMNS)), np.float32))
    outlines: Sequence[NDArray[np.float32]] = ()
    touch: tuple[float, ...] | None = None
    is_touch_known: bool = True
    regions: Sequence[RegionState] = ()
    hand: dict[str, Any] = field(default_factory=dict)
    ball: dict[str, Any] = field(default_factory=dict)
    object: dict[str, Any] = field(default_factory=dict)


def contact_table(contacts: Sequence[TrackedBlob]) -> tuple[NDArray[np.uint32], NDArray[np.float32]]:
    """Numbers of contacts, and the rest of them, as a `Frame` has it."""
    rows = [
        (
            one.x_m,
            one.y_m,
            one.force_n,
            one.peak_counts,
            one.area_m2,
            one.spread_m,
            math.hypot(one.vx_m_s, one.vy_m_s),
            one.age_s,
        )
        for one in contacts
    ]
    numbers = np.array([one.number for one in contacts], np.uint32)
    return numbers, np.array(rows, np.float32).reshape(-1, len(CONTACT_COLUMNS))


@dataclass(frozen=True)
class SkinShape:
    """How a skin's picture is made, as the parameters of its reconstruction say; the defaults are those there.

    Attributes
    ----------
    layout : str
        As `acts_core.skin.layouts.layout` takes it.
    rows, cols : int
        Of the matrix.
    pitch_m, row_pitch_m : float
        As `Layout.geometry` takes them; 0: the layout's own [m].
    touch_counts : int
        Above which a taxel is pressed.
    force_full_scale_counts, force_dead_n, force_half_n : float
        As `ForceResponse` has them.
    force_response : str
        Path of a measured one, used instead; empty for none.

    Raises
    ------
    ArrayError
        For what no skin is like.
    """

    layout: str = "square"
    rows: int = 32
    cols: int = 32
    pitch_m: float = 0.0
    row_pitch_m: float = 0.0
    touch_counts: int = TOUCH_COUNTS
    force_full_scale_counts: float = ForceResponse.full_scale_counts
    force_dead_n: float = ForceResponse.dead_n
    force_half_n: float = ForceResponse.half_n
    force_response: str = ""

    def __post_init__(self) -> None:
        # Any program can take the name of the reconstruction node and answer for it.
        for one in fields(self):
            value = getattr(self, one.name)
            if type(value) is not type(one.default):
                raise ArrayError(
                    f"{one.name} = {value!r} cannot be shown: it must be of the type {type(one.default).__name__}"
                )
        if not (1 <= self.rows <= MAX_SIDE and 1 <= self.cols <= MAX_SIDE):
            raise ArrayError(f"a skin of {self.rows} x {self.cols} taxels cannot be shown: 1 to {MAX_SIDE} a side")
        if not (0.0 <= self.pitch_m <= _LARGEST_PITCH_M and 0.0 <= self.row_pitch_m <= _LARGEST_PITCH_M):
            raise ArrayError(
                f"taxels {self.pitch_m:g} m and {self.row_pitch_m:g} m apart cannot be shown: 0 to {_LARGEST_PITCH_M:g}"
            )


def describe_skin(name: str, shape: SkinShape) -> dict[str, Any]:
    """What the page has to know of a skin before it can draw it, as JSON can say it."""
    try:
        found = _layout_of(shape)
        note = ""
    except ActsError as error:
        # A layout file of another machine: its picture can be shown, its patches not.
        found = layout("square", shape.rows, shape.cols)
        note = f"drawn as the plain picture: {error}"
    force_n = _force_n(shape)
    if force_n is None:
        note = "; ".join(filter(None, [note, f"no newtons: {shape.force_response} cannot be read here"]))
    geometry = found.geometry(shape.pitch_m, shape.row_pitch_m)
    return {
        "type": "skin",
        "skin": name,
        "layout": shape.layout,
        "note": note,
        "rows": geometry.rows,
        "cols": geometry.cols,
        "pitch_m": geometry.pitch_m,
        "row_pitch_m": geometry.pitch_y_m,
        "touch_counts": shape.touch_counts,
        "force_n": force_n,
        "patches": _patches(found, shape),
    }


def _layout_of(shape: SkinShape) -> Layout:
    """The layout; of a file that is none nothing is told but that: any program can name any file for it.

    Raises
    ------
    ArrayError
        It does not fit, or cannot be read here.
    """
    if shape.layout in LAYOUTS:
        return layout(shape.layout, shape.rows, shape.cols)
    if not shape.layout.endswith(_LAYOUT_FILES):
        raise ArrayError(f"{shape.layout!r} is neither one of {', '.join(LAYOUTS)} nor a file *.yaml")
    try:
        return layout(shape.layout, shape.rows, shape.cols)
    except ActsError:
        raise ArrayError(f"{shape.layout!r} holds no layout of this skin, or cannot be read here") from None


def _force_n(shape: SkinShape) -> list[float] | None:
    """Force of a taxel at 0 to 1023 counts [N]; None where its measured response is not on this machine."""
    try:
        response = (
            MeasuredForceResponse.from_file(Path(shape.force_response))
            if shape.force_response
            else ForceResponse(shape.force_full_scale_counts, shape.force_dead_n, shape.force_half_n)
        )
    except ActsError:
        return None
    # 0 counts are no force, whatever the limit from above.
    return [0.0, *(round(float(one), 5) for one in force_table(response)[1:-1])]


def _patches(found: Layout, shape: SkinShape) -> list[dict[str, Any]]:
    return [
        {
            "name": patch.name,
            "rows": [patch.first_row, patch.end_row],
            "cols": [patch.first_col, patch.end_col],
            "box_m": list(box),
        }
        for patch, box in zip(found.patches, arrangement(found, shape.pitch_m, shape.row_pitch_m), strict=True)
    ]


def _age_steps(age_s: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Ages in tenths of a millisecond: half the bytes; what is older than 6.5 s or not known is all the same."""
    # Only what the newest frame measured is 0.
    steps = np.maximum(np.rint(age_s / _AGE_STEP_S), age_s > 0.0)
    # Of NaN and a number the number.
    return np.fmin(steps, _AGE_STEPS_MAX).astype(np.uint16)


def encode_frame(
    name: str, frame: Frame, history: NDArray[np.float64], life: int, silent_s: float | None = 0.0
) -> bytes:
    """The newest state of a skin and what is new of its history, as one message.

    Times of the history are offsets from ``base_s``: the seconds since 1970 do not fit 32 bits. `silent_s` is how long
    ago the skin was heard of [s], None where it never was: what controls it may go on without it.
    """
    # The newest: where a clock was set forward, what is before that may be days away, and is no longer in any plot.
    base_s = float(history[-1, 0]) if len(history) else 0.0
    series = history.copy()
    series[:, :1] -= base_s
    arrays: dict[str, NDArray[Any]] = {
        "history": series.astype(np.float32).reshape(-1, len(COLUMNS)),
        "contact_numbers": frame.contact_numbers,
        "contacts": frame.contacts,
    }
    if frame.outlines:
        # One after another, and how many corners each has.
        arrays["outlines"] = np.concatenate(frame.outlines).astype(np.float32)
        arrays["outline_sizes"] = np.array([len(one) for one in frame.outlines], np.uint32)
    if frame.image is not None:
        arrays["image"] = frame.image
    if frame.confidence is not None:
        arrays["confidence"] = frame.confidence
    if frame.age_s is not None:
        arrays["age"] = _age_steps(frame.age_s)
    header = {
        "type": "frame",
        "skin": name,
        "stamp_s": frame.stamp_s,
        "silent_s": silent_s,
        "base_s": base_s,
        "life": life,
        "touch": frame.touch,
        "touch_known": frame.is_touch_known,
        "regions": [[region.name, region.force_n, region.slip_m, region.is_slipping] for region in frame.regions],
        "hand": frame.hand,
        "ball": frame.ball,
        "object": frame.object,
    }
    return encode(header, arrays)
