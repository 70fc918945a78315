# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figure 7: six touches of a large skin, as one frame samples them and as they are recovered."""

from __future__ import annotations

from dataclasses import dataclass

from acts_core.array import COUNT_MAX
from acts_sim.pressing import (
    ContactObject,
    Field,
    FoamConfig,
    PressingArm,
    bar,
    disc,
    ellipsoid,
    object_named,
    prism,
)
from acts_tools.figures.figure import Figure
from acts_tools.figures.recovery import presses
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import Panel
from acts_tools.figures.skin_images import skin_panel

_M = 64
_DEPTH_M = (0.002, 0.003)
_BAR_M = 0.025


def _glove(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.050, 0.045, 0.070)


def _bullet(x: Field, y: Field) -> Field:
    return prism(disc(x, y, 0.0065))


def _yardstick(x: Field, y: Field) -> Field:
    return prism(bar(x, y, 0.3, _BAR_M, 0.4))


def _hand(x: Field, y: Field) -> Field:
    return ellipsoid(x, y, 0.035, 0.028, 0.060)


def _yardstick_across(x: Field, y: Field) -> Field:
    return prism(bar(x, y, 0.3, _BAR_M, 1.9))


@dataclass(frozen=True)
class _Touch:
    """A touch of the figure: what presses, and the paper's scheme."""

    name: str
    item: ContactObject
    scheme: str = "adaptive"


def _touches() -> list[_Touch]:
    shapes = {
        "punch": _glove,
        "shot": _bullet,
        "slash": _yardstick,
        "push": _hand,
        "strike": _yardstick_across,
    }
    touches = [_Touch(name, ContactObject(name, "event", _DEPTH_M, gap)) for name, gap in shapes.items()]
    return [*touches, _Touch("squish", object_named("soft_brain"), "random")]


def _measure(run: Run) -> list[Panel]:
    panels = []
    for touch in _touches():
        arm = PressingArm([touch.item], foam=FoamConfig(noise_counts=0.0), seed=run.seed)
        frame = arm.held_frame(0)
        indices, counts, measured = presses.samples_of_held(run, frame, touch.scheme, _M)
        alone = presses.recovered_alone("paper", indices, counts)
        panels += [
            skin_panel(f"{touch.name}: {what}", image, highest=float(COUNT_MAX))
            for what, image in (
                (f"measured, {touch.scheme}", measured),
                ("paper's method", alone),
                ("ours", presses.ours_of_held(run, frame, _M)[0]),
                ("truth", frame),
            )
        ]
    return panels


FIGURES = (
    Figure(
        "7",
        "six touches of a large skin",
        _measure,
        columns=4,
        panel_inch=(2.1, 2.15),
        notes=(
            "M = 64. Simple shapes stand for glove, foam bullet, yardstick and hand, at the largest depth.",
            f"Ours: {1e3 * presses.HELD_S:.0f} ms (40 frames) after the touch began. Published are pictures only.",
        ),
    ),
)
