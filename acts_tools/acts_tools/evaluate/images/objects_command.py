# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate objects`: support accuracy over M on the objects of the contact model, like the paper's figure 4E."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from acts_sim.pressing import (
    OBJECTS,
    PRESS_RATE_HZ,
    ContactModel,
    ContactObject,
    FoamConfig,
    object_named,
    press_over_time,
)
from acts_tools.arguments import at_least_one
from acts_tools.evaluate import report
from acts_tools.evaluate.images import options
from acts_tools.evaluate.images.recovery import Recording
from acts_tools.evaluate.images.tasks import evaluate_all, require_scored
from acts_tools.evaluate.options import add_m
from acts_tools.evaluate.picture import diagrams
from acts_tools.output_file import require_picture

_M = (42, 56, 64, 88, 128, 176, 256, 352, 512)
_PER_FRAME = ("adaptive", "uniform", "random")


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate objects``."""
    parser = commands.add_parser(
        "objects",
        help="score the support accuracy over M on simulated presses of 30 objects",
        description="Press every object down and up again at a random position, angle and depth. Compare the paper's "
        "method and linear interpolation, each with three sampling schemes, with a method of ours with tracking on "
        "the same frames, from first to last touch.",
    )
    add_m(parser, _M)
    parser.add_argument("--objects", nargs="+", default=list(OBJECTS), metavar="NAME", help="default: all 30")
    parser.add_argument("--ours", default=options.METHOD, **options.method_argument())
    parser.add_argument(
        "--presses", type=at_least_one, default=1, metavar="N", help="per object (default: %(default)s)"
    )
    options.add_common_arguments(parser, noise_counts=3.0, onset_s=0.0)
    parser.add_argument("--picture", type=Path, metavar="PNG", help="draw the curves")
    parser.set_defaults(evaluate=_run)


def press_recordings(items: Sequence[ContactObject], presses: int, seed: int) -> list[Recording]:
    """Press objects down and up again, each as often, at random positions, angles and depths."""
    # The sampler adds the noise.
    model = ContactModel(config=FoamConfig(noise_counts=0.0), seed=seed)
    live = np.ones((model.geometry.rows, model.geometry.cols), dtype=bool)
    return [Recording(press_over_time(model, item), PRESS_RATE_HZ, live) for _ in range(presses) for item in items]


def _run(arguments: argparse.Namespace) -> int:
    pairs = [(method, scheme) for method in ("paper", "linear") for scheme in _PER_FRAME]
    pairs.append((arguments.ours, "tracking"))
    options.require_used(arguments, [scheme for _, scheme in pairs], [method for method, _ in pairs])
    options.require_frames((scheme, m) for m in arguments.m for _, scheme in pairs)
    tasks = [options.task(arguments, scheme, m, method) for m in arguments.m for method, scheme in pairs]
    # An object that is named twice is one: its presses would count twice.
    names = list(dict.fromkeys(arguments.objects))
    results = options.results(arguments, objects=names, presses=arguments.presses)
    require_picture(arguments.picture, report=arguments.json)
    dictionary = options.dictionary(arguments)
    items = [object_named(name) for name in names]
    recordings = press_recordings(items, arguments.presses, arguments.seed)
    evaluate_all(recordings, tasks, dictionary, results)
    require_scored(results.entries, ", ".join(names), tasks[0].touch_counts)
    curves = {
        f"{method}, {scheme}": [
            r["support_accuracy"] for r in results.entries if (r["method"], r["scheme"]) == (method, scheme)
        ]
        for method, scheme in pairs
    }
    _print_curves(arguments.m, curves)
    if arguments.picture:
        _draw(arguments.picture, arguments.m, curves)
    return 0


def _print_curves(ms: list[int], curves: dict[str, list[float | None]]) -> None:
    print("\n| support accuracy at M = | " + " | ".join(map(str, ms)) + " |")
    print("|---" * (len(ms) + 1) + "|")
    for name, values in curves.items():
        print(f"| {name} | " + " | ".join(report.number(value, 6, 4).strip() for value in values) + " |")


def _draw(path: Path, ms: list[int], curves: dict[str, list[float | None]]) -> None:
    with diagrams(path, 1, 1, size_inch=(7, 4.5), dpi=110) as (axes,):
        colours = {"adaptive": "tab:blue", "uniform": "tab:orange", "random": "tab:green", "tracking": "tab:red"}
        for name, values in curves.items():
            method, scheme = name.split(", ")
            style = ":" if method == "linear" else "-"
            axes.plot(ms, values, style, marker="o", markersize=3, color=colours[scheme], label=name)
        axes.set_xscale("log", base=2)
        axes.set_xticks(ms, [str(m) for m in ms])
        axes.set_xlabel("taxels measured per frame, M")
        axes.set_ylabel("support accuracy")
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
