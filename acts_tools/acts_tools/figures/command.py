# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts figures`: draw figures of the paper, with the paper's curves, its method here, and ours."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from acts_core.errors import RecordingError
from acts_tools.arguments import random_seed
from acts_tools.evaluate import report
from acts_tools.figures.differences import differences
from acts_tools.figures.drawing import draw
from acts_tools.figures.figure import Figure
from acts_tools.figures.files import read_stamped, write_csv, write_images, write_stamped
from acts_tools.figures.published import VARIABLE, PublishedData, published_data
from acts_tools.figures.registry import FIGURES, figures_named
from acts_tools.figures.run import SHARED, Run
from acts_tools.figures.sheet import PUBLISHED, Panel, from_json, large_images, rows, to_json
from acts_tools.output_file import make_folder
from acts_tools.progress import Progress, tell

_HEADER = ("panel", "curve", "by", "x", "y", "low", "high")
_WITHOUT = f"The paper's curves are not drawn: give their folder as --paper-data or {VARIABLE} (docs/paper.md)."
_MISSING = "The paper's curves are not drawn: they are not all in the given folder."


_OUT, _OUT_FAST = Path("figures"), Path("figures_fast")
_SUFFIXES = (".json", ".csv", ".npz", ".png")

_EPILOG = """\
examples:
  acts figures 4E --fast                                one figure, in rough numbers, in the folder figures_fast
  acts figures                                          all of them, in the folder figures
"""


def add_parser(subparsers: Any) -> None:
    """Add ``acts figures`` to the acts command."""
    parser = subparsers.add_parser(
        "figures",
        help="draw the paper's figures beside ours",
        description="Draw figures of the paper, each with the paper's curves where it has some, the paper's method on "
        "our simulated skin, and our method. Beside each picture are its numbers, as JSON and CSV. A figure that was "
        "measured with the same code, seed and size is not measured again. docs/paper.md discusses every figure.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("name", nargs="*", metavar="NAME", help=f"of {', '.join(FIGURES)} (default: all)")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help=f"replaces figures there (default: {_OUT}, with --fast {_OUT_FAST})"
    )
    parser.add_argument(
        "--fast",
        action="store_true",
        help="few presses and drops, rough numbers: one to two minutes for all, several on a busy machine",
    )
    parser.add_argument(
        "--seed", type=random_seed, default=1, metavar="X", help="of everything random (default: %(default)s)"
    )
    parser.add_argument(
        "--again",
        action="store_true",
        help="measure again what was measured before; after Ctrl-C, continue without it",
    )
    parser.add_argument(
        "--paper-data",
        type=Path,
        metavar="DIR",
        help=f"folder with the published curves (default: that of the environment variable {VARIABLE}, else none)",
    )
    parser.add_argument("--json", type=Path, metavar="OUT", help="write all figures' numbers to one JSON file, too")


def run(arguments: argparse.Namespace) -> int:
    """Draw the figures and return the exit code: 1 where published curves of a figure are missing in the folder.

    Raises
    ------
    ActsError
        When a name is unknown, a file cannot be written, or the tables of the published curves cannot be read.
    """
    figures = figures_named(arguments.name)
    published = published_data(arguments.paper_data)
    out = arguments.out or (_OUT_FAST if arguments.fast else _OUT)
    make_folder(out, "--out")
    if arguments.json is not None and _is_own_file(arguments.json, out):
        raise RecordingError(
            f"--json {arguments.json}: is where a figure keeps its own numbers or picture; give another name"
        )
    one = Run(out, arguments.seed, arguments.fast, arguments.again)
    results = report.Results(arguments.json, one.settings, reads=[] if published is None else published.files())
    if published is None and any(figure.has_published for figure in figures):
        print(_WITHOUT)
    code = 0
    with Progress("figures", len(figures)) as progress:
        for number, figure in enumerate(figures):
            progress.show(number, figure.name)
            entry = _make(figure, one, published)
            results.add(entry)
            if published is not None and figure.has_published and not entry["published"]:
                code = 1
    return code


def _is_own_file(path: Path, out: Path) -> bool:
    """Whether figures in a folder may have a file there: numbers, tables, pictures, and what several of them share."""
    place, folder = path.resolve(), out.resolve()
    names = {f"{figure.file_name}{suffix}" for figure in FIGURES.values() for suffix in _SUFFIXES}
    return (place.parent == folder and place.name in names) or place.parent == folder / SHARED


def _make(figure: Figure, one: Run, published: PublishedData | None) -> dict[str, Any]:
    """Measure a figure, or read what was measured, draw it, and return what its JSON file contains."""
    path = one.out / f"{figure.file_name}.json"
    known = None if one.again else read_stamped(path, one.settings)
    began_s = time.monotonic()
    panels = figure.measure(one) if known is None else _measured(known)
    spent_s = time.monotonic() - began_s
    entry = _entry(figure, one, panels, published=False)
    # At once: whatever is wrong with what was published or with the drawing, this is not measured again.
    write_stamped(path, entry)
    notes = figure.notes_of(one)
    if figure.has_published and published is None:
        notes.append(_WITHOUT)
    elif figure.has_published and published is not None:
        try:
            panels = figure.with_published(published, panels)
        except RecordingError as error:
            tell(f"error: figure {figure.name} is drawn without the paper's curves: {error}", sys.stderr)
            notes.append(_MISSING)
        else:
            entry = _entry(figure, one, panels, published=True)
            write_stamped(path, entry)
    command = one.command(figure.name)
    write_csv(path.with_suffix(".csv"), command, _HEADER, rows(panels))
    if images := large_images(panels):
        write_images(path.with_suffix(".npz"), command, images)
    draw(path.with_suffix(".png"), figure, panels, command, notes)
    how = "as measured before" if known is not None else f"measured in {spent_s:.1f} s"
    tell(f"{figure.name:5} {path.with_suffix('.png')}, {how}")
    for line in entry["differences"]:
        tell(
            f"      {line['panel']}: {line['curve']} differs from {line['published']} by {line['mean_absolute']:.3g} "
            f"({100 * line['mean_relative']:.1f} %) in the mean, {line['mean']:+.3g} with sign"
        )
    return entry


def _entry(figure: Figure, one: Run, panels: Sequence[Panel], *, published: bool) -> dict[str, Any]:
    """What the JSON file of a figure contains."""
    return {
        "figure": figure.name,
        "title": figure.title,
        "command": one.command(figure.name),
        **one.settings,
        "notes": figure.notes_of(one),
        "published": published,
        "differences": differences(panels),
        "panels": to_json(panels),
    }


def _measured(known: dict[str, Any]) -> list[Panel]:
    """Panels of a file without what is published, which is read anew."""
    return [panel.without_published() for panel in from_json(known["panels"]) if panel.by != PUBLISHED]
