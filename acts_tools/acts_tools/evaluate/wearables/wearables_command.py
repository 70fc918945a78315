# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate wearables`: when events on worn skins began, and what untouched skins tell. The paper's figure 8.

What the numbers mean is told in docs/wearables.md.
"""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import Any

import numpy as np

from acts_core.errors import SettingsError
from acts_sim.wearables import SCENES, WORN_RATE_HZ, WornScene, worn_scene
from acts_tools.arguments import real, simulated_taxels
from acts_tools.evaluate import report
from acts_tools.evaluate.options import add_scene_arguments
from acts_tools.evaluate.scene_recordings import add_recordings_argument, scene_results, write_recording
from acts_tools.evaluate.wearables.happened import Tally
from acts_tools.evaluate.wearables.untouched import watch_untouched
from acts_tools.evaluate.wearables.watching import SCHEME, Watcher
from acts_tools.progress import Progress

SKINS = ("arm", "chest", "end_effector", "glove", "helmet", "insole", "leg")
"""Layouts that are watched untouched."""

_TITLE = (
    f"{'scene':12} {'events':>6} {'missed':>6} {'false':>5} {'parts':>5} {'as told':>7} {'onset ms':>8} {'median':>6} "
    f"{'max':>5} {'in 2 ms':>7} {'1 sigma':>7} {'at first':>8} {'delay':>5}"
)
_UNTOUCHED_TITLE = f"{'untouched':12} {'minutes':>7} {'frames':>7} {'told':>5} {'drift counts':>12}"


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate wearables``."""
    parser = commands.add_parser(
        "wearables",
        help="detect events on simulated worn skins, and none on untouched ones",
        description="Tap an arm, catch a ball, step, hit a helmet, touch a chest and juggle with a leg on simulated "
        "skins, and compare the onset of each event with the truth; then leave each skin alone, with noise and drift. "
        "docs/wearables.md explains the numbers.",
    )
    parser.add_argument("--scene", nargs="*", choices=tuple(SCENES), default=list(SCENES), help="default: all")
    parser.add_argument(
        "--untouched", nargs="*", choices=SKINS, default=list(SKINS), help="skins (default: all; without names: none)"
    )
    parser.add_argument(
        "--minutes",
        type=real(0.0, 1e6),
        default=10.0,
        metavar="T",
        help="each skin is left alone; 0: no skins (default: %(default)s)",
    )
    parser.add_argument("--m", type=simulated_taxels, default=64, help="taxels per frame (default: %(default)s)")
    add_scene_arguments(parser, 25, "of each scene")
    add_recordings_argument(parser, "the first of each scene, less the offsets of its skin,")
    parser.set_defaults(evaluate=_run)


def scene_of(name: str, seed: int, number: int) -> WornScene:
    """A scene by its number."""
    return worn_scene(name, np.random.default_rng([seed, number]))


def tally(name: str, seeds: int, m: int, noise_counts: float, seed: int, progress: Progress) -> Tally:
    """Watch scenes of one name."""
    found, watcher = Tally(name), None
    for number in range(seeds):
        shown = scene_of(name, seed, number)
        watcher = watcher or Watcher(shown.layout, noise_counts)
        found.add(shown, watcher.watch(shown, m, noise_counts, number + 1))
        progress.show(number + 1, name)
    return found


def _run(arguments: argparse.Namespace) -> int:
    untouched = arguments.untouched if arguments.minutes else []
    if not arguments.scene and not untouched:
        nothing = "--minutes is 0 and --scene names" if arguments.untouched else "--scene and --untouched name"
        raise SettingsError(f"{nothing} nothing; name a scene or a skin, or leave one of them out")
    about = {name: getattr(arguments, name) for name in ("m", "noise_counts", "seed", "seeds", "minutes")}
    results = scene_results(arguments, about)
    if arguments.scene:
        print(_TITLE, flush=True)
    for name in arguments.scene:
        if arguments.recordings is not None:
            frames = scene_of(name, arguments.seed, 0).frames
            # A board that repeats a scene is never untouched for as long as a calibration takes.
            write_recording(arguments.recordings, name, np.maximum(frames, frames[0]) - frames[0], WORN_RATE_HZ)
        with Progress(name, arguments.seeds) as progress:
            found = tally(name, arguments.seeds, arguments.m, arguments.noise_counts, arguments.seed, progress)
        kind = SCENES[name]
        entry = {"scene": name, "figure": kind.figure, "layout": kind.layout, "scheme": SCHEME, **found.summary()}
        results.add(entry, _line(entry))
    if untouched:
        print(_UNTOUCHED_TITLE, flush=True)
    elif arguments.untouched:
        print(f"untouched: {', '.join(arguments.untouched)} not watched, since --minutes is 0", flush=True)
    seconds = max(round(60 * arguments.minutes), 1)
    for name in untouched:
        # The same skin, whichever others are watched.
        rng = np.random.default_rng([arguments.seed, SKINS.index(name)])
        with Progress(name, seconds) as progress:
            alone = watch_untouched(name, seconds, arguments.m, arguments.noise_counts, rng, progress.show)
        results.add(
            {"untouched": name, "scheme": SCHEME, **asdict(alone)},
            f"{name:12} {alone.seconds / 60:7.1f} {alone.frames:7} {alone.told:5} {alone.drift_counts:12.1f}",
        )
    return 0


def _line(entry: dict[str, Any]) -> str:
    onset, first, delay = (entry[name] for name in ("onset_error_ms", "first_onset_error_ms", "delay_ms"))
    return (
        f"{entry['scene']:12} {entry['events']:6} {entry['missed']:6} {entry['false']:5} {entry['parts']:5} "
        f"{entry['as_expected']:7} {report.number(onset['mean'], 8, 2)} {report.number(onset['median'], 6, 2)} "
        f"{report.number(onset['max'], 5, 2)} {entry['onset_within_2_ms']:7} "
        f"{report.number(entry['onset_within_1_sigma'], 7, 2)} {report.number(first['mean'], 8, 2)} "
        f"{report.number(delay['mean'], 5, 1)}"
    )
