# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

import hashlib
from pathlib import Path

import numpy as np
import pytest

from acts_core.errors import ActsError, ArrayError, RecordingError, SettingsError
from acts_recon.sparse import load_dictionary
from acts_tools.cli import Parser
from acts_tools.training import command


def run(*words: object) -> int:
    parser = Parser()
    command.add_parser(parser.add_subparsers())
    return command.run(parser.parse_args(["train", *(str(word) for word in words)]))


OF_FRAMES = ("--patches", 400, "--atoms", 50, "--sparsity", 4, "--iterations", 2)
SMALL = ("--presses", 60, *OF_FRAMES)


def test_training_from_the_contact_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "d.npz"
    assert run("-o", path, *SMALL, "--seed", 3, "--objects", "eraser", "--objects", "x") == 0
    output = capsys.readouterr().out
    assert "iteration 2 of 2" in output
    dictionary = load_dictionary(path, patch_size=8)
    assert dictionary.atoms.shape == (64, 50)
    assert dictionary.settings["seed"] == 3
    assert dictionary.settings["objects"] == ["eraser", "x"]
    assert dictionary.settings["iterations"] == 2
    assert "60 presses of 2 objects" in dictionary.provenance
    assert dictionary.sha256 in output
    again = tmp_path / "again.npz"
    run("-o", again, *SMALL, "--seed", 3, "--objects", "eraser", "x", "x")
    assert load_dictionary(again).sha256 == dictionary.sha256


def test_training_from_frames(tmp_path: Path) -> None:
    frames = tmp_path / "frames.npz"
    row, col = np.indices((12, 10))
    bumps = [900 * np.exp(-((row - r) ** 2 + (col - c) ** 2) / 9) for r in range(12) for c in range(10)]
    np.savez(frames, frames=np.array(bumps).astype(np.uint16))
    path = tmp_path / "d.npz"
    assert run("-o", path, *OF_FRAMES, "--frames", frames, "--patch-size", 6) == 0
    dictionary = load_dictionary(path, patch_size=6)
    assert hashlib.sha256(frames.read_bytes()).hexdigest() in dictionary.provenance
    again = tmp_path / "again.npz"
    assert run("-o", again, *OF_FRAMES, "--frames", frames, frames, "--patch-size", 6) == 0
    assert load_dictionary(again, patch_size=6).provenance == dictionary.provenance


@pytest.mark.parametrize(
    ("words", "error", "word"),
    [
        (["--atoms", 1], SettingsError, "atoms = 1"),
        (["--iterations", 0], SettingsError, "iterations = 0"),
        (["--min-active", 65], SettingsError, "min_active = 65: allowed is 1 to 64"),
        (["--coherence", "nan"], SettingsError, "coherence = nan"),
        (["--objects", "cube"], SettingsError, "'cube' does not exist"),
        (["--objects", "eraser", "--frames", "x.npz"], SettingsError, "leave one out"),
        (["--frames", "/no/such.npz"], RecordingError, "/no/such.npz: cannot be read"),
        (["--patch-size", 33, "--min-active", 5], SettingsError, "patch_size = 33: allowed is 2 to 32"),
        ([*SMALL, "--atoms", 5000], ArrayError, "patches for 5000 atoms"),
    ],
)
def test_wrong_arguments_are_refused(words: list[object], error: type[ActsError], word: str, tmp_path: Path) -> None:
    with pytest.raises(error, match=word):
        run("-o", tmp_path / "d.npz", *words)
    assert not (tmp_path / "d.npz").exists()


def test_frames_of_another_unit_are_told(tmp_path: Path) -> None:
    np.savez(tmp_path / "volts.npz", frames=np.full((3, 16, 16), 3.3))
    with pytest.raises(RecordingError, match=r"volts\.npz: the largest count is 3, and only what is above 60"):
        run("-o", tmp_path / "d.npz", "--frames", tmp_path / "volts.npz")


def test_what_cannot_be_written_is_told_before_the_work(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in (tmp_path / "no" / "d.npz", tmp_path):
        with pytest.raises(RecordingError, match=f"{path}: cannot be written"):
            run("-o", path)
    assert capsys.readouterr().out == ""
