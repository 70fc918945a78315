# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 4F and 4G: which object presses, over the taxels measured and over time since contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from acts_core.sampling import MEASUREMENT_US
from acts_recon.fusion import known_noise
from acts_sim.pressing import OBJECTS
from acts_tools.evaluate.classification.contenders import ours, papers
from acts_tools.evaluate.classification.trials import MIDDLE_MS, Trials, answers, arm_of, press_of
from acts_tools.evaluate.statistics import wilson
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.recovery.presses import PUBLISHED_SCHEMES, SCHEMES
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, Curve, Panel

_RECORDED_HZ = 1000.0
_AXES = {"adaptive": 2, "uniform": 0, "random": 1}
"""Of the published curves over time."""

_M = (42, 48, 56, 64, 88, 128, 256, 512)
_M_OVER_TIME = (64, 112, 192, 256, 512, 1024)
WINDOWS_MS = (25, 50, 100)
LAST_MS = 100
ALL = 1024
OUR_KEY = "ours"


def _contenders(run: Run) -> list[tuple[str, int, bool]]:
    """Scheme or `OUR_KEY`, M, and whether all times are asked for, or only that of a held press."""
    over_time = run.pick(_M_OVER_TIME, (64, ALL))
    ms = sorted({*run.pick(_M, (64,)), *over_time})
    return [
        (scheme, m, m in over_time)
        for scheme in (*SCHEMES, OUR_KEY)
        for m in ms
        # All taxels take 18 ms: our method has no use for such a frame, which has no choice left.
        if not (scheme == OUR_KEY and m == ALL)
    ]


class _Tally:
    """Answers of one contender, by the time since contact.

    Parameters
    ----------
    objects : int
    is_whole : bool
        Whether all times are asked for, or only that of a held press.
    """

    def __init__(self, objects: int, is_whole: bool) -> None:
        self.times_ms: list[float] = list(range(1, LAST_MS + 1)) if is_whole else [MIDDLE_MS]
        self.right = np.zeros(len(self.times_ms), dtype=int)
        self.matrices = np.zeros((len(WINDOWS_MS), objects, objects), dtype=int) if is_whole else None

    def add(self, wanted: int, found: Sequence[int | None]) -> None:
        """Count the answers to a press of the object `wanted`, one for each of `times_ms`."""
        self.right += [answer == wanted for answer in found]
        if self.matrices is None:
            return
        for matrix, ms in zip(self.matrices, WINDOWS_MS, strict=True):
            answer = found[ms - 1]
            if answer is not None:
                matrix[wanted, answer] += 1


def _trials(run: Run) -> Trials:
    if run.fast:
        return Trials(arms=1, presses=1, columns=2, seed=run.seed, objects=tuple(list(OBJECTS.values())[::5]))
    return Trials(arms=4, presses=3, columns=5, seed=run.seed)


def _objects(trials: Trials) -> int:
    return len(OBJECTS if trials.objects is None else trials.objects)


def _how_many(run: Run) -> str:
    trials = _trials(run)
    presses = trials.arms * trials.presses * _objects(trials)
    return f"{presses} presses of {_objects(trials)} simulated objects, as in docs/recovery.md."


def _measure_all(run: Run) -> dict[str, Any]:
    """Right answers by scheme, M and millisecond since contact, and confusion matrices at three times."""
    trials = _trials(run)
    asked = _contenders(run)
    count = _objects(trials)
    noise_counts = known_noise(trials.foam.noise_counts)
    tallies = {f"{scheme} {m}": _Tally(count, is_whole) for scheme, m, is_whole in asked}
    names: list[str] = []
    presses = 0
    with run.progress("presses of objects", trials.arms * count * trials.presses) as progress:
        for number in range(trials.arms):
            arm, coarse, fine = arm_of(trials, number)
            names = list(coarse.names)
            judged = {
                f"{scheme} {m}": ours(fine, m, noise_counts=noise_counts)
                if scheme == OUR_KEY
                else papers(coarse, m, "raster" if m == ALL else scheme)
                for scheme, m, _ in asked
            }
            for item in range(count):
                wanted = names.index(arm.objects[item].name)
                for _ in range(trials.presses):
                    frames, contact_s = press_of(arm, item, 1e-3 * LAST_MS + 0.015)
                    for key, tally in tallies.items():
                        times_s = [1e-3 * ms for ms in tally.times_ms]
                        tally.add(wanted, answers(judged[key], frames, _RECORDED_HZ, contact_s, times_s))
                    progress.show(presses := presses + 1)
    return {
        "presses": presses,
        "objects": names,
        "right": {key: tally.right.tolist() for key, tally in tallies.items()},
        "matrices": {key: tally.matrices.tolist() for key, tally in tallies.items() if tally.matrices is not None},
    }


def shared_answers(run: Run) -> Any:
    """Right answers and confusion matrices of all contenders, measured once."""
    return run.shared("recognition", lambda: _measure_all(run))


def _measure_over_m(run: Run) -> list[Panel]:
    found = shared_answers(run)
    curves = []
    for scheme in (*SCHEMES, OUR_KEY):
        ms = [m for one, m, _ in _contenders(run) if one == scheme]
        # The millisecond of a held press, where all were asked for.
        held = [(right := found["right"][f"{scheme} {m}"])[round(MIDDLE_MS) - 1 if len(right) > 1 else 0] for m in ms]
        bounds = [wilson(right, found["presses"]) for right in held]
        curves.append(
            Curve(
                "ours, tracking" if scheme == OUR_KEY else scheme,
                [float(m) for m in ms],
                [right / found["presses"] for right in held],
                OURS if scheme == OUR_KEY else SAME,
                "tracking" if scheme == OUR_KEY else scheme,
                low=[low for low, _ in bounds],
                high=[high for _, high in bounds],
            )
        )
    return [Panel("pressed and held", "taxels measured per frame, M", "accuracy", curves, log_x=True)]


def _published_over_m(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    return {
        panels[0].title: [
            data.curve(
                "fig4/M_Acc_classification.fig",
                word,
                named=f"{scheme}, published",
                beside=scheme,
                scheme=scheme,
            )
            for scheme, word in PUBLISHED_SCHEMES.items()
        ]
    }


def running_mean(right: Sequence[int], m: int, presses: int) -> tuple[list[float], list[float]]:
    """Time [ms], and accuracy as the paper has it: mean over all answers since contact; from the first answer on."""
    first = int(np.ceil(m * MEASUREMENT_US * 1e-3))
    shares = np.array(right[first - 1 :]) / presses
    times = np.arange(first, len(right) + 1, dtype=float)
    return times.tolist(), (np.cumsum(shares) / np.arange(1, len(shares) + 1)).tolist()


def _measure_over_time(run: Run) -> list[Panel]:
    found = shared_answers(run)
    presses = found["presses"]
    over_time = run.pick(_M_OVER_TIME, (64, ALL))
    panels = []
    for scheme in SCHEMES:
        curves = []
        for number, m in enumerate(over_time):
            x, y = running_mean(found["right"][f"{scheme} {m}"], m, presses)
            curves.append(Curve(f"M = {m}", x, y, SAME, f"C{number}"))
        panels.append(Panel(f"{scheme}, mean since contact", "time since contact [ms]", "accuracy", curves))
    last = []
    for number, m in enumerate(over_time):
        for scheme, by in ((OUR_KEY, OURS), ("adaptive", SAME)):
            right = found["right"].get(f"{scheme} {m}")
            if right is not None and (by == OURS or m == over_time[0]):
                first = int(np.ceil(m * MEASUREMENT_US * 1e-3))
                x = [float(ms) for ms in range(first, LAST_MS + 1)]
                label = f"{'ours' if by == OURS else 'paper, adaptive'}, M = {m}"
                last.append(Curve(label, x, [one / presses for one in right[first - 1 :]], by, f"C{number}"))
    panels.append(Panel("each answer by itself", "time since contact [ms]", "accuracy", last))
    return panels


def _published_over_time(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    found: dict[str, list[Curve]] = {}
    for scheme, axes in _AXES.items():
        panel = next(panel for panel in panels if panel.title.startswith(scheme))
        curves = []
        for curve in panel.curves:
            m = curve.label.rpartition(" ")[2]
            points = data.points("fig4/time_Acc_classification.fig", f"Measurement Level: {m}", axes)
            # The published time is that of the clock; a thousandth of a second is a point of ours.
            points = points[(points[:, 0] > 0) & (points[:, 0] <= 1e-3 * LAST_MS)]
            x, y = (1e3 * points[:, 0]).tolist(), points[:, 1].tolist()
            curves.append(Curve(f"M = {m}, published", x, y, PUBLISHED, curve.scheme, beside=curve.label))
        found[panel.title] = curves
    return found


_NOTES = (
    "The published repeatability of the spot is unknown: 0.15 taxels here, which fits adaptive sampling.",
    "Bands: 95 % intervals.",
)

FIGURES = (
    Figure(
        "4F",
        "which object presses, over the taxels measured",
        _measure_over_m,
        _published_over_m,
        how=_how_many,
        notes=_NOTES,
    ),
    Figure(
        "4G",
        "which object presses, over time since contact",
        _measure_over_time,
        _published_over_time,
        columns=2,
        how=_how_many,
    ),
)
