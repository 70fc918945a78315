# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate impacts`: tennis balls dropped on the simulated skin, by how many taxels a frame has.

The paper's figures 5B and 5C. What the numbers mean is told in docs/impacts.md.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_recon.impacts import Kind
from acts_sim.impacts import SCENE_RATE_HZ, Scene, ball_named, collide, dropped, scene
from acts_sim.pressing import skin_of
from acts_tools.arguments import real
from acts_tools.evaluate import report
from acts_tools.evaluate.estimators.methods import PAPER_TOUCH_COUNTS
from acts_tools.evaluate.impacts import plays
from acts_tools.evaluate.options import add_m, add_scene_arguments
from acts_tools.evaluate.scene_frames import frame_rate_hz
from acts_tools.evaluate.scene_recordings import add_recordings_argument, scene_results, write_recording
from acts_tools.evaluate.statistics import distribution, mean
from acts_tools.progress import Progress

_M = (42, 64, 88, 128, 256, 512, 1024)
_SCHEMES = ("adaptive", "tracking")
TOUCH_MS = 8.7
"""How long a ball touches, as published [ms]."""

_MIDDLE_M = 0.035
_UNTOUCHED_S = (0.045, 0.065)
_TITLE = (
    f"{'M':>4} {'method':6} {'scheme':9} {'frames/s':>8} {'frames':>7} {'detected':>8} {'force change':>12} "
    f"{'onset ms':>9} {'<1sigma':>8} {'duration ms':>11} {'peak':>5} {'impulse':>7} {'delay ms':>8}"
)


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate impacts``."""
    parser = commands.add_parser(
        "impacts",
        help="detect bounces of tennis balls on the simulated skin",
        description="Drop tennis balls from table height on the simulated skin, and sample the bounce with more and "
        "more taxels a frame. Count the frames that see it, and compare the reported onset, duration and force with "
        "the true ones. docs/impacts.md explains the numbers.",
    )
    add_m(parser, _M)
    parser.add_argument(
        "--touch-ms",
        # The weight of a ball prolongs its touch: by 5 % at 100 ms, and at 400 ms it does not bounce any more.
        type=real(0.5, 100.0),
        default=TOUCH_MS,
        metavar="T",
        help="how long a ball touches (default: %(default)s)",
    )
    add_scene_arguments(parser, 100, "drops")
    add_recordings_argument(parser, "the first drop")
    parser.set_defaults(evaluate=_run)


def drops_of(drops: int, seed: int, touch_ms: float) -> list[Scene]:
    """Tennis balls from table height, each on its own skin."""
    ball = ball_named("tennis")
    # The time of a touch goes with stiffness to the power -2 / 5, as in Hertz's law without losses.
    longer = 1e-3 * touch_ms / collide(ball, dropped()).duration_s
    ball = replace(ball, stiffness_n_per_m15=ball.stiffness_n_per_m15 * longer**-2.5)
    scenes = []
    for number in range(drops):
        rng = np.random.default_rng([seed, number])
        x_m, y_m = rng.uniform(-_MIDDLE_M, _MIDDLE_M, 2).tolist()
        untouched_s = float(rng.uniform(*_UNTOUCHED_S))
        scenes.append(scene(skin_of(rng), ball, dropped(x_m=x_m, y_m=y_m), untouched_s=untouched_s, rng=rng))
    return scenes


def _run(arguments: argparse.Namespace) -> int:
    about = {name: getattr(arguments, name) for name in ("touch_ms", "noise_counts", "seed", "seeds")}
    results = scene_results(arguments, about)
    scenes = drops_of(arguments.seeds, arguments.seed, arguments.touch_ms)
    if arguments.recordings is not None:
        write_recording(arguments.recordings, "drop", scenes[0].frames, SCENE_RATE_HZ)
    work = len(arguments.m) * (1 + len(_SCHEMES)) * len(scenes)
    print(_TITLE, flush=True)
    with Progress("impacts", work) as progress:
        done = 0
        for m in arguments.m:
            entries = [seen_by_paper(scenes, m, arguments.noise_counts)]
            progress.show(done := done + len(scenes))
            for scheme in _SCHEMES:
                entries.append(seen_by_us(scenes, scheme, m, arguments.noise_counts))
                progress.show(done := done + len(scenes))
            for entry in entries:
                results.add(entry, _line(entry))
    return 0


def seen_by_paper(scenes: Sequence[Scene], m: int, noise_counts: float) -> dict[str, Any]:
    """An entry of the report: the paper's method."""
    frames, changes = [], []
    for seed, shown in enumerate(scenes, start=1):
        sampled = plays.frames_of_paper(shown, m, noise_counts, seed)
        # A taxel that is measured keeps its value in the recovered image, and without one the image is 0.
        peaks = np.array([float(frame.counts.max()) for frame in sampled])
        touched = np.flatnonzero(peaks > PAPER_TOUCH_COUNTS)
        frames.append(touched.size)
        if touched.size:
            changes.append(_change(peaks[touched[0] : touched[-1] + 1]))
    return {**_common("paper", "raster" if m >= 1024 else "adaptive", m, frames, changes), "told": _seen(frames)}


def seen_by_us(scenes: Sequence[Scene], scheme: str, m: int, noise_counts: float) -> dict[str, Any]:
    """An entry of the report: ours with a scheme. Of several touches of a drop, that with the largest peak counts."""
    ours = plays.Ours(scheme, m, noise_counts)
    frames, changes, begun, further, bounced = [], [], 0, 0, 0
    delays_ms, onsets_ms, within, durations_ms, peaks_share, impulses_share = [], [], [], [], [], []
    for seed, shown in enumerate(scenes, start=1):
        told = ours.play(shown, seed)
        begun += any(not impact.is_over for _, impact in told)
        # One touch of each drop counts; all others did not happen.
        further += max(len({impact.number for _, impact in told}) - 1, 0)
        over = plays.strongest_over(told)
        frames.append(over.frames if over else 0)
        if over is None:
            continue
        changes.append(_change(over.force_n))
        truth = shown.collisions[0]
        begin_s = float(truth.time_s[0])
        bounced += over.kind is Kind.IMPACT and over.bounced
        delays_ms.append(1e3 * (min(at_s for at_s, impact in told if impact.number == over.number) - begin_s))
        onsets_ms.append(1e3 * abs(over.onset_s - begin_s))
        within.append(abs(over.onset_s - begin_s) <= over.onset_sd_s)
        durations_ms.append(1e3 * abs(over.duration_s - truth.duration_s))
        peaks_share.append(over.peak_n / float(truth.force_n.max()))
        impulses_share.append(over.impulse_n_s / truth.impulse_n_s)
    return {
        **_common("acts", scheme, m, frames, changes),
        "told": begun,
        "told_as_bounce": bounced,
        "told_further": further,
        "delay_ms": distribution(delays_ms),
        "onset_error_ms": distribution(onsets_ms),
        "onset_within_1_sigma": mean(within),
        "duration_error_ms": distribution(durations_ms),
        "peak_share": distribution(peaks_share),
        "impulse_share": distribution(impulses_share),
    }


def _common(method: str, scheme: str, m: int, frames: list[int], changes: list[float]) -> dict[str, Any]:
    return {
        "m": m,
        "method": method,
        "scheme": scheme,
        "rate_hz": frame_rate_hz(m),
        "drops": len(frames),
        "frames": float(np.mean(frames)),
        "frames_sd": float(np.std(frames)),
        "seen": _seen(frames),
        "force_change": mean(changes),
    }


def _seen(frames: list[int]) -> int:
    return sum(number > 0 for number in frames)


def _change(force: NDArray[np.float64]) -> float:
    """Mean change of the force from value to value, with 0 before the touch and after it, as a share of the largest."""
    return float(np.abs(np.diff(np.concatenate(([0.0], force, [0.0])))).mean() / force.max())


def _line(entry: dict[str, Any]) -> str:
    def mean_of(name: str, width: int, digits: int) -> str:
        return report.number(entry[name]["mean"] if name in entry else None, width, digits)

    return (
        f"{entry['m']:4} {entry['method']:6} {entry['scheme']:9} {entry['rate_hz']:8.1f} {entry['frames']:7.2f} "
        f"{entry['told']:>4}/{entry['drops']:<3} {report.number(entry['force_change'], 12, 3)} "
        f"{mean_of('onset_error_ms', 9, 2)} {report.number(entry.get('onset_within_1_sigma'), 8, 2)} "
        f"{mean_of('duration_error_ms', 11, 2)} {mean_of('peak_share', 5, 2)} {mean_of('impulse_share', 7, 2)} "
        f"{mean_of('delay_ms', 8, 2)}"
    )
