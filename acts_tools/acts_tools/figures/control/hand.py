# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figure 11: reflexes of a hand by touch alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from acts_tools.figures.figure import Figure
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, SAME, TRUTH, Curve, Panel


@dataclass(frozen=True)
class _Shown:
    """What is shown of a scenario of `acts evaluate hand`."""

    scenario: str
    title: str
    y_label: str
    number: str


_SHOWN = (
    _Shown("hand_to_hand", "B: another hand is held", "fewest regions in contact", "fewest"),
    _Shown("sharp", "C: a sharp tip", "depth of the tip [mm]", "penetration_mm"),
    _Shown("sphere", "D: a sphere is brought to the centre", "distance at the end [mm]", "offset_mm"),
    _Shown("small_sphere", "D: a small sphere is pulled", "distance at the end [mm]", "offset_mm"),
    _Shown("slip", "E: a held cylinder is pulled", "way of the object [mm]", "offset_mm"),
)
_RUNS = (
    ("without reflexes", False, 250.0, TRUTH, "truth"),
    ("at 60 Hz, the paper's rate", True, 60.0, SAME, "adaptive"),
    ("at 250 Hz", True, 250.0, OURS, "tracking"),
)
_SEEDS, _SEEDS_FAST = (1, 2, 3, 4, 5, 6), (1,)


def _measure_all(run: Run) -> Any:
    # Imported here, because MuJoCo and the kernels are slow to import.
    from acts_tools.evaluate.hand.scenario import Run as HandRun
    from acts_tools.evaluate.hand.scenarios import SCENARIOS

    shown = run.pick(_SHOWN, _SHOWN[1:2])
    seeds = run.pick(_SEEDS, _SEEDS_FAST)
    found: list[dict[str, Any]] = []
    with run.progress("hand", len(shown) * len(_RUNS) * len(seeds)) as progress:
        for one in shown:
            for label, reflex, rate_hz, _, _ in _RUNS:
                for seed in seeds:
                    outcome = SCENARIOS[one.scenario](HandRun(run.seed - 1 + seed, reflex, rate_hz))
                    values = {
                        **outcome.details,
                        "penetration_mm": outcome.penetration_mm,
                        "offset_mm": outcome.offset_mm,
                    }
                    value = values.get(one.number)
                    found.append(
                        {
                            "scenario": one.scenario,
                            "run": label,
                            "seed": run.seed - 1 + seed,
                            "kept": bool(outcome.kept),
                            "value": None if value is None else float(value),
                        }
                    )
                    progress.show(len(found))
    return found


def _measure(run: Run) -> list[Panel]:
    found = run.shared("hand", lambda: _measure_all(run))
    panels = []
    for one in _SHOWN:
        curves, kept = [], []
        for label, _, _, by, colour in _RUNS:
            own = [entry for entry in found if (entry["scenario"], entry["run"]) == (one.scenario, label)]
            told = [(float(entry["seed"]), entry["value"]) for entry in own if entry["value"] is not None]
            kept.append(sum(entry["kept"] for entry in own))
            if told:
                x, y = [seed for seed, _ in told], [value for _, value in told]
                curves.append(Curve(label, x, y, by, colour, points=True))
        if curves:
            x_label = f"run (kept: {', '.join(map(str, kept))})"
            panels.append(Panel(one.title, x_label, one.y_label, curves, y_min=0.0))
    return panels


FIGURES = (
    Figure(
        "11",
        "reflexes of a hand by touch alone",
        _measure,
        notes=(
            "Runs of `acts evaluate hand`, a simulated hand. Kept: in how many runs, in the order of the legend, the "
            "object, or of the sharp tip all other contacts.",
            "The paper shows photographs and videos of single trials, without numbers.",
        ),
    ),
)
