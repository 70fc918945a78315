# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How evaluations tell what is wrong before the work, how far they are, and what they leave when interrupted."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from acts_core.sampling import SamplingConfig
from acts_tools.cli import main
from acts_tools.evaluate.estimators.dictionaries import cosine_dictionary
from acts_tools.evaluate.images import tasks
from acts_tools.evaluate.images.recovery import Recording, Task, evaluate, images
from acts_tools.evaluate.report import Results


@pytest.fixture
def frames(tmp_path: Path) -> Path:
    pressed = np.zeros((30, 6, 20), dtype=np.uint16)
    pressed[5:, 2:4, 10:12] = 300
    path = tmp_path / "frames.npz"
    np.savez(path, frames=pressed, rate_hz=500.0)
    return path


@pytest.mark.parametrize(
    "words",
    [
        ["recovery", "--presses", "1", "--json"],
        ["events", "--event", "tap_4x4", "--recordings", "1", "--json"],
        ["objects", "--objects", "eraser", "--m", "64", "--json"],
        ["objects", "--objects", "eraser", "--m", "64", "--picture"],
        ["classification", "--arms", "1", "--json"],
        ["classification", "--arms", "1", "--picture"],
    ],
)
def test_what_cannot_be_written_is_told_before_the_work(
    words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for path in (tmp_path / "no" / "out", tmp_path):
        assert main(["evaluate", *words, str(path)]) == 1
        told = capsys.readouterr()
        assert f"{path}: cannot be written" in told.err
        assert told.out == ""
    assert not list(tmp_path.iterdir())


def test_a_method_whose_patches_do_not_fit_is_told_before_the_others_work(
    frames: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out.json"
    words = ["--m", "20", "--method", "last", "paper", "--json", str(out)]
    assert main(["evaluate", "recovery", "--frames", str(frames), *words]) == 1
    told = capsys.readouterr()
    assert "patches of 8 x 8 taxels do not fit a side of 6" in told.err
    assert told.out == ""
    assert not out.exists()


def test_an_interrupted_evaluation_keeps_what_is_done(
    frames: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(recordings: Any, task: Task, *others: Any) -> dict[str, Any]:
        if task.method == "zero":
            raise KeyboardInterrupt
        return evaluate(recordings, task, *others)

    monkeypatch.setattr(tasks, "evaluate", interrupted)
    out = tmp_path / "out.json"
    words = ["--m", "20", "--method", "last", "zero", "--json", str(out)]
    assert main(["evaluate", "recovery", "--frames", str(frames), *words]) == 130
    assert [entry["method"] for entry in json.loads(out.read_text())["results"]] == ["last"]


@pytest.mark.parametrize(("m", "rate_hz", "n"), [(55, 31.0, 40), (128, 1000.0, 90), (1024, 4000.0, 1), (7, 0.5, 3)])
def test_the_number_of_images_is_known_beforehand(m: int, rate_hz: float, n: int) -> None:
    recordings = [Recording(np.full((n, 32, 32), 300, dtype=np.uint16), rate_hz, np.ones((32, 32), dtype=bool))] * 2
    task = Task(SamplingConfig(scheme="random", m=m), "zero", onset_s=0.0)
    shown: list[int] = []
    result = evaluate(recordings, task, cosine_dictionary(), shown.append)
    assert abs(images(recordings, task) - result["frames"]) <= len(recordings)
    assert shown == list(range(500, result["frames"] + 1, 500))


def test_a_disk_that_is_full_leaves_the_results_so_far(tmp_path: Path) -> None:
    code = (
        "import resource\nfrom pathlib import Path\nfrom acts_tools.evaluate.report import Results\n"
        "results = Results(Path('out.json'), {})\nresults.add({'m': 1})\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\nresults.add({'more': 'x' * 5000})\n"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "RecordingError: out.json: cannot be written (File too large)" in ended.stderr
    assert json.loads((tmp_path / "out.json").read_text()) == {"results": [{"m": 1}]}
    assert [path.name for path in tmp_path.iterdir()] == ["out.json"]


def test_a_disk_that_is_full_leaves_the_picture_before(tmp_path: Path) -> None:
    code = (
        "import resource\nfrom pathlib import Path\nfrom acts_tools.evaluate.picture import diagrams\n"
        "with diagrams(Path('out.png'), 1, 1, size_inch=(6, 4), dpi=100):\n"
        "    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
    )
    (tmp_path / "out.png").write_text("before")
    ended = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "RecordingError: out.png: cannot be written (File too large)" in ended.stderr
    assert (tmp_path / "out.png").read_text() == "before"
    assert [path.name for path in tmp_path.iterdir()] == ["out.png"]


def test_a_disk_that_is_full_is_told_of_a_recording_for_a_board(tmp_path: Path) -> None:
    code = (
        "import resource\nfrom pathlib import Path\nimport numpy as np\n"
        "from acts_tools.evaluate.scene_recordings import write_recording\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
        "write_recording(Path('scenes'), 'drop', np.zeros((10, 32, 32), dtype=np.uint16), 100.0)\n"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "RecordingError: scenes/drop.npy: cannot be written (File too large)" in ended.stderr
    assert not list((tmp_path / "scenes").iterdir())


def test_results_are_in_the_file_as_soon_as_they_are_there(tmp_path: Path) -> None:
    path = tmp_path / "out.json"
    path.write_text("older")
    results = Results(path, {"seed": 3})
    assert path.read_text() == "older"
    results.add({"m": 1})
    assert json.loads(path.read_text()) == {"seed": 3, "results": [{"m": 1}]}
    Results(None, {}).add({"m": 1})
