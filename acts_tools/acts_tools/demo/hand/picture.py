# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The picture of a run of the hand, with a column per act: two views, and force, motion and slip over time."""

from __future__ import annotations

import itertools
import textwrap
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.patches
import numpy as np
from numpy.typing import NDArray

from acts_control.hand.description import LEAP_RIGHT
from acts_core.errors import ActsError
from acts_core.skin import layout
from acts_msgs.msg import HandStatus
from acts_sim.hand import HandWorld, held_object
from acts_sim.hand.pictures import HandPicture, draw_hand
from acts_tools.demo.hand.act import Act, Moment
from acts_tools.hand_rigs.recording import column, patch_column
from acts_tools.output_file import save_picture

mpl.use("Agg")
from matplotlib import pyplot as plt

_COLUMN_IN, _HEIGHT_IN = 5.0, 14.0
_TITLE = "A simulated LEAP hand acts by touch: what its running processes felt and did"
_LETTERS_A_COLUMN = 40
_COLOURS = {"": "0.45", "index": "#1f77b4", "middle": "#2ca02c", "ring": "#d62728", "thumb": "#9467bd"}
_AXIS_COLOURS = {"x": "#8c564b", "y": "#e377c2", "z": "#17becf"}
_VIEWS = {"palm_up": "above", "thumb_up": "front"}
_PIXELS = (800, 640)
_DISTANCE_M = 0.46
_MARGIN_PIXELS = 12
_PUT = "put"
_PUT_SETTLED_S = 0.05
_AVOIDING = "#ff7f0e"
# Share of the width of a plot that the label of an event takes.
_LABEL_SHARE = 0.08
# Height of a row with nothing but a legend, for which the layout makes room: matplotlib before 3.7 knows no other
# place outside of the axes.
_LEGEND = 1e-3


def draw(acts: list[Act], path: Path) -> None:
    """Draw a run to a PNG file.

    Parameters
    ----------
    acts : list of Act
        At least one.
    path : Path
        Its folder is made.
    """
    figure = plt.figure(figsize=(_COLUMN_IN * len(acts), _HEIGHT_IN), layout="constrained")
    figure.suptitle(textwrap.fill(_TITLE, _LETTERS_A_COLUMN * len(acts)), fontsize=15)
    grid = figure.add_gridspec(6, len(acts), height_ratios=[1.6, 1.6, 1.0, 1.0, 1.0, _LEGEND])
    for k, act in enumerate(acts):
        begin_s, end_s = _span(act)
        for row, (moment, words) in enumerate(_moments(act)):
            head = f"{act.title}\n" if row == 0 else ""
            _show(figure, grid[row, k], act, moment, f"{head}{words}, at {moment.time_s - act.begin_s:.1f} s")
        axes = [figure.add_subplot(grid[2, k])]
        axes += [figure.add_subplot(grid[row, k], sharex=axes[0]) for row in (3, 4)]
        _draw_forces(axes[0], act, begin_s, end_s)
        _draw_motion(axes[1], act, begin_s, end_s)
        _draw_slip(axes[2], act, begin_s, end_s)
        axes[0].set_xlim(begin_s - act.begin_s, end_s - act.begin_s)
        for one in axes:
            _mark(one, act, begin_s, end_s)
            one.grid(alpha=0.25)
        _name_marks(axes[0], act, begin_s, end_s)
        axes[2].set_xlabel("time since the grasp began [s]")
        if k == 0:
            _legend(figure.add_subplot(grid[5, :]), axes, 3 * len(acts))
    save_picture(figure, path, dpi=100)
    plt.close(figure)


def _legend(below: Any, axes: list[Any], columns: int) -> None:
    """Name the fingers of force and slip, and the axes of the motion."""
    handles = [handle for one in axes[:2] for handle in one.get_legend_handles_labels()[0]]
    handles.append(mpl.patches.Patch(color=_AVOIDING, alpha=0.2, label="the hand avoids a tip"))
    below.axis("off")
    below.legend(handles=handles, loc="center", ncol=columns, fontsize=10)


def _span(act: Act) -> tuple[float, float]:
    times_s, _ = act.recording.truth_between(act.begin_s)
    return act.begin_s, float(times_s[-1]) if len(times_s) else act.begin_s + 1.0


def _moments(act: Act) -> list[tuple[Moment, str]]:
    """Two moments to show: at the last mark, and at the end."""
    _, end_s = _span(act)
    last_s, last = act.recording.marks[-1] if act.recording.marks else (act.begin_s, "")
    at_last = (last_s + 0.3, f"after “{last}”") if last == _PUT else (last_s - 0.05, f"before “{last}”")
    wanted = [at_last, (end_s - 0.1, "in the end")]
    found = [(act.moment(time_s), words) for time_s, words in wanted]
    return [(moment, words) for moment, words in found if moment is not None]


def _show(figure: Any, place: Any, act: Act, moment: Moment, title: str) -> None:
    """Show a moment: rendered where that is possible, else drawn."""
    try:
        picture = _rendered(act, moment)
    except ActsError:
        axes = figure.add_subplot(place, projection="3d")
        world = act.world
        thing = None if world.object == "none" else held_object(world.object, world.object_size_m, world.object_mass_kg)
        draw_hand(axes, moment.truth, layout(world.layout), thing, moment.counts)
    else:
        axes = figure.add_subplot(place)
        axes.imshow(_trimmed(picture))
        axes.set_axis_off()
    axes.set_title(title, fontsize=11)


def _rendered(act: Act, moment: Moment) -> Any:
    world = HandWorld(act.world)
    world.show(moment.truth)
    picture = HandPicture(world, *_PIXELS)
    try:
        return picture.take(_VIEWS.get(act.world.pose, "above"), moment.counts, _DISTANCE_M)
    finally:
        picture.close()


def _trimmed(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The picture without its margins of background."""
    there = (picture != picture[0, 0]).any(axis=2)
    rows, cols = np.flatnonzero(there.any(axis=1)), np.flatnonzero(there.any(axis=0))
    if not len(rows):
        return picture
    low_row, low_col = max(rows[0] - _MARGIN_PIXELS, 0), max(cols[0] - _MARGIN_PIXELS, 0)
    return picture[low_row : rows[-1] + _MARGIN_PIXELS, low_col : cols[-1] + _MARGIN_PIXELS]


def _draw_forces(axes: Any, act: Act, begin_s: float, end_s: float) -> None:
    times_s, rows = act.recording.truth_between(begin_s, end_s)
    forces = patch_column(rows, "force_n")
    for finger, colour in _COLOURS.items():
        of_it = [LEAP_RIGHT.regions[patch].finger == finger for patch in act.recording.patches]
        axes.plot(times_s - act.begin_s, forces[:, of_it].sum(axis=1), color=colour, lw=1.3, label=finger or "palm")
    axes.set(ylabel="force on the skin [N]")


def _draw_motion(axes: Any, act: Act, begin_s: float, end_s: float) -> None:
    # The object was elsewhere before it was put into the hand.
    put_s = max((time_s + _PUT_SETTLED_S for time_s, words in act.recording.marks if words == _PUT), default=begin_s)
    times_s, rows = act.recording.truth_between(put_s, end_s)
    if not len(rows):
        return
    moved_mm = 1e3 * (column(rows, "object_position_m") - column(rows, "object_position_m")[0])
    for k, (axis, colour) in enumerate(_AXIS_COLOURS.items()):
        axes.plot(times_s - act.begin_s, moved_mm[:, k], color=colour, lw=1.3, label=f"{axis} of the palm")
    axes.set(ylabel="object moved [mm]")


def _draw_slip(axes: Any, act: Act, begin_s: float, end_s: float) -> None:
    """Draw the largest slip of each finger's regions, as computed from the skin."""
    inside = [(time_s, regions) for time_s, regions in act.recording.regions if begin_s <= time_s <= end_s]
    times_s = np.array([time_s for time_s, _ in inside]) - act.begin_s
    for finger, colour in _COLOURS.items():
        of_it = [
            [one.slip_m for one in regions if LEAP_RIGHT.regions[one.name].finger == finger] for _, regions in inside
        ]
        axes.plot(times_s, [1e3 * max(slips, default=0.0) for slips in of_it], color=colour, lw=1.3)
    axes.set(ylabel="slip felt [mm]")


def _mark(axes: Any, act: Act, begin_s: float, end_s: float) -> None:
    """Draw lines at commanded events, and bars while the hand avoided a tip."""
    for time_s, _ in act.recording.marks:
        if begin_s <= time_s <= end_s:
            axes.axvline(time_s - act.begin_s, color="0.3", lw=0.8, ls="--")
    statuses = act.recording.statuses
    for one, after in itertools.pairwise(statuses):
        if one.state == HandStatus.STATE_AVOIDING and begin_s <= one.time_s <= end_s:
            axes.axvspan(one.time_s - act.begin_s, after.time_s - act.begin_s, color=_AVOIDING, alpha=0.2, lw=0)


def _name_marks(axes: Any, act: Act, begin_s: float, end_s: float) -> None:
    """Name commanded events above their lines; those too near to each other in one label, at the first."""
    labels: list[tuple[float, str]] = []
    for time_s, words in act.recording.marks:
        if not begin_s <= time_s <= end_s:
            continue
        if labels and time_s - labels[-1][0] < _LABEL_SHARE * (end_s - begin_s):
            labels[-1] = (labels[-1][0], f"{labels[-1][1]}, {words}")
        else:
            labels.append((time_s, words))
    for time_s, words in labels:
        axes.annotate(
            words,
            (time_s - act.begin_s, 1.02),
            xycoords=("data", "axes fraction"),
            fontsize=9,
            rotation=25,
            ha="left",
            va="bottom",
        )
