# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate slip`: detect slip in recordings of full frames.

Recordings of slip have no labels, so no accuracy can be given. Two things are counted: how often slip is detected at
all, and how often while the grip is steady, where there should be none. A picture shows the path of the centre of
pressure with the detections.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from acts_core.array import ArrayGeometry
from acts_core.errors import RecordingError
from acts_core.files import FramesFile, load_frames
from acts_core.settings import part_of
from acts_core.words import counted
from acts_recon.slip import SMALLEST_SIDE, SlipConfig, SlipDetector
from acts_tools.arguments import add_settings, real
from acts_tools.evaluate import report
from acts_tools.evaluate.options import add_json
from acts_tools.evaluate.picture import diagrams
from acts_tools.large_files import tell_if_large
from acts_tools.output_file import require_picture

# A grip is steady where its force changes by less than this share of its largest, for this time before and after.
_STEADY_SHARE = 0.05
_STEADY_S = 0.26


@dataclass
class PatchResult:
    """One patch in one recording.

    Attributes
    ----------
    patch : int
        Index of the patch, in the order of `patches`.
    pressed, told, steady, told_while_steady : int
        Number of frames with pressure; of these, those with slip; those with a steady grip; those with both.
    events : list of (float, float, float)
        Start and end of slip [s], and the largest distance within a window [taxels].
    path : list of (float, float, float, bool)
        Time [s], row and column of the centre of pressure, and whether there was slip, of each frame with pressure.
    """

    patch: int
    pressed: int = 0
    told: int = 0
    steady: int = 0
    told_while_steady: int = 0
    events: list[tuple[float, float, float]] = field(default_factory=list)
    path: list[tuple[float, float, float, bool]] = field(default_factory=list)


def add_parser(commands: Any) -> None:
    """Add ``acts evaluate slip``."""
    parser = commands.add_parser(
        "slip",
        help="detect slip in recordings, and count detections in a steady grip",
        description="Detect motion along the skin on every patch of a recording. Patches are the connected parts of "
        "the live taxels. Without labels, it counts the frames with slip, and those with slip in a steady grip.",
    )
    parser.add_argument("--frames", type=Path, required=True, metavar="FILE.npz", help="full frames (docs/recovery.md)")
    parser.add_argument(
        "--rate-hz", type=real(1e-3, 1e6), metavar="R", help="frames per second (default: what the file says)"
    )
    parser.add_argument(
        "--pitch-m",
        type=real(1e-4, 0.1),
        default=ArrayGeometry().pitch_m,
        metavar="P",
        help="taxel pitch [m] (default: %(default)s)",
    )
    parser.add_argument(
        "--noise-counts",
        type=real(1e-3, 1e3),
        default=1.5,
        metavar="S",
        help="noise of a taxel (default: %(default)s)",
    )
    add_settings(parser, SlipConfig)
    add_json(parser)
    parser.add_argument("--picture", type=Path, metavar="PNG", help="draw paths and detected slip")
    parser.set_defaults(evaluate=_run)


def patches(live: NDArray[np.bool_]) -> list[tuple[slice, slice]]:
    """Rows and columns of the connected parts of the live taxels, in the order of the rows.

    Raises
    ------
    RecordingError
        When one is not a rectangle of at least 3 x 3 taxels.
    """
    labels, count = ndimage.label(live)
    found = []
    for rows, cols in ndimage.find_objects(labels):
        shape = (rows.stop - rows.start, cols.stop - cols.start)
        if min(shape) < SMALLEST_SIDE or not live[rows, cols].all():
            raise RecordingError(
                f"live taxels in rows {rows.start} to {rows.stop - 1}, columns {cols.start} to {cols.stop - 1}: slip "
                f"is watched on whole rectangles of {SMALLEST_SIDE} x {SMALLEST_SIDE} taxels and more"
            )
        found.append((rows, cols))
    if not count:
        raise RecordingError("no taxel is live; give a file in which `live` says which are")
    return found


def watch(
    images: NDArray[np.float32], rate_hz: float, detector: SlipDetector, min_counts: float, patch: int = 0
) -> PatchResult:
    """Detect slip on one patch in one recording; `images` [shape=(n, rows, cols)] are its counts."""
    result = PatchResult(patch)
    sums = images.sum(axis=(1, 2))
    steady = _steady(sums, max(1, round(_STEADY_S * rate_hz)))
    rows, cols = np.indices(images.shape[1:])
    begin_s: float | None = None
    farthest = 0.0
    for k, image in enumerate(images):
        time_s = k / rate_hz
        slip = detector.step(time_s, image)
        # For some time after a slip, the report is held without further motion.
        told = slip.distance_taxels > 0.0
        if sums[k] >= min_counts:
            result.pressed += 1
            result.told += told
            result.steady += bool(steady[k])
            result.told_while_steady += told and bool(steady[k])
            row, col = float((rows * image).sum() / sums[k]), float((cols * image).sum() / sums[k])
            result.path.append((time_s, row, col, told))
        if slip.slipping and begin_s is None:
            begin_s, farthest = time_s, 0.0
        farthest = max(farthest, slip.distance_taxels)
        if begin_s is not None and not slip.slipping:
            result.events.append((begin_s, time_s, farthest))
            begin_s = None
    if begin_s is not None:
        result.events.append((begin_s, len(images) / rate_hz, farthest))
    return result


def _steady(sums: NDArray[np.float32], reach: int) -> NDArray[np.bool_]:
    """Mask of frames where the sum of counts changes little, from `reach` frames before to `reach` frames after."""
    size = 2 * reach + 1
    if len(sums) < size:
        return np.zeros(len(sums), dtype=bool)
    low, high = ndimage.minimum_filter1d(sums, size), ndimage.maximum_filter1d(sums, size)
    steady: NDArray[np.bool_] = (low >= (1.0 - _STEADY_SHARE) * high) & (high > 0)
    steady[:reach] = steady[len(sums) - reach :] = False
    return steady


def _run(arguments: argparse.Namespace) -> int:
    results = report.Results(arguments.json, {"frames": str(arguments.frames)}, reads=[arguments.frames])
    require_picture(arguments.picture, report=arguments.json, reads=[arguments.frames])
    config = part_of(SlipConfig, arguments)
    tell_if_large(arguments.frames)
    recorded = load_frames(arguments.frames, labels=True)
    rate_hz = arguments.rate_hz or recorded.rate_hz
    if rate_hz is None:
        raise RecordingError(f"{arguments.frames}: has no rate_hz; say how many frames a second with --rate-hz")
    if recorded.length.max() < 2:
        raise RecordingError(
            f"{arguments.frames}: each recording has a single frame; needed are at least two, because slip is motion "
            "from one to another"
        )
    boxes = patches(recorded.live)
    print(
        f"{counted(len(recorded.start), 'recording')}, {rate_hz:g} frames/s, {counted(len(boxes), 'patch', 'patches')}"
    )
    print("| recording | pressed frames of patches | slip told | steady | told while steady |\n|---|---|---|---|---|")
    watched: list[tuple[str, list[PatchResult]]] = []
    for number in range(len(recorded.start)):
        name = f"{number} {recorded.label[number]}" if recorded.label else str(number)
        found = _watch_all(recorded, number, boxes, rate_hz, config, arguments)
        watched.append((name, found))
        entry = _entry(name, found)
        # Written with the total: a recording takes less time than a file.
        results.entries.append(entry)
        if len(recorded.start) <= 20:
            print(_line(name, entry))
    total = _entry("all", [one for _, found in watched for one in found])
    results.add(total, _line("all", total))
    if arguments.picture:
        _draw(arguments.picture, watched)
    if not total["pressed"]:
        largest = max(int(recorded.frames[:, rows, cols].sum(axis=(1, 2)).max()) for rows, cols in boxes)
        raise RecordingError(
            f"{arguments.frames}: nothing could be watched, since no patch is pressed: the counts of one sum up to "
            f"{largest} at most; needed are ADC counts of 10 bits that reach {config.slip_min_counts:g} "
            "(--slip-min-counts)"
        )
    return 0


def _watch_all(
    recorded: FramesFile,
    number: int,
    boxes: list[tuple[slice, slice]],
    rate_hz: float,
    config: SlipConfig,
    arguments: argparse.Namespace,
) -> list[PatchResult]:
    start = int(recorded.start[number])
    frames = recorded.frames[start : start + int(recorded.length[number])]
    found = []
    for patch, (rows, cols) in enumerate(boxes):
        images = np.ascontiguousarray(frames[:, rows, cols], np.float32)
        _, high, wide = images.shape
        detector = SlipDetector(high, wide, arguments.pitch_m, config, arguments.noise_counts)
        found.append(watch(images, rate_hz, detector, config.slip_min_counts, patch))
    return found


def _entry(name: str, found: list[PatchResult]) -> dict[str, object]:
    counts = {
        key: sum(getattr(one, key) for one in found) for key in ("pressed", "told", "steady", "told_while_steady")
    }
    events = [
        {"patch": one.patch, "begin_s": begin, "end_s": end, "distance_taxels": far}
        for one in found
        for begin, end, far in one.events
    ]
    return {"recording": name, **counts, **({"events": events} if name != "all" else {})}


def _line(name: str, entry: dict[str, object]) -> str:
    return f"| {name} | " + " | ".join(str(entry[k]) for k in ("pressed", "told", "steady", "told_while_steady")) + " |"


def _draw(path: Path, watched: list[tuple[str, list[PatchResult]]]) -> None:
    """Draw the path of the centre of pressure over time of the recordings with most slip, which rings mark."""
    most = sorted(watched, key=lambda one: -sum(patch.told for patch in one[1]))[:5]
    with diagrams(path, len(most), 1, size_inch=(9, 2.2 * len(most)), dpi=110) as rows:
        for axes, (name, found) in zip(rows, most, strict=True):
            for patch in found:
                if not patch.path:
                    continue
                time_s, row, col, told = (np.array(values) for values in zip(*patch.path, strict=True))
                (line,) = axes.plot(time_s, row, ".", markersize=2, label=f"patch {patch.patch}: row")
                axes.plot(time_s, col, ".", markersize=2, color=line.get_color(), alpha=0.4)
                axes.plot(time_s[told], row[told], "o", markersize=4, markerfacecolor="none", color="black")
            axes.set_title(
                f"recording {name}: centre of pressure, rows (strong) and columns (pale); black rings: slip", fontsize=8
            )
            axes.set_ylabel("taxels")
            if axes.lines:
                axes.legend(fontsize=6, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        rows[-1].set_xlabel("time [s]")
