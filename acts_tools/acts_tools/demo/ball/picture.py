# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The picture of a ball-balancing run: path against reference, cumulative pressure, tilt (compare paper, Fig. 10)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

from acts_core.array import ArrayGeometry
from acts_tools.demo.ball.recording import Recording
from acts_tools.demo.ball.score import LETTERS
from acts_tools.output_file import save_picture

mpl.use("Agg")
from matplotlib import pyplot as plt

_REFERENCE = "#d62728"
_PATH = "#1f77b4"
_TILTS = 4
# Height of a row with nothing but a legend, for which the layout makes room: matplotlib before 3.7 knows no other
# place outside of the axes.
_LEGEND = 1e-3


def draw(recording: Recording, results: dict[str, Any], geometry: ArrayGeometry, path: Path) -> None:
    """Draw a run to a PNG file."""
    names = [name for name in ("hold", *LETTERS) if name in recording.segments]
    figure = plt.figure(figsize=(3.6 * max(len(names), 3), 9.6), layout="constrained")
    grid = figure.add_gridspec(4, max(len(names), 3), height_ratios=[1, 1, 0.6, _LEGEND])
    latency = results["latency_ms"]
    if latency["median"] is None:
        timing = "no contact received"
    else:
        timing = f"latency {latency['median']:.2f} ms median, {latency['p99']:.2f} ms p99"
    figure.suptitle(
        f"Ball balancing by touch only: {results['contact_rate_hz']:.0f} tactile frames/s, "
        f"{results['frames_lost']} lost, {timing}",
        fontsize=13,
    )
    half_mm = geometry.cols * geometry.pitch_m * 500
    for column, name in enumerate(names):
        _draw_path(figure.add_subplot(grid[0, column]), recording, results, name, half_mm)
        _draw_pressure(figure.add_subplot(grid[1, column]), recording, name, half_mm)
    tilt = figure.add_subplot(grid[2, :])
    _draw_tilt(tilt, recording)
    if recording.tilt_time_s:
        # Below the curves and not over them.
        below = figure.add_subplot(grid[3, :])
        below.axis("off")
        below.legend(handles=tilt.get_lines()[:_TILTS], loc="center", ncol=_TILTS, fontsize=9)
    save_picture(figure, path, dpi=110)
    plt.close(figure)


def _draw_path(axes: Any, recording: Recording, results: dict[str, Any], name: str, half_mm: float) -> None:
    chosen = np.array([segment == name for segment in recording.segments])
    time_s = np.array(recording.reference.time_s)[chosen]
    reference_mm = np.column_stack([recording.reference.x_m, recording.reference.y_m])[chosen] * 1000
    truth_time_s = np.array(recording.truth.time_s)
    inside = (truth_time_s >= time_s[0]) & (truth_time_s <= time_s[-1])
    truth_mm = np.column_stack([recording.truth.x_m, recording.truth.y_m])[inside] * 1000
    axes.plot(reference_mm[:, 0], reference_mm[:, 1], color=_REFERENCE, lw=3, alpha=0.5, label="reference")
    if name == "hold":
        axes.plot(reference_mm[:1, 0], reference_mm[:1, 1], "+", color=_REFERENCE, ms=14, mew=2)
    axes.plot(truth_mm[:, 0], truth_mm[:, 1], color=_PATH, lw=1.2, label="ball")
    error = results["rms_mm"].get(name)
    title = name if error is None else f"{name}: {error:.2f} mm rms"
    axes.set_title(title + (" after 2 s" if name == "hold" and error is not None else ""))
    axes.set(xlim=(-half_mm, half_mm), ylim=(-half_mm, half_mm), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    axes.legend(loc="lower right", fontsize=8)


def _draw_pressure(axes: Any, recording: Recording, name: str, half_mm: float) -> None:
    pressure = recording.segment_pressure.get(name)
    axes.set(xlim=(-half_mm, half_mm), ylim=(-half_mm, half_mm), aspect="equal", xlabel="x [mm]", ylabel="y [mm]")
    axes.set_title("cumulative pressure" if pressure is not None else "no images received")
    if pressure is not None:
        axes.imshow(pressure, extent=(-half_mm, half_mm, -half_mm, half_mm), cmap="inferno", origin="upper")


def _draw_tilt(axes: Any, recording: Recording) -> None:
    if recording.tilt_time_s:
        time_s = np.array(recording.tilt_time_s) - recording.tilt_time_s[0]
        commanded = np.degrees(np.array(recording.tilt_commanded_rad))
        measured = np.degrees(np.array(recording.tilt_measured_rad))
        for axis, colour in (("x", "#2ca02c"), ("y", "#9467bd")):
            index = "xy".index(axis)
            axes.plot(time_s, commanded[:, index], color=colour, lw=0.8, alpha=0.6, label=f"commanded about {axis}")
            axes.plot(time_s, measured[:, index], color=colour, lw=1.4, label=f"measured about {axis}")
        axes.set_xlim(time_s[0], time_s[-1])
        start_s = recording.tilt_time_s[0]
        _mark_segments(axes, recording, start_s)
    axes.set(xlabel="time [s]", ylabel="tilt [deg]", title="tilt of the plate")


def _mark_segments(axes: Any, recording: Recording, start_s: float) -> None:
    before = ""
    for time_s, name in zip(recording.reference.time_s, recording.segments, strict=True):
        if name != before and name != "move":
            axes.axvline(time_s - start_s, color="0.7", lw=0.8)
            place = {"xycoords": ("data", "axes fraction"), "xytext": (4, 5), "textcoords": "offset points"}
            axes.annotate(name, (time_s - start_s, 0.0), fontsize=9, **place)
        before = name
