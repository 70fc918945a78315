# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Tables and the picture of `acts evaluate classification`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from acts_tools.evaluate.picture import diagrams

PUBLISHED_OVER_M = {42: 0.756, 48: 0.849, 56: 0.901, 64: 0.934, 88: 0.991, 128: 0.997, 256: 0.997, 512: 0.992}
"""Accuracy of SRC with adaptive sampling over M (paper, Fig. 4F)."""

PUBLISHED_AT_20_MS = 0.886
"""Accuracy 20 ms after first contact, M = 64 (paper, Fig. 4G); a running mean over the frames since contact."""

_COLOURS = {"paper": "tab:blue", "acts": "tab:red"}
_NAMES = {"paper": "adaptive, SRC a frame", "acts": "tracking, fused image"}


def table(results: dict[str, list[dict[str, Any]]], question: str, heading: str) -> str:
    """One row per question, one column per method: accuracy and its 95 % interval."""
    methods = list(results)
    lines = [f"| {heading} | " + " | ".join(methods) + " |", "|---" * (len(methods) + 1) + "|"]
    for row in zip(*results.values(), strict=True):
        cells = (f"{cell['accuracy']:.3f} ({cell['low']:.3f} to {cell['high']:.3f})" for cell in row)
        lines.append(f"| {row[0][question]:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def times(frame_us: dict[str, dict[str, float] | None]) -> str:
    """One line with the time of each method for a frame."""
    taken = (f"{method} {us['median']:.0f}, {us['p99']:.0f}" for method, us in frame_us.items() if us)
    return f"processor time to classify a frame, median and p99 [us]: {'; '.join(taken)}"


def draw(path: Path, results: dict[str, Any], m_over_time: int) -> None:
    """Draw accuracy over M and over time since contact, with their intervals, to a PNG file.

    Raises
    ------
    RecordingError
        When it cannot be written.
    """
    with diagrams(path, 1, 2, size_inch=(10, 4.2), dpi=100) as (left, right):
        for axes, curves, question in ((left, results["over_m"], "m"), (right, results["over_time"], "time_ms")):
            for method, cells in curves.items():
                x = [cell[question] for cell in cells]
                colour = _COLOURS.get(method, "tab:green")
                axes.plot(
                    x, [cell["accuracy"] for cell in cells], "o-", ms=3, color=colour, label=_NAMES.get(method, method)
                )
                axes.fill_between(
                    x, [cell["low"] for cell in cells], [cell["high"] for cell in cells], color=colour, alpha=0.15
                )
            axes.set(ylabel="accuracy", ylim=(0, 1.02))
            axes.grid(alpha=0.3)
        ms = [m for m in PUBLISHED_OVER_M if any(cell["m"] == m for cell in results["over_m"]["paper"])]
        if ms:
            # Of a line through a single point nothing would be seen.
            look = "k:" if len(ms) > 1 else "k."
            left.plot(ms, [PUBLISHED_OVER_M[m] for m in ms], look, ms=3, lw=1, label="published (Fig. 4F)")
        cells = [cell for curve in results["over_m"].values() for cell in curve]
        shown = sorted({cell["m"] for cell in cells})
        left.set_xscale("log", base=2)
        left.set_xticks(shown, [str(m) for m in shown], fontsize=7)
        least = 0.6 if all(cell["accuracy"] >= 0.6 for cell in cells) else 0.0
        left.set(xlabel="taxels measured per frame, M", title="pressed and held", ylim=(least, 1.01))
        right.plot([20], [PUBLISHED_AT_20_MS], "k*", label="published, mean since contact (Fig. 4G)")
        right.set(xlabel="time since contact [ms]", title=f"M = {m_over_time}")
        left.legend(fontsize=8, loc="lower right")
        right.legend(fontsize=8, loc="lower right")
