# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frame rates at which figures compare methods of recovery."""

from __future__ import annotations

from pathlib import Path

import pytest

from acts_core.errors import SettingsError
from acts_tools.evaluate.images.recovery import Task
from acts_tools.figures.recovery import presses
from acts_tools.figures.registry import FIGURES
from acts_tools.figures.run import Run

# What remembers earlier frames has the rate of a board, 1000 frames/s.
_RATES_HZ = {"paper": {100.0}, "acts": {1000.0}}


@pytest.mark.parametrize("name", ["S6", "S3-2"])
def test_each_method_is_scored_at_its_own_rate(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    used_hz: dict[str, set[float]] = {}

    def support(_recordings: object, task: Task, _dictionary: object) -> float:
        used_hz.setdefault(task.method, set()).add(task.rate_hz)
        return 1.0

    monkeypatch.setattr(presses, "support", support)
    FIGURES[name].measure(Run(tmp_path, fast=True))
    assert used_hz == _RATES_HZ


def test_the_note_on_the_taxels_that_are_measured_is_of_the_curve(tmp_path: Path) -> None:
    (panel,) = FIGURES["S2"].measure(Run(tmp_path))
    measured = next(curve.y for curve in panel.curves if curve.label == "ACTS, taxels measured")
    low, high = (f"{round(rate, -2):,.0f}" for rate in (min(measured), max(measured)))
    assert f"measured are {low} to {high} taxels/s" in " ".join(FIGURES["S2"].notes)


def test_a_method_with_a_memory_is_not_given_fewer_frames(tmp_path: Path) -> None:
    run = Run(tmp_path, fast=True)
    for method in ("paper", "linear", "dct", "haar"):
        assert presses.task(run, method, "random", 64, rate_hz=presses.TENTH_HZ).rate_hz == 100.0
    assert presses.task(run, "acts", "tracking", 64).rate_hz == 1000.0
    for method in ("acts", "last"):
        with pytest.raises(SettingsError, match=f"{method} at 100 frames/s: it remembers earlier frames"):
            presses.task(run, method, "tracking", 64, rate_hz=presses.TENTH_HZ)
