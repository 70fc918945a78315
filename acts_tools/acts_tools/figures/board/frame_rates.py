# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Figures 4D, S1 and S2: frames a second over M, and what other tactile arrays read."""

from __future__ import annotations

from collections.abc import Sequence

from acts_tools.figures.figure import Figure
from acts_tools.figures.published import PublishedData
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OTHERS, OURS, SAME, Curve, Panel
from acts_tools.firmware.board_times import sampling_us

_M = (36, 42, 48, 49, 55, 56, 64, 66, 77, 88, 96, 112, 121, 128, 160, 176, 192, 224, 256, 352, 512)
_FILE = "fig4/M_fs.fig"
_FASTEST_HZ = 1000.0
"""Largest frame rate of our board by default."""

_TAXELS = 1024

_ARRAYS = {
    "tactile glove (Sundaram 2019)": (548, 7),
    "tactile textiles (Luo 2021)": (216, 14),
    "Gifu Hand III": (859, 100),
    "TactArray (PPS)": (1024, 10),
    "I-Scan (Tekscan)": (1936, 100),
    "RoboTouch (PPS)": (162, 30),
    "humanoid (Schmid 2008)": (504, 40),
    "Shadow fingertip": (34, 20),
    "whole-sensitive arm (Lumelsky 1993)": (475, 20),
    "modularized skin (Um 1998)": (960, 100),
    "whole-body humanoid (Ohmura 2007)": (1864, 20),
}
"""Taxels and frames a second of other arrays, as the paper's table S1 cites them."""


def _rates(scheme: str) -> list[float]:
    return [1e6 / sampling_us(scheme, m) for m in _M]


def _measure_rates(run: Run) -> list[Panel]:
    ms = [float(m) for m in _M]
    curves = [
        Curve(f"{scheme}, board's model", ms, _rates(scheme), SAME, scheme)
        for scheme in ("uniform", "random", "adaptive")
    ]
    ours = [min(rate, _FASTEST_HZ) for rate in _rates("tracking")]
    curves.append(Curve("tracking, at most 1000", ms, ours, OURS, "tracking"))
    raster = 1e6 / sampling_us("raster", _TAXELS)
    curves.append(Curve("raster, board's model", [ms[0], ms[-1]], [raster, raster], SAME, "raster"))
    return [
        Panel("frame rate over M", "taxels measured per frame, M", "frames/s", curves, log_x=True, log_y=True),
    ]


def _published_rates(data: PublishedData, panels: Sequence[Panel]) -> dict[str, list[Curve]]:
    labels = {
        "Down-sampling": "uniform",
        "Random sampling": "random",
        "Binary sampling": "adaptive",
        "Raster": "raster",
    }
    return {
        panels[0].title: [
            data.curve(_FILE, label, named=f"{scheme}, published", beside=f"{scheme}, board's model", scheme=scheme)
            for label, scheme in labels.items()
        ]
    }


def _measure_arrays(run: Run) -> list[Panel]:
    points = [
        Curve(name, [float(taxels)], [float(rate)], OTHERS, points=True) for name, (taxels, rate) in _ARRAYS.items()
    ]
    ours = Curve("ACTS, M = 55", [float(_TAXELS)], [1e6 / sampling_us("tracking", 55)], OURS, "tracking", points=True)
    return [Panel("arrays without electronics in the skin", "taxels", "frames/s", [*points, ours], log_y=True)]


def _measure_sensor_rate(run: Run) -> list[Panel]:
    points = [
        Curve(name, [float(taxels)], [float(taxels * rate)], OTHERS, points=True)
        for name, (taxels, rate) in _ARRAYS.items()
    ]
    ms = [float(m) for m in _M]
    images = Curve("ACTS, taxels of images", ms, [_TAXELS * rate for rate in _rates("tracking")], OURS, "tracking")
    measured = Curve(
        "ACTS, taxels measured",
        ms,
        [m * rate for m, rate in zip(_M, _rates("tracking"), strict=True)],
        SAME,
        "adaptive",
    )
    return [
        Panel(
            "total sensor rate",
            "taxels measured per frame",
            "taxels/s",
            [*points, images, measured],
            log_x=True,
            log_y=True,
        )
    ]


FIGURES = (
    Figure(
        "4D",
        "frame rate over the taxels measured",
        _measure_rates,
        _published_rates,
        notes=("The board's model is made of the authors' times per frame; no board was at hand.",),
    ),
    Figure(
        "S1",
        "other tactile arrays",
        _measure_arrays,
        notes=("Other arrays: numbers of the paper's table S1, which cites them. ACTS: the board's model.",),
    ),
    Figure(
        "S2",
        "total sensor rate over the taxels measured",
        _measure_sensor_rate,
        notes=(
            "The paper counts all 1024 taxels of every recovered image; measured are 52,600 to 56,600 taxels/s.",
            "Other arrays: numbers of the paper's table S1, which cites them. ACTS: the board's model.",
        ),
    ),
)
