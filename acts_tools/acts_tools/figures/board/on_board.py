# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 9A, 9B and 9C: recovery and classification on the board, their frame rates and their accuracies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from acts_core.array import TOUCH_COUNTS
from acts_core.sampling import SamplingConfig
from acts_recon.objects import BOARD_COLUMNS, Classifier, ClassifierConfig, build_object_library
from acts_sim.pressing import OBJECTS, PressingArm
from acts_tools.evaluate.images.recovery import Recording
from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.recovery import presses
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, Contours, Curve, Panel, Picture
from acts_tools.firmware.board_sampler import BoardSampler
from acts_tools.firmware.board_times import output_us, sampling_us
from acts_tools.training.frames import model_frames

_M = (50, 100, 200, 300, 400, 500)
_ATOMS = (50, 100, 200, 300, 400, 500)
_COLUMNS = (30, 60, 90, 120, 150)
_FINE = tuple(range(50, 501, 50))
"""M and atoms of the published map."""

_PATCHES, _FRAMES = 1492, 300
"""Patches that a dictionary is learnt from, as in the paper, and presses that they are cut from."""

_PRESSES, _PRESSES_FAST = 90, 10
_SLOWEST_HZ, _FASTEST_HZ = 10.0, 5000.0
"""Ends of the maps' colour scale."""

_M_LABEL = "taxels measured per frame, M"
_NOTE = "Rates: the virtual board's model, which is made of the published times; no board was at hand."


def _rates(output: str, columns: int) -> list[float]:
    return [1e6 / (sampling_us("adaptive", m) + output_us(output, columns, m)) for m in _M]


def _measure_rates(output: str, sizes: Sequence[int], letter: str) -> list[Panel]:
    ms = [float(m) for m in _M]
    curves = [Curve(f"{letter} = {size}", ms, _rates(output, size), SAME, f"C{n}") for n, size in enumerate(sizes)]
    alone = [1e6 / sampling_us("adaptive", m) for m in _M]
    raster = 1e6 / sampling_us("raster", 1024)
    curves += [
        Curve("sampling alone", ms, alone, OURS, "tracking"),
        Curve("raster", [ms[0], ms[-1]], [raster, raster], SAME, "raster"),
    ]
    return [Panel("frame rate", _M_LABEL, "frames/s", curves, log_x=True, log_y=True)]


def _measure_classification_rates(run: Run) -> list[Panel]:
    return _measure_rates("object", (60, 90), "L")


def _measure_recovery_rates(run: Run) -> list[Panel]:
    return _measure_rates("image", (50, 100), "K")


def _published_classification_rates(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    labels = {f"L = {size}": f"Binary subsampling+Classification L={size}" for size in (60, 90)}
    return _published_rates(data, panels, "fig8/M_fs_class.fig", labels)


def _published_recovery_rates(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    labels = {f"K = {size}": f"Binary subsampling+Reconstuction K_{{pat}}={size}" for size in (50, 100)}
    return _published_rates(data, panels, "fig8/M_fs_recon.fig", labels)


def _published_rates(
    data: PublishedData, panels: Sequence[Panel], file: str, labels: dict[str, str]
) -> dict[str, list[Curve]]:
    known = {**labels, "sampling alone": "Binary Subsampling", "raster": "Full raster"}
    own = {curve.label: curve.scheme for curve in panels[0].curves}
    return {
        panels[0].title: [
            data.curve(file, label, named=f"{name}, published", beside=name, scheme=own[name])
            for name, label in known.items()
        ]
    }


def _measure_support(run: Run) -> Any:
    """Support accuracy of dictionaries of few atoms over M, on single frames of random presses."""
    sizes, ms = run.pick(_ATOMS, (50, 100)), run.pick(_M, (50, 200))
    items = list(OBJECTS.values())
    live = np.ones((32, 32), dtype=bool)
    frames = model_frames(items, run.pick(_PRESSES, _PRESSES_FAST), seed=run.seed + 1)
    recordings = [Recording(frame[None], 1.0, live) for frame in frames]
    values = []
    with run.progress("dictionaries for the board", len(sizes)) as progress:
        for number, atoms in enumerate(sizes):
            learnt = presses.learn(
                run,
                items,
                atoms=atoms,
                patches=run.pick(_PATCHES, 300),
                frames=run.pick(_FRAMES, 60),
                show=lambda share, done=number: progress.show(done + share),  # type: ignore[misc]
            )
            values.append([presses.support(recordings, presses.task(run, "paper", "adaptive", m), learnt) for m in ms])
    return {"atoms": list(sizes), "m": list(ms), "support": values}


def _measure_accuracy(run: Run) -> Any:
    """Accuracy of classification as on the board, two columns, over M and the size of the library."""
    sizes, ms = run.pick(_COLUMNS, (30, 60)), run.pick(_M, (50, 200))
    objects = len(OBJECTS)
    arm = PressingArm(seed=run.seed * 1000)
    asked, labels = arm.held_frames(run.pick(3, 1))
    known, names = arm.held_frames(max(sizes) // objects)
    columns_each = max(sizes) // objects
    values = []
    with run.progress("libraries for the board", len(sizes)) as progress:
        for number, size in enumerate(sizes):
            chosen = [k for k in range(len(known)) if k % columns_each < size // objects]
            library = build_object_library(known[chosen], [names[k] for k in chosen], touch_counts=TOUCH_COUNTS)
            config = ClassifierConfig(touch_counts=TOUCH_COUNTS, max_columns=BOARD_COLUMNS)
            classifier = Classifier(library, config)
            row = []
            for m in ms:
                sampler = BoardSampler(SamplingConfig(scheme="adaptive", m=m, threshold_counts=TOUCH_COUNTS))
                right = 0
                for frame, label in zip(asked, labels, strict=True):
                    answer = classifier.step(*sampler.frame(frame[None], 0.0, 0.0))
                    right += answer.touched and library.names[answer.best] == label
                row.append(right / len(asked))
            values.append(row)
            progress.show(number + 1)
    return {"columns": list(sizes), "m": list(ms), "accuracy": values}


def _map(title: str, output: str, sizes: Sequence[int], y_label: str, contours: Contours) -> Panel:
    rates = [[1e6 / output_us(output, size, m) for m in _FINE] for size in sizes]
    return Panel(title, _M_LABEL, y_label, picture=_picture(rates, sizes), contours=contours)


def _picture(rates: list[list[float]], sizes: Sequence[int]) -> Picture:
    half_m, half = (_FINE[1] - _FINE[0]) / 2, (sizes[1] - sizes[0]) / 2
    return Picture(
        rates[::-1],
        "frames/s, without sampling",
        _FINE[0] - half_m,
        _FINE[-1] + half_m,
        sizes[0] - half,
        sizes[-1] + half,
        logarithmic=True,
        lowest=_SLOWEST_HZ,
        highest=_FASTEST_HZ,
    )


def _levels(values: list[list[float]], wanted: Sequence[float]) -> list[float]:
    """Those of the wanted levels that the values cross; without any, their middle."""
    low, high = float(np.min(values)), float(np.max(values))
    return [level for level in wanted if low < level < high] or [(low + high) / 2]


def _measure_maps(run: Run) -> list[Panel]:
    support = run.shared("board_support", lambda: _measure_support(run))
    accuracy = run.shared("board_accuracy", lambda: _measure_accuracy(run))
    of_support = Contours(
        [float(m) for m in support["m"]],
        [float(atoms) for atoms in support["atoms"]],
        support["support"],
        _levels(support["support"], (0.93, 0.96, 0.98, 0.99)),
    )
    of_accuracy = Contours(
        [float(m) for m in accuracy["m"]],
        [float(columns) for columns in accuracy["columns"]],
        accuracy["accuracy"],
        _levels(accuracy["accuracy"], (0.6, 0.8, 0.9, 0.95)),
    )
    return [
        _map("recovery, lines: support accuracy", "image", _FINE, "atoms, K", of_support),
        _map("classification, lines: accuracy", "object", _COLUMNS, "library columns, L", of_accuracy),
    ]


def _published_map(data: PublishedData, panels: Sequence[Panel]) -> list[Panel]:
    rates = data.array("fig8_heatmap.npz", "fps").astype(float).tolist()
    panel = Panel("recovery, published", _M_LABEL, "atoms, K", picture=_picture(rates, _FINE), by=PUBLISHED)
    return [panel, *panels]


FIGURES = (
    Figure(
        "9A",
        "classification on the board, frame rate",
        _measure_classification_rates,
        _published_classification_rates,
        notes=(_NOTE,),
    ),
    Figure(
        "9B", "recovery on the board, frame rate", _measure_recovery_rates, _published_recovery_rates, notes=(_NOTE,)
    ),
    Figure(
        "9C",
        "recovery and classification on the board, rates and accuracies",
        _measure_maps,
        published_panels=_published_map,
        notes=(
            _NOTE,
            "Accuracies: the paper's method on simulated presses; the published lines are not among its files.",
        ),
    ),
)
