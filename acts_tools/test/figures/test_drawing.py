# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How figures are drawn: legends lie on no diagram, and colours do not repeat."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_tools.cli import main
from acts_tools.figures.board import frame_rates
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import OTHERS, OURS, PUBLISHED, SAME, Curve, Panel, Picture, large_images, rows


@pytest.fixture
def page() -> Iterator[Any]:
    """An empty figure of two places in a row."""
    # Imported here, because a file of tests imports nothing slow.
    from matplotlib import pyplot as plt

    figure, _ = plt.subplots(1, 2, figsize=(7, 3), layout="constrained")
    yield figure
    plt.close(figure)


def diagrams(page: Any, panels: list[Panel]) -> tuple[list[Any], list[Any]]:
    """Draw panels with their legends, and return where diagrams and legends are."""
    from acts_tools.figures.drawing.diagrams import draw_panel
    from acts_tools.figures.drawing.images import draw_scales
    from acts_tools.figures.drawing.legends import draw_legends
    from acts_tools.figures.drawing.over_time import scale_of
    from acts_tools.figures.drawing.style import Looks

    looks, places = Looks(panels), list(page.axes)
    for axes, panel in zip(places, panels, strict=True):
        draw_panel(axes, panel, looks, scale_of(panels))
    draw_scales(page, places, panels)
    draw_legends(page, places, panels, looks, None)
    page.canvas.draw()
    legends = [*page.legends, *(axes.get_legend() for axes in page.axes if axes.get_legend())]
    return [axes.get_window_extent() for axes in places], [legend.get_window_extent() for legend in legends]


@pytest.mark.parametrize(("colours", "expected"), [(("C0", "C0"), 1), (("C0", "C1"), 2)])
def test_legends_are_beside_the_diagrams(page: Any, colours: tuple[str, str], expected: int) -> None:
    panels = [
        Panel(f"panel {number}", curves=[Curve("a line with a long name", [0.0, 1.0], [0.0, 1.0], OURS, colour)])
        for number, colour in enumerate(colours)
    ]
    axes, legends = diagrams(page, panels)
    assert len(legends) == expected
    assert not any(one.overlaps(other) for one in axes for other in legends)
    assert all(axis.width > 150 for axis in axes)


@pytest.mark.parametrize("runs", [[1.0], [1.0, 2.0], [float(run) for run in range(1, 21)]])
def test_points_at_whole_numbers_have_whole_numbers_below_them(page: Any, runs: list[float]) -> None:
    panels = [Panel(title, curves=[Curve("runs", runs, runs, OURS, "C0", points=True)]) for title in "ab"]
    diagrams(page, panels)
    for axes in page.axes[:2]:
        ticks = axes.get_xticks()
        assert set(ticks) & set(runs)
        assert all(tick == round(tick) for tick in ticks)


@pytest.mark.parametrize("image_at", [0, 1])
def test_the_scale_of_an_image_is_beside_the_diagrams(page: Any, image_at: int) -> None:
    curve = Panel("a curve", curves=[Curve("a line with a long name", [0.0, 1.0], [0.0, 1.0], OURS, "C0")])
    panels = [curve]
    panels.insert(image_at, Panel("an image", picture=Picture([[1.0, 2.0], [3.0, 4.0]], unit="counts")))
    places = list(page.axes)
    axes, (legend,) = diagrams(page, panels)
    (scale,) = [one.get_tightbbox() for one in page.axes if one not in places and one.get_ylabel() == "counts"]
    assert not any(scale.overlaps(other) for other in [*axes, legend])
    assert not any(legend.overlaps(other) for other in axes)


def test_other_arrays_are_told_apart() -> None:
    from acts_tools.figures.drawing.style import Looks

    for figure in frame_rates.FIGURES[1:]:
        panels = figure.measure(Run(Path()))
        looks = Looks(panels)
        others = [curve for curve in panels[0].curves if curve.by == OTHERS]
        seen = {(looks.colour(curve, panels[0]), looks.line(curve)["marker"]) for curve in others}
        assert len({colour for colour, _ in seen}) == len({marker for _, marker in seen}) == len(others)
        assert looks.colour(Curve("ours", [], [], OURS, "tracking"), panels[0]) not in {colour for colour, _ in seen}


def test_a_scheme_that_was_added_has_a_colour_of_its_own(page: Any) -> None:
    from acts_tools.figures.drawing.style import Looks

    names = ("tracking", "adaptive", "spiral", "comb")
    panels = [Panel(one, curves=[Curve(name, [0.0, 1.0], [0.0, 1.0], OURS, name) for name in names]) for one in "ab"]
    diagrams(page, panels)
    looks = Looks(panels)
    assert len({looks.colour(curve, panels[0]) for curve in panels[0].curves}) == 4


def test_a_published_curve_has_the_colour_of_its_counterpart() -> None:
    from acts_tools.figures.drawing.style import Looks

    first, second = Curve("first", [0.0], [0.0], SAME), Curve("second", [0.0], [0.0], SAME)
    published = Curve("second, published", [0.0], [0.0], PUBLISHED, beside="second")
    panel = Panel("both", curves=[published, first, second])
    looks = Looks([panel])
    assert looks.colour(published, panel) == looks.colour(second, panel) != looks.colour(first, panel)


def test_a_large_image_is_written_apart(tmp_path: Path) -> None:
    assert main(["figures", "S5", "--out", str(tmp_path)]) == 0
    made = json.loads((tmp_path / "fig_s5.json").read_text())
    (title,) = [panel["title"] for panel in made["panels"]]
    with np.load(tmp_path / "fig_s5.npz") as file:
        assert str(file["command"]) == made["command"]
        np.testing.assert_allclose(file[title], made["panels"][0]["picture"]["values"], atol=1e-6)
    assert (tmp_path / "fig_s5.csv").stat().st_size < 1000
    small = Panel("small", picture=Picture([[1.0, 2.0]]))
    assert not large_images([small])
    assert len(rows([small])) == 2


@pytest.mark.slow
def test_published_matrices_stand_beside_ours(recording_path: Callable[[str], Path], tmp_path: Path) -> None:
    data = recording_path("paper/confusion_SRC.npz").parent
    words = ["figures", "S7-1", "6A", "--fast", "--out", str(tmp_path)]
    assert main([*words, "--paper-data", str(data)]) == 0
    made = {name: json.loads((tmp_path / f"fig_{name}.json").read_text())["panels"] for name in ("s7_1", "6a")}
    titles = [panel["title"] for panel in made["s7_1"]]
    assert titles[:6] == [f"{who}M = 64, {ms} ms" for who in ("published, ", "") for ms in (25, 50, 100)]
    assert [len(made["s7_1"][number]["picture"]["values"]) for number in (0, 3)] == [30, 6]
    np.testing.assert_allclose(np.sum(made["s7_1"][0]["picture"]["values"], axis=1), 1.0)
    flat, solid = (
        next(panel for panel in made["6a"] if panel["title"] == f"{kind}, M = 88, published")
        for kind in ("outlines", "surface")
    )
    # Four frames, each a closed line.
    assert [len(flat["curves"]), len(solid["curves"])] == [4, 4]
    assert all((curve["x"][0], curve["y"][0]) == (curve["x"][-1], curve["y"][-1]) for curve in solid["curves"])
    # Again without: nothing published stays.
    assert main(words) == 0
    again = json.loads((tmp_path / "fig_s7_1.json").read_text())["panels"]
    assert [panel["title"] for panel in again] == [title for title in titles if not title.startswith("published")]
