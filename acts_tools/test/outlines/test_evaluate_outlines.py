# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts evaluate outlines`: what it reports of a few touches, and the surfaces that it writes."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_tools.cli import main
from acts_tools.evaluate.outlines import surface_files

pytestmark = pytest.mark.slow


def test_outlines_are_nearer_to_the_truth_than_by_the_papers_method(tmp_path: Path) -> None:
    out, folder = tmp_path / "outlines.json", tmp_path / "surfaces"
    words = ["evaluate", "outlines", "--seeds", "2", "--m", "64", "--json", str(out), "--surfaces", str(folder)]
    assert main([*words, "--recordings", str(tmp_path / "scenes")]) == 0
    results = json.loads(out.read_text())["results"]
    assert [entry["body"] for entry in results] == ["tennis"] * 3 + ["block"] * 3 + ["balloon"] * 3
    for paper, ours, alike in zip(results[::3], results[1::3], results[2::3], strict=True):
        assert (paper["method"], ours["method"], ours["scheme"]) == ("paper", "acts", "tracking")
        assert alike["scheme"] == paper["scheme"]
        assert ours["error_taxels_from_third"]["mean"] < min(paper["error_taxels_from_third"]["mean"], 0.5)
        assert ours["frames_with_outline"] > 0.8 * ours["frames_of_touch"]
    assert sorted(path.name for path in folder.iterdir()) == [
        f"{body}_m64.{kind}" for body in ("balloon", "block", "tennis") for kind in ("ply", "png")
    ]
    for body in ("balloon", "block", "tennis"):
        frames = np.load(tmp_path / "scenes" / f"{body}.npy")
        assert (frames.shape, frames.dtype) == ((8000, 32, 32), np.uint16)
        assert not frames[0].any()
        assert frames.max() > 100
    assert (folder / "tennis_m64.png").read_bytes().startswith(b"\x89PNG")


def test_a_touch_of_few_frames_has_a_surface_that_can_be_read_or_is_told_to_have_none(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: dict[str, Any] = {}
    monkeypatch.setattr(
        surface_files, "save_picture", lambda figure, path, **options: drawn.update({path.name: figure})
    )
    words = ["evaluate", "outlines", "--body", "tennis", "block", "--m", "256", "--seeds", "1"]
    assert main([*words, "--surfaces", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert f"{tmp_path / 'tennis_m256'}: no surface, which takes outlines of two frames or more" in told
    assert f"\n{tmp_path / 'block_m256.ply'}\n" in told
    assert [path.name for path in tmp_path.iterdir()] == ["block_m256.ply"]
    assert list(drawn) == ["block_m256.png"]
    (axes,) = drawn["block_m256.png"].axes
    axes.figure.draw_without_rendering()
    for axis in (axes.xaxis, axes.yaxis):
        labels = [tick.label1.get_window_extent() for tick in axis.get_major_ticks()]
        assert len(labels) > 2
        assert not any(one.overlaps(other) for one, other in pairwise(labels))


def test_outlines_are_as_good_where_a_touch_takes_few_frames(tmp_path: Path) -> None:
    out = tmp_path / "outlines.json"
    assert main(["evaluate", "outlines", "--body", "tennis", "--m", "128", "--seeds", "8", "--json", str(out)]) == 0
    entry = json.loads(out.read_text())["results"][-1]
    assert entry["scheme"] == "adaptive"
    assert entry["error_taxels_from_third"]["mean"] < 0.3
    assert entry["frames_with_outline"] > 0.95 * entry["frames_of_touch"]
