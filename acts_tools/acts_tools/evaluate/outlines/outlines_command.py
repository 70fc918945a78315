# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate outlines`: tennis ball, silicone block and balloon on the simulated skin. The paper's figure 6.

What the numbers mean is told in docs/outlines.md.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from acts_core.array import ArrayGeometry
from acts_sim.deforming import BODIES, SoftContact, body_named, soft_contact
from acts_sim.impacts import SCENE_RATE_HZ
from acts_sim.pressing import skin_of
from acts_tools.evaluate import report
from acts_tools.evaluate.options import add_m, add_scene_arguments
from acts_tools.evaluate.outlines import tracing
from acts_tools.evaluate.outlines.surface_files import write_surfaces
from acts_tools.evaluate.outlines.tracing import Traced
from acts_tools.evaluate.scene_frames import frame_rate_hz
from acts_tools.evaluate.scene_recordings import add_recordings_argument, scene_results, write_recording
from acts_tools.evaluate.statistics import distribution_with_max, mean
from acts_tools.output_file import make_folder, require_apart
from acts_tools.progress import Progress

_M = (64, 88, 128, 256, 352, 512)
_FIRST = 2
"""Frames of a touch that are not judged: from the third on."""
_TITLE = (
    f"{'body':8} {'M':>4} {'method':6} {'scheme':9} {'frames/s':>8} {'touches':>7} {'frames':>6} {'of':>5} "
    f"{'from 3rd: error':>15} {'p95':>5} {'none':>5}"
)


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate outlines``."""
    parser = commands.add_parser(
        "outlines",
        help="trace the outlines of soft bodies that meet the simulated skin",
        description="Let a tennis ball, a silicone block and a balloon meet the simulated skin, and compare the "
        "outline of each frame with the true one. docs/outlines.md explains the numbers.",
    )
    add_m(parser, _M)
    parser.add_argument("--body", nargs="+", choices=tuple(BODIES), default=list(BODIES), help="default: all")
    add_scene_arguments(parser, 25, "touches of each body")
    parser.add_argument(
        "--surfaces", type=Path, metavar="FOLDER", help="write the first touch of each body here: PNG, and PLY for 3D"
    )
    add_recordings_argument(parser, "the first touch of each body")
    parser.set_defaults(evaluate=_run)


def _run(arguments: argparse.Namespace) -> int:
    about = {name: getattr(arguments, name) for name in ("noise_counts", "seed", "seeds")}
    require_apart(arguments.json, arguments.surfaces, ".png", ".ply")
    results = scene_results(arguments, about)
    if arguments.surfaces is not None:
        make_folder(arguments.surfaces, "--surfaces")
    print(_TITLE, flush=True)
    with Progress("outlines", len(arguments.body) * len(arguments.m) * arguments.seeds) as progress:
        done = 0
        for name in arguments.body:
            touches = [touch_of(name, arguments.seed, number) for number in range(arguments.seeds)]
            if arguments.recordings is not None:
                write_recording(arguments.recordings, name, touches[0].frames, SCENE_RATE_HZ)
            for m in arguments.m:
                told: dict[tuple[str, str], list[list[Traced]]] = {}
                for number, shown in enumerate(touches, start=1):
                    for contender, one in _traced_by_all(shown, m, arguments.noise_counts, number):
                        told.setdefault(contender, []).append(one)
                    progress.show(done := done + 1)
                for (method, scheme), traced in told.items():
                    entry = {"body": name, "m": m, "method": method, "scheme": scheme, **scores_of(traced, m)}
                    results.add(entry, _line(entry))
                if arguments.surfaces is not None:
                    outlines = tracing.our_outlines(touches[0], m, arguments.noise_counts, 1)
                    write_surfaces(arguments.surfaces, f"{name}_m{m}", outlines)
    return 0


def _traced_by_all(
    shown: SoftContact, m: int, noise_counts: float, seed: int
) -> Iterator[tuple[tuple[str, str], list[Traced]]]:
    """A touch of a body as each contender tells its outline: method and scheme, and what they have traced."""
    scheme_of_paper = tracing.PAPER_SCHEMES[shown.body.name]
    yield ("paper", scheme_of_paper), tracing.paper(shown, m, noise_counts, seed)
    for scheme in (tracing.SCHEME, scheme_of_paper):
        yield ("acts", scheme), tracing.ours(shown, m, noise_counts, seed, scheme)


def touch_of(name: str, seed: int, number: int) -> SoftContact:
    """A touch of a body, by its number."""
    rng = np.random.default_rng([seed, number])
    return soft_contact(skin_of(rng), body_named(name), rng)


def scores_of(touches: Sequence[Sequence[Traced]], m: int) -> dict[str, Any]:
    """An entry of the report, without names."""
    pitch_m = ArrayGeometry().pitch_m
    late = [one.error_taxels(pitch_m) for traced in touches for one in traced[_FIRST:]]
    errors = [error for error in late if error is not None]
    most = max((len(traced) for traced in touches), default=0)
    by_frame = [
        [error for traced in touches if len(traced) > k and (error := traced[k].error_taxels(pitch_m)) is not None]
        for k in range(most)
    ]
    return {
        "rate_hz": frame_rate_hz(m),
        "touches": len(touches),
        "frames_with_outline": float(np.mean([tracing.frames_seen(traced) for traced in touches])),
        "frames_of_touch": float(np.mean([len(traced) for traced in touches])),
        "error_taxels_from_third": distribution_with_max(errors),
        "frames_from_third": len(late),
        "without_outline_from_third": len(late) - len(errors),
        "error_taxels_by_frame": [mean(one) for one in by_frame],
    }


def _line(entry: dict[str, Any]) -> str:
    error = entry["error_taxels_from_third"]
    return (
        f"{entry['body']:8} {entry['m']:4} {entry['method']:6} {entry['scheme']:9} {entry['rate_hz']:8.1f} "
        f"{entry['touches']:7} {entry['frames_with_outline']:6.1f} {entry['frames_of_touch']:5.1f} "
        f"{report.number(error['mean'], 15, 3)} {report.number(error['p95'], 5, 2)} "
        f"{entry['without_outline_from_third']:5}"
    )
