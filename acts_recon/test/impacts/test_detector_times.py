# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the detector of impacts does with times and images that cannot be."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from acts_core.errors import ArrayError
from acts_recon.impacts import Impact
from acts_recon.settings import ReconstructionSettings


@pytest.mark.parametrize(
    ("time_s", "duration_s"),
    [(np.nan, 0.002), (np.inf, 0.002), (1.7e18, 0.002), (0.05, np.nan), (0.05, -1.0), (0.05, 1e300)],
)
def test_a_frame_at_no_time_is_refused_and_no_touch_is_forgotten(time_s: float, duration_s: float) -> None:
    settings = ReconstructionSettings(touch_counts=25)
    detector = settings.impact_detector(settings.recovery())
    rows, cols = np.indices((settings.rows, settings.cols))
    touched = (400 * np.exp(-((rows - 10) ** 2 + (cols - 22) ** 2) / 4.5)).astype(np.float32)
    told: list[Impact] = []
    for frame in range(100):
        if frame == 25:
            with pytest.raises(ArrayError, match="needed are finite times"):
                detector.step(time_s, duration_s, touched)
        told += detector.step(0.002 * frame, 0.002, touched if 10 <= frame < 40 else np.zeros_like(touched))
    assert [(impact.number, impact.is_over) for impact in told] == [(1, False), (1, True)]


@pytest.mark.parametrize(
    ("name", "value"),
    [("image", np.nan), ("image", np.inf), ("sigma", np.nan), ("measured", np.nan), ("age_s", np.nan), ("age_s", -1.0)],
)
def test_images_that_cannot_be_are_refused_and_no_touch_is_forgotten(name: str, value: float) -> None:
    settings = ReconstructionSettings(touch_counts=25)
    detector = settings.impact_detector(settings.recovery())
    nothing = np.zeros((settings.rows, settings.cols), dtype=np.float32)
    rows, cols = np.indices(nothing.shape)
    touched = (400 * np.exp(-((rows - 10) ** 2 + (cols - 22) ** 2) / 4.5)).astype(np.float32)
    told: list[Impact] = []
    for frame in range(100):
        image = touched if 10 <= frame < 40 else nothing
        given = {"image": image, "sigma": nothing + 2, "measured": image, "age_s": nothing}
        if frame == 25:
            for wrong in (given[name].copy(), given[name][:-1].copy()):
                wrong[9, 21] = value
                with pytest.raises(ArrayError, match=name):
                    detector.step(0.002 * frame, 0.002, **{**given, name: wrong})
        told += detector.step(0.002 * frame, 0.002, **given)
    assert [(impact.number, impact.is_over) for impact in told] == [(1, False), (1, True)]


@pytest.mark.parametrize("name", ["image", "sigma"])
@pytest.mark.parametrize(
    "made", [lambda image: image.astype(np.float64), np.asfortranarray, lambda image: image.tolist()]
)
def test_images_of_another_kind_are_refused_and_leave_no_trace(made: Callable[[Any], Any], name: str) -> None:
    settings = ReconstructionSettings(touch_counts=25)
    detector, undisturbed = (settings.impact_detector(settings.recovery()) for _ in range(2))
    nothing = np.zeros((settings.rows, settings.cols), dtype=np.float32)
    rows, cols = np.indices(nothing.shape)
    touched = (400 * np.exp(-((rows - 10) ** 2 + (cols - 22) ** 2) / 4.5)).astype(np.float32)
    for frame in range(60):
        image = touched if 10 <= frame < 40 else nothing
        given = {"image": image, "sigma": nothing + 2, "measured": image, "age_s": nothing}
        if frame == 25:
            # Later than the next ones: were its time kept, the touch would be forgotten.
            with pytest.raises(ArrayError, match=f"{name} .*needed"):
                detector.step(0.002 * frame + 10.0, 0.002, **{**given, name: made(given[name])})
        told = detector.step(0.002 * frame, 0.002, **given)
        assert repr(told) == repr(undisturbed.step(0.002 * frame, 0.002, **given))
