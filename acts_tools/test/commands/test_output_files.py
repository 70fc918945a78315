# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Output files that cannot be: every command refuses them before its work, and writes nothing beside them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from acts_tools.cli import main

pytestmark = pytest.mark.slow

TIMEOUT_S = 60.0

COMMANDS = [
    ["selftest", "--sim", "--picture"],
    ["selftest", "--sim", "--json"],
    ["evaluate", "objects", "--picture"],
    ["evaluate", "objects", "--json"],
    ["evaluate", "classification", "--picture"],
    ["evaluate", "classification", "--json"],
    ["evaluate", "slip", "--frames", "/no.npz", "--picture"],
    ["evaluate", "slip", "--frames", "/no.npz", "--json"],
    ["evaluate", "gait", "--json"],
    ["evaluate", "hand", "--scenario", "slip", "--json"],
    ["evaluate", "convert", "insole", "/no", "-o"],
    ["bench", "--json"],
    ["doctor", "--json"],
    ["train", "-o"],
    ["library", "-o"],
]


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: " ".join(words))
def test_a_folder_is_no_file_to_write(words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "results"
    folder.mkdir()
    assert main([*words, str(folder)]) == 1
    assert f"{folder}: cannot be written (Is a directory)" in capsys.readouterr().err
    assert list(tmp_path.rglob("*")) == [folder]


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: " ".join(words))
def test_a_name_that_is_too_long_is_told_in_one_line(
    words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"{'a' * 300}.png"
    assert main([*words, str(path)]) == 1
    assert f"error: {path}: cannot be written (File name too long)" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "words",
    [
        "train --presses 8 --patches 8 --atoms 2 --sparsity 1 --iterations 1 -o",
        "library --presses 1 --objects circle spoon -o",
        "evaluate gait --frames nothing.npz --json",
    ],
)
def test_what_cannot_be_written_to_a_pipe_is_refused_before_any_work(
    words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    try:
        assert main([*words.split(), str(pipe)]) == 1
    finally:
        os.close(reader)
    said = capsys.readouterr()
    # Reports as JSON can be.
    about = "nothing.npz" if "--json" in words else f"{pipe}: not a regular file, so nothing is written to it"
    assert said.err.startswith(f"error: {about}")
    assert said.out == ""
    assert list(tmp_path.iterdir()) == [pipe]


@pytest.mark.parametrize("words", ["train -o", "evaluate gait --json"])
def test_a_file_in_a_folder_that_takes_no_new_ones_is_refused_before_any_work(words: str, tmp_path: Path) -> None:
    path = tmp_path / "shared" / "report"
    path.parent.mkdir()
    path.write_text("older")
    path.parent.chmod(0o555)
    # Root may write anywhere otherwise.
    as_user = ["setpriv", "--bounding-set=-dac_override"] if os.geteuid() == 0 else []
    command = [*as_user, sys.executable, "-m", "acts_tools", *words.split(), str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT_S)
    path.parent.chmod(0o755)
    assert done.returncode == 1
    refusal = f"error: {path}: cannot be written: its folder takes no new files (Permission denied)"
    assert done.stderr.startswith(refusal), done.stderr
    assert done.stdout == ""
    assert path.read_text() == "older"


@pytest.mark.parametrize("is_folder", [False, True])
def test_a_training_that_cannot_keep_its_progress_does_not_begin(
    is_folder: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / ("d.npz" if is_folder else "d" * 250)
    partial = path.with_name(f"{path.name}.partial")
    if is_folder:
        partial.mkdir()
    assert main(["train", "--presses", "8", "-o", str(path)]) == 1
    said = capsys.readouterr()
    assert f"error: {partial}: cannot be written (" in said.err
    assert said.out == ""
    assert list(tmp_path.iterdir()) == ([partial] if is_folder else [])


def test_a_link_to_a_file_that_is_not_there_yet_stays(tmp_path: Path) -> None:
    link, report = tmp_path / "link.json", tmp_path / "report.json"
    link.symlink_to(report)
    assert main(["evaluate", "gait", "--seeds", "1", "--rate", "8", "--json", str(link)]) == 0
    assert link.is_symlink()
    assert json.loads(report.read_text())["results"]


@pytest.mark.parametrize("words", ["outlines --surfaces", "spectra --recordings", "wearables --recordings"])
def test_a_file_is_no_folder_to_write_into(words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "results"
    file.touch()
    assert main(["evaluate", *words.split(), str(file)]) == 1
    said = capsys.readouterr()
    assert f"{file}: no files can be written there (File exists); needed is the name of a folder" in said.err
    assert said.out == ""
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("name", ["results", "results.doc"])
@pytest.mark.parametrize(
    "words", [words for words in COMMANDS if words[-1] == "--picture"], ids=lambda words: " ".join(words)
)
def test_a_picture_says_its_kind(
    words: list[str], name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*words, str(tmp_path / name)]) == 1
    assert f"{name}: no name of a picture; allowed are names that end in .png, .svg, .pdf" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("words", "name"), [(["ball_balancing"], "ball_balancing"), (["hand", "slip"], "hand")])
def test_a_demo_writes_its_files_or_does_not_begin(
    words: list[str], name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / f"{name}.png").mkdir()
    assert main(["demo", *words, "--out", str(tmp_path)]) == 1
    assert f"{name}.png: cannot be written (Is a directory)" in capsys.readouterr().err


@pytest.mark.parametrize(
    "words",
    [
        "library -o",
        "train -o",
        "evaluate classification --json",
        "evaluate gait --json",
        "evaluate recovery --json",
        "evaluate slip --json",
    ],
)
def test_recordings_are_not_replaced_by_what_is_made_of_them(
    words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recordings, same = tmp_path / "recordings.npz", tmp_path / "link.npz"
    frames = np.zeros((20, 16, 16), dtype=np.uint16)
    frames[:, 3:9, 3:9] = 400
    np.savez(recordings, frames=frames, start=[0, 10], length=[10, 10], label=["pen", "cup"], rate_hz=100.0)
    same.symlink_to(recordings)
    before = recordings.read_bytes()
    assert main([*words.split(), str(same), "--frames", str(recordings)]) == 1
    assert f"{same}: is read, and would be lost" in capsys.readouterr().err
    assert recordings.read_bytes() == before


def test_a_picture_does_not_replace_the_recording_that_it_shows(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "recording.png"
    path.write_bytes(b"frames")
    assert main(["evaluate", "slip", "--frames", str(path), "--picture", str(path)]) == 1
    assert f"{path}: is read, and would be lost" in capsys.readouterr().err
    assert path.read_bytes() == b"frames"


@pytest.mark.parametrize("name", ["touch_0.mcap", "touch_0.db3", "touch_0.mcap.zstd", "metadata.yaml"])
def test_a_dictionary_does_not_replace_a_file_of_the_bag_that_it_is_learnt_from(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "touch" / name
    path.parent.mkdir()
    path.write_bytes(b"touch")
    assert main(["train", "--frames", str(path.parent), "-o", str(path)]) == 1
    assert f"{path}: is read, and would be lost" in capsys.readouterr().err
    assert path.read_bytes() == b"touch"


def test_the_progress_of_a_training_does_not_replace_what_it_learns_from(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "mine.npz.partial"
    np.savez(tmp_path / "frames.npz", frames=np.full((20, 16, 16), 400, np.uint16))
    (tmp_path / "frames.npz").rename(path)
    before = path.read_bytes()
    assert main(["train", "--frames", str(path), "-o", str(tmp_path / "mine.npz")]) == 1
    assert f"{path}: is read, and would be lost" in capsys.readouterr().err
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("which", "name"), [("slips", "pressure_profiles/a.dsa"), ("insole", "Experiment_Dataset/a.csv")]
)
def test_public_recordings_are_not_replaced_by_what_they_are_converted_to(
    which: str, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / name
    path.parent.mkdir()
    path.write_bytes(b"public")
    assert main(["evaluate", "convert", which, str(tmp_path), "-o", str(path)]) == 1
    assert f"{path}: is read, and would be lost" in capsys.readouterr().err
    assert path.read_bytes() == b"public"


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ("edges --recordings", "edge.npy"),
        ("impacts --recordings", "drop.npy"),
        ("outlines --recordings", "tennis.npy"),
        ("outlines --surfaces", "tennis_m64.ply"),
        ("outlines --surfaces", "tennis_m64.png"),
        ("ricochet --recordings", "throw_1_m_s_0_deg.npy"),
        ("spectra --recordings", "motor_10.0_hz.npy"),
        ("wearables --recordings", "arm_taps.npy"),
    ],
)
def test_results_do_not_replace_a_scene_that_is_written_beside_them(
    words: str, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / name
    assert main(["evaluate", *words.split(), str(tmp_path), "--seeds", "1", "--json", str(path)]) == 1
    told = capsys.readouterr()
    assert f"{path}: has the name of a file that the command writes in {tmp_path}; give one that does not" in told.err
    assert told.out == ""
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "words",
    ["selftest --sim", "evaluate objects", "evaluate classification", "evaluate slip --frames /no.npz"],
)
def test_picture_and_json_file_are_two_files(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "results.png"
    assert main([*words.split(), "--picture", str(path), "--json", path.name]) == 1
    assert f"error: {path}: is to be both the picture and the JSON file; give one" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
