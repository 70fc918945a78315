# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate edges`: edges that strike the simulated skin: how well their force and place are known.

What the numbers mean is told in docs/impacts.md.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np

from acts_recon.impacts import UNKNOWN_DIRECTION_SD_RAD, Kind
from acts_sim.impacts import SCENE_RATE_HZ, Edge, Scene, struck
from acts_sim.pressing import skin_of
from acts_tools.evaluate import report
from acts_tools.evaluate.impacts import plays
from acts_tools.evaluate.options import add_m, add_scene_arguments
from acts_tools.evaluate.scene_frames import frame_rate_hz
from acts_tools.evaluate.scene_recordings import add_recordings_argument, scene_results, write_recording
from acts_tools.evaluate.statistics import distribution_with_max
from acts_tools.progress import Progress

_M = (64, 128)
_SCHEMES = ("tracking", "adaptive", "random", "uniform")
_WIDTH_M, _TIMES_AS_LONG = 0.008, (1.5, 6.0)
# In the middle of the edge, before the foam spreads it: its taxels read 500 to 850 counts then.
_TOP_PA = (30e3, 60e3)
_MIDDLE_M = 0.03
_TOUCH_S = 0.008
_UNTOUCHED_S = (0.045, 0.065)
_TITLE = (
    f"{'scheme':9} {'M':>4} {'frames/s':>8} {'told':>8} {'with direction':>14} {'force: 5 %':>10} {'median':>6} "
    f"{'95 %':>5} {'largest':>7} {'off mm: median':>14} {'95 %':>5}"
)


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate edges``."""
    parser = commands.add_parser(
        "edges",
        help="measure force and place of edges that strike the simulated skin",
        description="Let edges strike the simulated skin, and compare the reported force and place with the true "
        "ones. docs/impacts.md explains the numbers.",
    )
    parser.add_argument(
        "--scheme", nargs="+", default=list(_SCHEMES), choices=_SCHEMES, help=f"default: {' '.join(_SCHEMES)}"
    )
    add_m(parser, _M)
    add_scene_arguments(parser, 100, "edges")
    add_recordings_argument(parser, "the first edge")
    parser.set_defaults(evaluate=_run)


def numbered_edge(seed: int, number: int) -> tuple[Scene, Edge]:
    """An edge by its number, on a skin of its own."""
    rng = np.random.default_rng([seed, number])
    x_m, y_m = rng.uniform(-_MIDDLE_M, _MIDDLE_M, 2).tolist()
    length_m = _WIDTH_M * float(rng.uniform(*_TIMES_AS_LONG))
    # The volume of half an ellipsoid.
    peak_n = math.pi / 6.0 * length_m * _WIDTH_M * float(rng.uniform(*_TOP_PA))
    edge = Edge(x_m, y_m, length_m, _WIDTH_M, float(rng.uniform(0.0, math.pi)), peak_n, _TOUCH_S)
    return struck(skin_of(rng), edge, untouched_s=float(rng.uniform(*_UNTOUCHED_S))), edge


def _run(arguments: argparse.Namespace) -> int:
    about = {name: getattr(arguments, name) for name in ("noise_counts", "seed", "seeds")}
    results = scene_results(arguments, about)
    if arguments.recordings is not None:
        write_recording(arguments.recordings, "edge", numbered_edge(arguments.seed, 0)[0].frames, SCENE_RATE_HZ)
    # What is named twice is one.
    cases = [(scheme, m) for scheme in dict.fromkeys(arguments.scheme) for m in dict.fromkeys(arguments.m)]
    print(_TITLE, flush=True)
    with Progress("edges", len(cases) * arguments.seeds) as progress:
        done = 0
        for scheme, m in cases:
            ours = plays.Ours(scheme, m, arguments.noise_counts)
            told = []
            for number in range(arguments.seeds):
                told.append(told_of(ours, *numbered_edge(arguments.seed, number), number + 1))
                progress.show(done := done + 1)
            entry = {"scheme": scheme, "m": m, "rate_hz": frame_rate_hz(m), **scores_of(told)}
            results.add(entry, _line(entry))
    return 0


def told_of(ours: plays.Ours, shown: Scene, edge: Edge, seed: int) -> tuple[float, float, bool] | None:
    """Of the strongest touch: its force as a share of the true one, how far off it is [m], and whether a direction is
    told; None where no impact is."""
    impact = plays.strongest_over(ours.play(shown, seed))
    if impact is None or impact.kind is not Kind.IMPACT:
        return None
    off_m = math.hypot(impact.x_m - edge.x_m, impact.y_m - edge.y_m)
    return impact.peak_n / edge.peak_n, off_m, impact.direction_sd_rad < UNKNOWN_DIRECTION_SD_RAD


def scores_of(told: list[tuple[float, float, bool] | None]) -> dict[str, Any]:
    """An entry of the report, of what `told_of` returns."""
    known = [one for one in told if one is not None]
    shares, off_m, has_direction = zip(*known, strict=True) if known else ((), (), ())
    return {
        "edges": len(told),
        "told": len(known),
        "with_direction": sum(has_direction),
        "peak_share": {"p5": float(np.percentile(shares, 5)) if shares else None, **distribution_with_max(shares)},
        "off_mm": distribution_with_max([1e3 * one for one in off_m]),
    }


def _line(entry: dict[str, Any]) -> str:
    share, off = entry["peak_share"], entry["off_mm"]
    return (
        f"{entry['scheme']:9} {entry['m']:4} {entry['rate_hz']:8.1f} {entry['told']:>4}/{entry['edges']:<3} "
        f"{entry['with_direction']:14} {report.number(share['p5'], 10, 2)} {report.number(share['median'], 6, 2)} "
        f"{report.number(share['p95'], 5, 2)} {report.number(share['max'], 7, 2)} "
        f"{report.number(off['median'], 14, 2)} {report.number(off['p95'], 5, 2)}"
    )
