# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The picture of a self-test: noise, baseline and response of every taxel, with faults marked."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

from acts_driver.selftest import Finding, Level, listed
from acts_tools.output_file import save_picture
from acts_tools.selftest.result import SelfTest

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.patches import Rectangle

_FAULT = "#00c8ff"
_COLOURS = {Level.PASS: "#2ca02c", Level.WARN: "#e08a00", Level.FAIL: "#d62728"}
_ROWS_COLOUR, _COLS_COLOUR = "#1f77b4", "#9467bd"
_LINE_CHARACTERS = 56


def draw(test: SelfTest, path: Path) -> None:
    """Draw a self-test to a file.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    figure = plt.figure(figsize=(15, 9.2), layout="constrained")
    grid = figure.add_gridspec(2, 3, height_ratios=[1.25, 1], width_ratios=[1, 1, 1.3])
    figure.suptitle(f"Self-test of {test.board}: {test.verdict}", fontsize=14, color=_COLOURS[test.level])
    noise = test.skin.noise_counts
    _draw_map(figure, grid[0, 0], noise, "noise [counts]", max(float(np.nanmax(noise)), 2.0), "viridis", test, "noise")
    baseline = test.skin.baseline_counts
    top = max(float(np.nanmax(baseline)), 10.0)
    _draw_map(figure, grid[0, 1], baseline, "baseline, untouched [counts]", top, "magma", test, "stuck", "high")
    if test.touch is None:
        axes = figure.add_subplot(grid[0, 2])
        axes.set_axis_off()
        axes.text(0.5, 0.5, "not touched", ha="center", va="center", fontsize=14, color="0.5")
    else:
        response = test.touch.response_counts
        top = max(float(response.max()), 10.0)
        _draw_map(figure, grid[0, 2], response, "response to touch [counts]", top, "inferno", test, "")
    _draw_lines(figure.add_subplot(grid[1, 0]), test)
    _draw_delay(figure.add_subplot(grid[1, 1]), test)
    _draw_findings(figure.add_subplot(grid[1, 2]), test.findings)
    save_picture(figure, path, dpi=100)
    plt.close(figure)


def _draw_map(
    figure: Any,
    place: Any,
    values: NDArray[np.float64],
    title: str,
    top: float,
    colours: str,
    test: SelfTest,
    *names: str,
) -> None:
    axes = figure.add_subplot(place)
    colour_map = mpl.colormaps[colours].with_extremes(bad="0.6")
    image = axes.imshow(np.ma.masked_invalid(values), cmap=colour_map, vmin=0, vmax=top)
    figure.colorbar(image, ax=axes, shrink=0.85, pad=0.09)
    axes.set(xlabel="column", ylabel="row")
    axes.set_title(title, pad=20)
    for finding in test.findings:
        if finding.level is Level.PASS or not any(name in finding.name for name in names):
            continue
        for row, col in finding.taxels:
            axes.add_patch(Rectangle((col - 0.8, row - 0.8), 1.6, 1.6, fill=False, ec=_FAULT, lw=1.6))
        colour = _COLOURS[finding.level]
        for first, last in _runs(finding.rows):
            height = last - first + 1
            axes.add_patch(Rectangle((-0.5, first - 0.5), test.cols, height, fill=False, ec=_FAULT, lw=1.6))
            place = (test.cols - 0.2, (first + last) / 2)
            axes.annotate(_label(first, last), place, color=colour, va="center", annotation_clip=False)
        for first, last in _runs(finding.cols):
            axes.add_patch(Rectangle((first - 0.5, -0.5), last - first + 1, test.rows, fill=False, ec=_FAULT, lw=1.6))
            place = ((first + last) / 2, -0.8)
            axes.annotate(_label(first, last), place, color=colour, ha="center", annotation_clip=False)


def _runs(lines: tuple[int, ...]) -> list[tuple[int, int]]:
    """First and last line of each group of neighbouring lines."""
    runs: list[tuple[int, int]] = []
    for line in lines:
        if runs and runs[-1][1] == line - 1:
            runs[-1] = (runs[-1][0], line)
        else:
            runs.append((line, line))
    return runs


def _label(first: int, last: int) -> str:
    return listed(tuple(range(first, last + 1)))


def _draw_lines(axes: Any, test: SelfTest) -> None:
    if test.touch is None:
        axes.set_axis_off()
        return
    response = test.touch.response_counts
    for label, values, colour, lines in (
        ("rows", np.median(response, axis=1), _ROWS_COLOUR, _marked(test, "rows")),
        ("columns", np.median(response, axis=0), _COLS_COLOUR, _marked(test, "cols")),
    ):
        axes.plot(values, ".-", color=colour, label=label)
        faulty = sorted(lines)
        axes.plot(faulty, values[faulty], "o", mfc="none", mec=_COLOURS[Level.FAIL], ms=11, mew=1.8, clip_on=False)
    axes.set(title="median response of each line [counts]", xlabel="row or column")
    axes.set_ylim(bottom=0)
    axes.legend(loc="lower right", fontsize=9)


def _marked(test: SelfTest, field: str) -> set[int]:
    return {line for finding in test.findings if finding.level is Level.FAIL for line in getattr(finding, field)}


def _draw_delay(axes: Any, test: SelfTest) -> None:
    timing = test.timing
    late_us = timing.late_us
    axes.set(
        title=f"{timing.rate_hz:.1f} frames/s, {timing.lost} lost", xlabel="frame", ylabel="delay to the host [us]"
    )
    if len(late_us):
        axes.plot(late_us, ".", ms=2.5, color=_ROWS_COLOUR)
        axes.set_ylim(0, max(1.05 * float(np.percentile(late_us, 99.5)), 10.0))
        axes.set_xlim(0, len(late_us))
    else:
        axes.text(0.5, 0.5, "the board has no clock", ha="center", va="center", transform=axes.transAxes)


def _draw_findings(axes: Any, findings: list[Finding]) -> None:
    axes.set_axis_off()
    y = 1.0
    for finding in sorted(findings, key=lambda finding: -finding.level):
        text = f"{finding.name}: {finding.text}"
        if len(text) > _LINE_CHARACTERS:
            text = text[: _LINE_CHARACTERS - 1] + "…"
        level = axes.text(
            0.0, y, finding.level.name, color=_COLOURS[finding.level], weight="bold", fontsize=9, va="top"
        )
        words = axes.text(0.16, y, text, fontsize=9, va="top")
        # Texts wider than their axes must not shrink the other axes.
        level.set_in_layout(False)
        words.set_in_layout(False)
        y -= 0.068
