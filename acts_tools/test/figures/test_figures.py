# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts figures --fast`: every figure is made, of finite numbers, and says by which command."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from acts_core.errors import SettingsError
from acts_tools.cli import main
from acts_tools.figures.differences import differences
from acts_tools.figures.figure import Figure
from acts_tools.figures.files import write_stamped
from acts_tools.figures.registry import FIGURES, figures_named
from acts_tools.figures.run import Run
from acts_tools.figures.sheet import PUBLISHED, SAME, Contours, Curve, Panel, Picture, from_json, to_json

PNG = b"\x89PNG\r\n\x1a\n"


def numbers(value: Any) -> Iterator[float]:
    """All numbers in plain data."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for one in value:
            yield from numbers(one)
    elif isinstance(value, int | float):
        yield float(value)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One for all figures, because some share measurements."""
    return tmp_path_factory.mktemp("figures")


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_is_made_of_finite_numbers(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ACTS_PAPER_DATA", raising=False)
    assert main(["figures", name, "--fast", "--out", str(folder)]) == 0
    path = folder / f"{FIGURES[name].file_name}.json"
    made = json.loads(path.read_text())
    assert made["command"] == f"acts figures {name} --seed 1 --fast"
    assert (made["seed"], made["fast"], made["published"]) == (1, True, False)
    assert made["panels"]
    # What is kept is enough to draw it again.
    assert to_json(from_json(made["panels"])) == made["panels"]
    for panel in made["panels"]:
        values = list(numbers([panel.get("curves", []), panel.get("picture", {}), panel.get("contours", {})]))
        assert values, panel["title"]
        assert all(map(math.isfinite, values)), panel["title"]
    assert path.with_suffix(".png").read_bytes().startswith(PNG)
    first, header, *rows = path.with_suffix(".csv").read_text().splitlines()
    assert first == f"# {made['command']}"
    assert header == "panel,curve,by,x,y,low,high"
    assert rows


def test_the_published_curves_are_drawn_where_they_are_given(
    recording_path: Callable[[str], Path], tmp_path: Path
) -> None:
    data = recording_path("paper/curves.csv").parent
    words = ["figures", "4D", "S9", "--out", str(tmp_path), "--json", str(tmp_path / "all.json")]
    assert main([*words, "--paper-data", str(data)]) == 0
    rates, force = json.loads((tmp_path / "all.json").read_text())["results"]
    assert rates["published"]
    assert {line["curve"]: line["mean_relative"] < 0.01 for line in rates["differences"]} == dict.fromkeys(
        ["uniform, board's model", "random, board's model", "adaptive, board's model", "raster, board's model"], True
    )
    assert force["differences"][0]["mean_absolute"] < 50
    # Again without: what was measured stays, what was published goes.
    assert main(words) == 0
    again = json.loads((tmp_path / "fig_s9.json").read_text())
    assert not again["published"]
    assert [curve["by"] for curve in again["panels"][0]["curves"]] == ["ours"]


def test_a_figure_is_not_measured_again(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["figures", "4D", "--out", str(tmp_path)]
    told = []
    for more in ([], [], ["--seed", "2"], ["--fast"], ["--fast", "--again"]):
        assert main([*words, *more]) == 0
        told.append("as measured before" in capsys.readouterr().out)
    assert told == [False, True, False, False, False]


@pytest.mark.parametrize("panels", [[], [{"title": "no curves", "picture": {"values": []}}], "none", None])
def test_a_figure_whose_file_was_changed_is_made_anew(
    panels: object, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words, path = ["figures", "4D", "--out", str(tmp_path)], tmp_path / "fig_4d.json"
    assert main(words) == 0
    made = path.read_text()
    path.write_text(json.dumps({**json.loads(made), "panels": panels}))
    capsys.readouterr()
    assert main(words) == 0
    told = capsys.readouterr()
    assert "measured in" in told.out
    assert f"{path}: was changed since it was written, and is made anew" in told.err
    assert path.read_text() == made


def test_rough_numbers_do_not_replace_good_ones(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for more in ([], ["--fast"]):
        assert main(["figures", "4D", *more]) == 0
    made = {path.parent.name: json.loads(path.read_text())["fast"] for path in tmp_path.glob("*/fig_4d.json")}
    assert made == {"figures": False, "figures_fast": True}


@pytest.mark.parametrize(
    ("name", "fast", "how"),
    [
        ("4F", False, "360 presses of 30 simulated objects, as in docs/recovery.md."),
        ("4G", True, "6 presses of 6 simulated objects, as in docs/recovery.md."),
        ("5G", False, "25 throws of each angle and speed (1, 2, 3 m/s), M = 64."),
        ("5G", True, "1 throw of each angle and speed (2 m/s), M = 64."),
        (
            "S3-1",
            False,
            "10 new objects; the dictionary is learnt from 14,907 patches of 3000 presses of the 20 others.",
        ),
        ("S3-1", True, "3 new objects; the dictionary is learnt from 200 patches of 40 presses of the 20 others."),
    ],
)
def test_the_notes_tell_how_much_was_measured(name: str, fast: bool, how: str, tmp_path: Path) -> None:
    figure = FIGURES[name]
    assert figure.notes_of(Run(tmp_path, fast=fast)) == [how, *figure.notes]


def test_what_is_told_to_be_measured_is_what_is_drawn(folder: Path) -> None:
    assert main(["figures", "5G", "--fast", "--out", str(folder)]) == 0
    made = json.loads((folder / "fig_5g.json").read_text())
    assert made["notes"][0] == "1 throw of each angle and speed (2 m/s), M = 64."
    ours = next(curve for curve in made["panels"][0]["curves"] if curve["label"] == "ours")
    assert len(ours["x"]) == 8


def test_panels_are_the_same_when_they_are_read_again() -> None:
    panels = [
        Panel("empty words and zeros", curves=[Curve("", [1.0], [0.0]), Curve("none", [], [])], y_min=0.0, y_max=0.0),
        Panel("upside down", picture=Picture([[0.0]], bottom=0.0, top=32.0, lowest=0.0)),
        Panel("lines", contours=Contours([], [], [], [0.0]), equal=True),
    ]
    assert from_json(json.loads(json.dumps(to_json(panels)))) == panels


def test_lines_of_two_points_are_compared_at_both_ends_of_what_they_share() -> None:
    ours = Curve("line", [2.0, 12.0], [0.2, 1.2], by=SAME)
    panel = Panel("sizes", curves=[ours, Curve("published", [0.0, 10.0], [0.5, 1.5], by=PUBLISHED, beside="line")])
    (found,) = differences([panel])
    # 0.7 and 1.5 are published at 2 and 10, where ours is 0.2 and 1.0.
    assert (found["points"], found["mean"]) == (2, pytest.approx(-0.5))
    assert found["largest_relative"] == pytest.approx(0.5 / 0.7)


def test_how_to_continue_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["figures", "--help"])
    assert "after Ctrl-C, continue without it" in " ".join(capsys.readouterr().out.split())


def test_figures_of_one_number_have_a_name_together() -> None:
    words = {"6A-C": ["6A", "6B", "6C"], "5f-g": ["5F", "5G"], "8B-G": ["8B-G"], "S7-1": ["S7-1"]}
    assert {word: [figure.name for figure in figures_named([word])] for word in words} == words
    assert len(figures_named([])) == len(FIGURES)
    for word in ("6A-Z", "6C-A", "7-8"):
        with pytest.raises(SettingsError, match="allowed are 4D"):
            figures_named([word])


def test_a_folder_of_nobody_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ACTS_PAPER_DATA", "~no_such_person/data")
    assert main(["figures", "S9", "--out", str(tmp_path)]) == 1
    assert capsys.readouterr().err.startswith("error: ~no_such_person/data: Could not determine home directory")


@pytest.mark.parametrize("name", ["fig_4e.json", "fig_4e.csv", "fig_4e.png", "shared/support.json"])
def test_the_json_file_of_all_figures_is_not_that_of_one(
    name: str, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = folder / name
    words = ["figures", "4E", "--fast", "--out", str(folder)]
    assert main(words) == 0
    before = path.read_bytes()
    monkeypatch.chdir(folder)
    assert main([*words, "--json", name]) == 1
    told = f"--json {name}: is where a figure keeps its own numbers or picture; give another name"
    assert told in capsys.readouterr().err
    assert path.read_bytes() == before
    assert main(words) == 0


def test_a_figure_that_is_named_twice_is_drawn_once() -> None:
    assert [figure.name for figure in figures_named(["6b", "6A-C", "6B"])] == ["6B", "6A", "6C"]


def test_unknown_figures_and_folders_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["figures", "3Z", "--out", str(tmp_path)]) == 1
    assert "allowed are 4D" in capsys.readouterr().err
    assert main(["figures", "4D", "--out", str(tmp_path), "--paper-data", str(tmp_path / "none")]) == 1
    assert "docs/paper.md" in capsys.readouterr().err
    (tmp_path / "file").touch()
    assert main(["figures", "4D", "--out", str(tmp_path / "file")]) == 1
    assert "--out" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("curves", "error"),
    [
        ("curve_id,x,y\n1,2,3\n1,2", "curves.csv: line 3 is damaged or lacks a column; docs/paper.md says"),
        ("curve,x,y\n1,2,3\n", "curves.csv: line 2 is damaged or lacks a column; docs/paper.md says"),
        (None, "curves.csv: no published curves (No such file or directory); needed are curves_index.csv"),
    ],
)
def test_damaged_curves_are_refused_by_file_and_line(
    curves: str | None, error: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "curves_index.csv").write_text("curve_id,figure,axes,label\n1,a,0,x\n")
    if curves is not None:
        (tmp_path / "curves.csv").write_text(curves)
    assert main(["figures", "4D", "--out", str(tmp_path / "out"), "--paper-data", str(tmp_path)]) == 1
    assert error in capsys.readouterr().err


def test_published_curves_are_not_replaced_by_the_numbers_of_figures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "curves_index.csv").write_text("curve_id,figure,axes,label\n1,a,0,x\n")
    path = tmp_path / "curves.csv"
    path.write_text("curve_id,x,y\n1,0,0\n")
    words = ["figures", "4D", "--out", str(tmp_path / "out"), "--paper-data", str(tmp_path)]
    assert main([*words, "--json", str(path)]) == 1
    assert f"{path}: is read, and would be lost" in capsys.readouterr().err
    assert path.read_text() == "curve_id,x,y\n1,0,0\n"


def test_a_published_curve_without_points_is_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # As where the end of curves.csv is missing.
    index = "curve_id,figure,axes,label\n1,figS_forceResponse/forceR.fig,0,\n"
    (tmp_path / "curves_index.csv").write_text(index)
    (tmp_path / "curves.csv").write_text("curve_id,x,y\n2,0,0\n")
    assert main(["figures", "S9", "--out", str(tmp_path / "out"), "--paper-data", str(tmp_path)]) == 1
    assert "curves.csv: no points of curve 1, '' of figS_forceResponse/forceR.fig" in capsys.readouterr().err


def test_a_gap_in_what_was_published_costs_neither_the_measurement_nor_the_other_figures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "curves_index.csv").write_text("curve_id,figure,axes,label\n1,a,0,x\n")
    (tmp_path / "curves.csv").write_text("curve_id,x,y\n1,0,0\n")
    out = tmp_path / "out"
    words = ["figures", "S9", "9C", "4D", "--fast", "--out", str(out)]
    assert main([*words, "--paper-data", str(tmp_path)]) == 1
    told = capsys.readouterr()
    assert [line.split()[0] for line in told.out.splitlines()] == ["S9", "9C", "4D"]
    for name, missing in (("S9", "curves_index.csv: no curve ''"), ("9C", "fig8_heatmap.npz")):
        (line,) = [line for line in told.err.splitlines() if f"figure {name} is" in line]
        assert "drawn without the paper's curves" in line
        assert missing in line
        made = out / FIGURES[name].file_name
        assert made.with_suffix(".png").exists()
        assert json.loads(made.with_suffix(".json").read_text())["published"] is False
    assert main(words) == 0
    assert capsys.readouterr().out.count("as measured before") == 3


def test_a_measurement_is_written_before_what_was_published_is_looked_at(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "curves_index.csv").write_text("curve_id,figure,axes,label\n")
    (tmp_path / "curves.csv").write_text("curve_id,x,y\n")

    def fail(*_: object) -> None:
        raise ZeroDivisionError

    words = ["figures", "S9", "--out", str(tmp_path)]
    with monkeypatch.context() as patch:
        patch.setattr(Figure, "with_published", fail)
        with pytest.raises(ZeroDivisionError):
            main([*words, "--paper-data", str(tmp_path)])
    assert main(words) == 0
    assert "as measured before" in capsys.readouterr().out


def test_the_tones_of_the_papers_method_are_drawn_wherever_they_are(tmp_path: Path) -> None:
    def entry(volt: float, paper_hz: float) -> dict[str, Any]:
        return {"m": 64, "volt": volt, "paper_hz": paper_hz, "paper": [[10.0], [1.0]], "peaks_hz": [20.0], "ours": None}

    # Noise is the strongest tone of one voltage, far above the motor's.
    found = {"numbers": [entry(1.0, 13.0), entry(5.0, 300.0)]}
    run = Run(tmp_path, fast=True)
    write_stamped(tmp_path / "shared" / "motors.json", {**run.settings, **found})
    (panel,) = [one for one in FIGURES["rotator"].measure(run) if one.x_label.startswith("voltage")]
    assert {curve.label: curve.y for curve in panel.curves}["paper's method"] == [13.0, 300.0]
    assert "half the frame rate" not in [curve.label for curve in panel.curves]


def test_an_interruption_leaves_no_half_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_stamped(tmp_path / "fig4d.json", {"seed": 1})
    assert not list(tmp_path.iterdir())


def test_the_page_names_the_files_that_are_read() -> None:
    root = Path(__file__).resolve().parents[3]
    code = "".join(path.read_text() for path in (root / "acts_tools" / "acts_tools" / "figures").rglob("*.py"))
    page = (root / "docs" / "paper.md").read_text()
    listed = page.partition("some figures npz files: ")[2].partition(".")[0]
    assert sorted(re.findall(r"`(\w+)`", listed)) == sorted(set(re.findall(r'"(\w+)\.npz"', code)))
