# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures S3-1 and S3-2: objects that the dictionary was not learnt from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from acts_sim.pressing import OBJECTS, ContactModel, FoamConfig, object_named
from acts_tools.evaluate.images.recovery import Recording
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.recovery import presses
from acts_tools.figures.recovery.presses import SCHEMES
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, SAME, Curve, Panel

_NEW = (
    "square",
    "two_cylinders",
    "triangle",
    "computer_mouse",
    "pliers",
    "aaa_battery",
    "spoon",
    "tennis_ball",
    "cologne",
    "eraser",
)
"""Ten objects of every size that the dictionary is not learnt from; the other 20 are its."""

_NEW_FAST = _NEW[:3]

_ATOMS, _PATCHES, _FRAMES = 1000, 14907, 3000
_ATOMS_FAST, _PATCHES_FAST, _FRAMES_FAST = 48, 200, 40
_M = (42, 64, 88, 128, 176, 256, 512)
_PLACES = 3
_HELD_HZ = 100.0
_TAXELS = 1024
_TWO = {"square": ("random", "fig5/acc_rectangle.fig"), "two_cylinders": ("adaptive", "fig5/acc_twoPole.fig")}
"""The two objects that are pressed at three places, with a scheme, and their published curves."""


def _measure_all(run: Run) -> Any:
    new = [object_named(name) for name in run.pick(_NEW, _NEW_FAST)]
    known = [item for item in OBJECTS.values() if item.name not in _NEW]
    with run.progress("dictionary of 20 objects", 100) as progress:
        learnt = presses.learn(
            run,
            known,
            atoms=run.pick(_ATOMS, _ATOMS_FAST),
            patches=run.pick(_PATCHES, _PATCHES_FAST),
            frames=run.pick(_FRAMES, _FRAMES_FAST),
            show=lambda share: progress.show(100 * share),
        )
    pairs = [("paper", scheme) for scheme in SCHEMES]
    recordings = presses.presses(run, new)
    found = {
        "unseen": presses.over_m(run, "new objects", recordings, pairs, learnt, ms=_M, rate_hz=presses.TENTH_HZ),
        "seen": presses.over_m(
            run, "the same, all learnt", recordings, pairs, presses.shipped(), ms=_M, rate_hz=presses.TENTH_HZ
        ),
        "ours": presses.over_m(run, "ours", recordings, [("acts", "tracking")], learnt, ms=_M),
    }
    rng = np.random.default_rng([run.seed, 3])
    for name, (scheme, _) in _TWO.items():
        model = ContactModel(config=FoamConfig(noise_counts=0.0), seed=run.seed)
        live = np.ones((model.geometry.rows, model.geometry.cols), dtype=bool)
        for place in range(1, _PLACES + 1):
            # Held for 200 ms at one place within the array.
            press = model.random_press(object_named(name))
            x_m, y_m = rng.uniform(-0.03, 0.03, 2).tolist()
            moved = replace(press, x_m=x_m, y_m=y_m, scale=1.0)
            frame = model.counts(model.forces_n(object_named(name), moved))
            held = [Recording(np.repeat(frame[None], 21, axis=0), _HELD_HZ, live)]
            title = f"{name}, place {place}"
            alone = presses.over_m(run, title, held, [("paper", scheme)], learnt, ms=_M, rate_hz=presses.TENTH_HZ)
            ours = presses.over_m(run, f"{title}, ours", held, [("acts", "tracking")], learnt, ms=_M)
            found[f"{name} {place}"] = {"m": alone["m"], "support": {**alone["support"], **ours["support"]}}
    return found


def _shared(run: Run) -> Any:
    return run.shared("new_objects", lambda: _measure_all(run))


def _measure_new(run: Run) -> list[Panel]:
    found = _shared(run)
    panels = []
    for scheme in SCHEMES:
        curves = [
            Curve(label, [float(m) for m in found[key]["m"]], found[key]["support"][f"paper, {scheme}"], SAME, colour)
            for label, key, colour in (
                ("dictionary of 20 other objects", "unseen", "C0"),
                ("dictionary of all 30", "seen", "C1"),
            )
        ]
        ours = found["ours"]
        curves.append(
            Curve("ours, tracking", [float(m) for m in ours["m"]], ours["support"]["acts, tracking"], OURS, "tracking")
        )
        panels.append(Panel(scheme, "taxels measured per frame, M", "support accuracy", curves, log_x=True))
    return panels


def _measure_places(run: Run) -> list[Panel]:
    found = _shared(run)
    panels = []
    for name, (scheme, _) in _TWO.items():
        curves = []
        for place in range(1, _PLACES + 1):
            one = found[f"{name} {place}"]
            ms, colour = [float(m) for m in one["m"]], f"C{place - 1}"
            curves.append(Curve(f"place {place}", ms, one["support"][f"paper, {scheme}"], SAME, colour))
            curves.append(Curve(f"place {place}, ours", ms, one["support"]["acts, tracking"], OURS, colour))
        title = f"{name.replace('_', ' ')}, {scheme} sampling"
        panels.append(Panel(title, "taxels measured per frame, M", "support accuracy", curves, log_x=True))
    return panels


def _published_places(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    found = {}
    for panel, (_, file) in zip(panels, _TWO.values(), strict=True):
        found[panel.title] = [
            data.curve(
                file,
                f"position {place}",
                named=f"place {place}, published",
                beside=f"place {place}",
                scheme=f"C{place - 1}",
                scale=1 / _TAXELS,
            )
            for place in range(1, _PLACES + 1)
        ]
    return found


def _how_many(run: Run) -> str:
    new, patches, frames = run.pick(_NEW, _NEW_FAST), run.pick(_PATCHES, _PATCHES_FAST), run.pick(_FRAMES, _FRAMES_FAST)
    return (
        f"{len(new)} new objects; the dictionary is learnt from {patches:,} patches of {frames} presses of the "
        f"{len(OBJECTS) - len(_NEW)} others."
    )


FIGURES = (
    Figure(
        "S3-1",
        "objects that the dictionary was not learnt from",
        _measure_new,
        how=_how_many,
        notes=("No published numbers.",),
    ),
    Figure(
        "S3-2",
        "two new objects at three places",
        _measure_places,
        _published_places,
        columns=2,
        notes=(
            "The published figure does not name the schemes; they are those of its panels E and F.",
            "The published curves of the square are the same within 0.005.",
        ),
    ),
)
