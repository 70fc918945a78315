# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Outlines over time as a picture and as a file of a 3D model."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from acts_recon.outlines import Outline, surface_of, write_ply
from acts_tools.output_file import save_picture
from acts_tools.progress import tell


def write_surfaces(folder: Path, name: str, outlines: Sequence[Outline]) -> None:
    """Write the contact that was told most often as ``NAME.ply`` and ``NAME.png``; say where it has no surface.

    Raises
    ------
    RecordingError
        When the files cannot be written.
    """
    numbers = [outline.number for outline in outlines]
    most = max(set(numbers), key=numbers.count, default=None)
    mine = [outline for outline in outlines if outline.number == most]
    if len(mine) < 2:
        tell(f"{folder / name}: no surface, which takes outlines of two frames or more")
        return
    picture, model = folder / f"{name}.png", folder / f"{name}.ply"
    draw_surface(mine, picture)
    tell(str(picture))
    write_ply(surface_of(mine), model)
    tell(str(model))


def draw_surface(outlines: Sequence[Outline], path: Path) -> None:
    """Draw the outlines of one contact above each other, time upwards [mm, ms]."""
    # Half a second, of which other commands have no use.
    import matplotlib as mpl
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(5, 5), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot(projection="3d")
    last_s = outlines[-1].time_s - outlines[0].time_s
    surface = surface_of(outlines, 1.0)
    x, y, z = 1e3 * surface.points_m.T
    axes.plot_trisurf(x, y, z, triangles=surface.triangles, cmap="viridis", alpha=0.35, linewidth=0)
    for outline in outlines:
        after_s = outline.time_s - outlines[0].time_s
        colour = mpl.colormaps["viridis"](after_s / last_s)
        x_mm, y_mm = 1e3 * outline.x_m, 1e3 * outline.y_m
        axes.plot([*x_mm, x_mm[0]], [*y_mm, y_mm[0]], 1e3 * after_s, color=colour)
    # More labels than these would lie on one another.
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(4))
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.set_zlabel("time [ms]")
    # The label of z is cut off otherwise.
    axes.set_box_aspect(None, zoom=0.85)
    save_picture(figure, path, dpi=120)
