# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures S4 and S5: the sparsity of the recovery, and the dictionary as a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.recovery import presses
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OURS, PUBLISHED, SAME, TRUTH, Curve, Panel, Picture

_RATIOS = (0.05, 0.10, 0.15, 0.20, 0.25, 0.35, 0.50, 0.75, 1.0)
_RATIOS_FAST = (0.05, 0.25)
_M = (64, 128, 256, 512)
_PAPERS_RATIO = 0.25
_ATOMS_A_ROW = 40
_GAP = 1


def _measure_sparsity(run: Run) -> list[Panel]:
    def measure() -> Any:
        ms, ratios = run.pick(_M, (64,)), run.pick(_RATIOS, _RATIOS_FAST)
        recordings = presses.presses(run, presses.objects(run))
        dictionary = presses.shipped()
        found: dict[str, list[float]] = {}
        with run.progress("sparsity", len(ms) * len(ratios)) as progress:
            for m in ms:
                values = found.setdefault(str(m), [])
                for ratio in ratios:
                    its = presses.task(run, "paper", "adaptive", m, rate_hz=presses.TENTH_HZ, sparsity_ratio=ratio)
                    values.append(presses.support(recordings, its, dictionary))
                    progress.show(sum(map(len, found.values())))
        its = presses.task(run, "acts", "tracking", 64)
        return {"ratios": list(ratios), "support": found, "ours": presses.support(recordings, its, dictionary)}

    found = run.shared("sparsity", measure)
    x = [100 * ratio for ratio in found["ratios"]]
    curves = [Curve(f"adaptive, M = {m}", x, values, SAME) for m, values in found["support"].items()]
    lowest = min(min(values) for values in found["support"].values())
    curves += [
        Curve("ours, tracking, M = 64", [x[0], x[-1]], [found["ours"]] * 2, OURS, "tracking"),
        Curve("the paper's 25 %", [100 * _PAPERS_RATIO] * 2, [lowest, found["ours"]], TRUTH, "truth"),
    ]
    return [Panel("support over sparsity", "atoms per measured taxel [%]", "support accuracy", curves)]


def _mosaic(atoms: NDArray[np.floating], side: int) -> list[list[float]]:
    """All atoms beside one another, each divided by its largest entry; pixels numbered column first."""
    rows = -(-atoms.shape[1] // _ATOMS_A_ROW)
    step = side + _GAP
    image = np.zeros((rows * step - _GAP, _ATOMS_A_ROW * step - _GAP))
    for number, atom in enumerate(atoms.T):
        row, col = divmod(number, _ATOMS_A_ROW)
        shown = atom.reshape(side, side).T / np.abs(atom).max()
        image[row * step : row * step + side, col * step : col * step + side] = shown
    return image.round(2).tolist()


def _panel(title: str, atoms: NDArray[np.floating], side: int, by: str = "") -> Panel:
    image = _mosaic(atoms, side)
    rows = len(image) / (side + _GAP)
    picture = Picture(
        image, "share of the largest entry", right=float(_ATOMS_A_ROW), bottom=rows, lowest=-0.3, highest=1.0
    )
    return Panel(title, "atom of a row", f"row of {_ATOMS_A_ROW} atoms", picture=picture, by=by, equal=True)


def _measure_dictionary(run: Run) -> list[Panel]:
    dictionary = presses.shipped()
    return [_panel("the dictionary that comes with ACTS", dictionary.atoms, dictionary.patch_size)]


def _published_dictionary(data: PublishedData, panels: Sequence[Panel]) -> list[Panel]:
    atoms = data.array("dictionaries.npz", "learned_unit_est")
    return [_panel("published (estimated from its picture)", atoms, 8, PUBLISHED), *panels]


FIGURES = (
    Figure(
        "S4",
        "support accuracy over the sparsity of the recovery",
        _measure_sparsity,
        notes=("The published curve is not among the paper's figure files. Ours uses no dictionary.",),
    ),
    Figure(
        "S5",
        "the learnt dictionary, 1000 atoms of 8 x 8",
        _measure_dictionary,
        published_panels=_published_dictionary,
        columns=1,
        panel_inch=(8.2, 5.2),
        notes=("Each atom is divided by its largest entry.",),
    ),
)
