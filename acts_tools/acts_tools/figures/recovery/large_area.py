# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figure 7: six touches of a large skin, as one frame samples them and as they are recovered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_recon.methods import SkinSetup
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
from acts_tools.evaluate.estimators.methods import method_named
from acts_tools.evaluate.images.board_sampler import sampler_of
from acts_tools.figures.figure import Figure
from acts_tools.figures.recovery import presses
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import Panel, Picture

_M = 64
_OUR_FRAMES = 40
"""Frames since the touch began, for ours; the paper's method uses one alone."""

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
    skin = SkinSetup(ArrayGeometry(), touch_counts=presses.TOUCH_COUNTS)
    panels = []
    for touch in _touches():
        arm = PressingArm([touch.item], foam=FoamConfig(noise_counts=0.0), seed=run.seed)
        frame = arm.held_frame(0)
        held = frame[None]
        its = presses.task(run, "paper", touch.scheme, _M)
        indices, counts = sampler_of(its.sampling, its.noise_counts).frame(held, 0.0, 0.0)
        measured = np.zeros(frame.size)
        measured[indices] = counts
        alone = method_named("paper")(skin, presses.shipped(), {}).step(indices, counts, its.duration_s, its.duration_s)
        panels += [
            _image(f"{touch.name}: measured, {touch.scheme}", measured),
            _image("paper's method", alone, touch.name),
        ]
        tracking = presses.task(run, "acts", "tracking", _M)
        sampler = sampler_of(tracking.sampling, tracking.noise_counts)
        ours = method_named("acts")(skin, presses.shipped(), {})
        image = ours.image
        for number in range(1, _OUR_FRAMES + 1):
            indices, counts = sampler.frame(held, 0.0, 0.0)
            image = ours.step(indices, counts, number * tracking.period_s, tracking.duration_s)
        panels += [_image("ours", image, touch.name), _image("truth", frame, touch.name)]
    return panels


def _image(title: str, counts: NDArray, of: str = "") -> Panel:
    values = np.asarray(counts, dtype=float).reshape(32, 32).tolist()
    return Panel(f"{of}: {title}" if of else title, picture=Picture(values, lowest=0.0, highest=1023.0))


FIGURES = (
    Figure(
        "7",
        "six touches of a large skin",
        _measure,
        columns=4,
        notes=(
            "M = 64. Simple shapes stand for glove, foam bullet, yardstick and hand, at the largest depth.",
            f"Ours: {_OUR_FRAMES} frames (46 ms) after the touch began. Published are pictures only.",
        ),
    ),
)
