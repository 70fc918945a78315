# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 4E, S6, S8-1 and S8-2: support accuracy over the taxels measured, by object size, and by dictionary."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from acts_sim.pressing import FoamConfig, PressingArm, object_named
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.recovery import presses
from acts_tools.figures.recovery.presses import PUBLISHED_SCHEMES, SCHEMES
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, Curve, Panel
from acts_tools.figures.skin_images import skin_panel

_M_LABEL, _SUPPORT = "taxels measured per frame, M", "support accuracy"
_TAXELS = 1024
_M_OF_SIZES = (64, 512)
_M_OF_DICTIONARIES = (42, 64, 88, 128, 256, 512)
_HIGHEST_COUNTS = 800.0
_M_OF_PICTURES = (64, 128, 256)
_DICTIONARIES = {"paper": "learnt", "dct": "DCT", "haar": "Haar"}
_PUBLISHED_DICTIONARIES = {"paper": "Learned", "dct": "DCT", "haar": "Haar"}


def _measure_support(run: Run) -> list[Panel]:
    def measure() -> Any:
        pairs = [(method, scheme) for method in ("paper", "linear") for scheme in SCHEMES]
        recordings = presses.presses(run, presses.objects(run))
        rate_hz = run.pick(presses.FULL_HZ, presses.TENTH_HZ)
        return presses.over_m(run, "support over M", recordings, pairs, presses.shipped(), rate_hz=rate_hz)

    found = run.shared("support", measure)
    ms = [float(m) for m in found["m"]]
    of = found["support"]
    panels = []
    for method, title in (("paper", "dictionary"), ("linear", "linear interpolation")):
        curves = [Curve(f"{scheme}", ms, of[f"{method}, {scheme}"], SAME, scheme) for scheme in SCHEMES]
        curves.append(_ours(run))
        panels.append(Panel(title, _M_LABEL, _SUPPORT, curves, log_x=True))
    return panels


def _ours(run: Run) -> Curve:
    found = presses.ours_over_m(run)
    return Curve("ours, tracking", [float(m) for m in found["m"]], found["support"]["acts, tracking"], OURS, "tracking")


def _published_support(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    names = {"dictionary": "Learned Dictionary", "linear interpolation": "Linear Interpolation"}
    return {
        title: [
            data.curve(
                "fig4/M_Acc_recon.fig",
                f"{word} + {name}",
                named=f"{scheme}, published",
                beside=scheme,
                scheme=scheme,
                scale=1 / _TAXELS,
            )
            for scheme, word in PUBLISHED_SCHEMES.items()
        ]
        for title, name in names.items()
    }


def _measure_sizes(run: Run) -> list[Panel]:
    items = presses.objects(run)
    recordings = presses.presses(run, items)
    sizes = [float((one.frames.max(axis=0) > PAPER_TOUCH_COUNTS).sum()) for one in recordings]
    order = np.argsort(sizes).tolist()
    pairs = [("paper", scheme) for scheme in SCHEMES] + [("acts", "tracking")]
    dictionary = presses.shipped()
    panels = []
    with run.progress("support over size", len(_M_OF_SIZES) * len(pairs) * len(items)) as progress:
        done = 0
        for m in _M_OF_SIZES:
            curves = []
            for method, scheme in pairs:
                ours = method == "acts"
                rate_hz = presses.FULL_HZ if ours else presses.TENTH_HZ
                its = presses.task(run, method, scheme, m, rate_hz=rate_hz)
                values = []
                for number in order:
                    values.append(presses.support([recordings[number]], its, dictionary))
                    progress.show(done := done + 1)
                label = "ours, tracking" if ours else scheme
                x = [sizes[number] for number in order]
                curves.append(Curve(label, x, values, OURS if ours else SAME, scheme, points=True))
                if not ours:
                    line = np.polyfit(x, values, 1)
                    ends = [x[0], x[-1]]
                    curves.append(Curve(f"{scheme}, line", ends, np.polyval(line, ends).tolist(), SAME, scheme))
            panels.append(Panel(f"M = {m}", "taxels pressed by the object", _SUPPORT, curves))
    return panels


def _published_sizes(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    files = {64: "figS_sizeAcc/objsize_acc_smallM.fig", 512: "figS_sizeAcc/objsize_acc_bigM.fig"}
    words = {"adaptive": "Binary Sampling", "uniform": "Down-Sampling", "random": "Random Sampling"}
    found = {}
    for m, file in files.items():
        curves = []
        for scheme, word in words.items():
            points = data.points(file, word)
            x, y = points[:, 0], points[:, 1] / _TAXELS
            ends = [float(x.min()), float(x.max())]
            line = np.polyval(np.polyfit(x, y, 1), ends).tolist()
            curves.append(Curve(f"{scheme}, published line", ends, line, PUBLISHED, scheme, beside=f"{scheme}, line"))
        found[f"M = {m}"] = curves
    return found


def _measure_dictionaries(run: Run) -> list[Panel]:
    def measure() -> Any:
        pairs = [(method, scheme) for method in _DICTIONARIES for scheme in SCHEMES]
        recordings = presses.presses(run, presses.objects(run))
        return presses.over_m(
            run,
            "support over M by dictionary",
            recordings,
            pairs,
            presses.shipped(),
            ms=_M_OF_DICTIONARIES,
            rate_hz=presses.TENTH_HZ,
        )

    found = run.shared("dictionaries", measure)
    ms = [float(m) for m in found["m"]]
    panels = []
    for scheme in SCHEMES:
        curves = [
            Curve(name, ms, found["support"][f"{method}, {scheme}"], SAME, _colour(method))
            for method, name in _DICTIONARIES.items()
        ]
        curves.append(_ours(run))
        panels.append(Panel(scheme, _M_LABEL, _SUPPORT, curves, log_x=True))
    return panels


def _published_dictionaries(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    return {
        scheme: [
            data.curve(
                "figS_otherDict/M_acc_otherDict.fig",
                f"{word} + {_PUBLISHED_DICTIONARIES[method]} Dictionary",
                named=f"{name}, published",
                beside=name,
                scheme=_colour(method),
                scale=1 / _TAXELS,
            )
            for method, name in _DICTIONARIES.items()
        ]
        for scheme, word in PUBLISHED_SCHEMES.items()
    }


def _colour(method: str) -> str:
    return f"C{list(_DICTIONARIES).index(method)}"


def _measure_pictures(run: Run) -> list[Panel]:
    """One press of the printed X, its samples, its recovery by three dictionaries, and ours of several frames."""
    arm = PressingArm([object_named("x")], foam=FoamConfig(noise_counts=0.0), seed=run.seed)
    frame = arm.held_frame(0)
    panels = []
    for m in _M_OF_PICTURES:
        indices, counts, measured = presses.samples_of_held(run, frame, "random", m)
        panels.append(skin_panel(f"measured, M = {m}", measured, highest=_HIGHEST_COUNTS))
        for method, name in _DICTIONARIES.items():
            recovered = presses.recovered_alone(method, indices, counts)
            panels.append(skin_panel(f"{name}, M = {m}", recovered, highest=_HIGHEST_COUNTS))
        ours, frames = presses.ours_of_held(run, frame, m)
        panels.append(skin_panel(f"ours, {frames} frames, M = {m}", ours, highest=_HIGHEST_COUNTS))
        panels.append(skin_panel(f"truth (M = {m})", frame, highest=_HIGHEST_COUNTS))
    return panels


FIGURES = (
    Figure("4E", "support accuracy over the taxels measured", _measure_support, _published_support, columns=2),
    Figure(
        "S6",
        "support accuracy over the size of the object",
        _measure_sizes,
        _published_sizes,
        columns=2,
        notes=("Lines: least squares through the points of a scheme.",),
    ),
    Figure(
        "S8-1",
        "recovery of one frame by other dictionaries, random sampling",
        _measure_pictures,
        columns=6,
        panel_inch=(2.1, 2.15),
        notes=(
            "Dictionaries recover one frame alone. Ours: tracking and fusion, 46 ms after the touch began.",
            "The same touch in all rows.",
        ),
    ),
    Figure("S8-2", "support accuracy by other dictionaries", _measure_dictionaries, _published_dictionaries),
)
