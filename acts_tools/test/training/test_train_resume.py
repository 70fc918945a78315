# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""`acts train` interrupted and gone on with, and how it shows where it is."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_recon.learning import KsvdState
from acts_recon.sparse import load_dictionary
from acts_tools.cli import main
from acts_tools.training.checkpoint import Checkpoint

pytestmark = pytest.mark.slow

TIMEOUT_S = 60.0
WORDS = ("--presses", "60", "--patches", "400", "--atoms", "50", "--sparsity", "4", "--objects", "eraser", "x")


HOLDING = """
import sys
from acts_tools.cli import main
from acts_tools.training.checkpoint import Checkpoint

save = Checkpoint.save

def save_and_hold(self, state):
    save(self, state)
    print("saved", flush=True)
    sys.stdin.readline()

Checkpoint.save = save_and_hold
sys.exit(main(sys.argv[1:]))
"""
"""The acts command, but that a training waits for a line after every checkpoint: however slow the machine, a signal
comes while it is under way."""


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[str], str]:
    """A training of short iterations: its command without the output, and the hash of its result."""
    folder = tmp_path_factory.mktemp("whole")
    row, col = np.indices((12, 10))
    bumps = [900 * np.exp(-((row - r) ** 2 + (col - c) ** 2) / 9) for r in range(12) for c in range(10)]
    np.savez(folder / "frames.npz", frames=np.array(bumps).astype(np.uint16))
    words = ["train", "--frames", str(folder / "frames.npz"), "--patches", "200", "--atoms", "30", "--sparsity", "3"]
    words += ["--iterations", "20", "-o"]
    assert main([*words, str(folder / "d.npz")]) == 0
    return words, load_dictionary(folder / "d.npz").sha256


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_an_interrupted_training_ends_as_if_it_had_not_been(
    number: signal.Signals, whole: tuple[list[str], str], tmp_path: Path
) -> None:
    words, sha256 = whole
    path, partial = tmp_path / "d.npz", tmp_path / "d.npz.partial"
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDING, *words, str(path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        assert process.stdin is not None
        assert process.stdout is not None
        for go_on in (True, True, False):
            while (line := process.stdout.readline()) != "saved\n":
                assert line, "the training ended before it was interrupted"
            if go_on:
                process.stdin.write("\n")
                process.stdin.flush()
        process.send_signal(number)
        output, _ = process.communicate(timeout=TIMEOUT_S)
    finally:
        process.kill()
    assert process.returncode == (130 if number is signal.SIGINT else -number), output
    assert ("the same command continues" in output) == (number is signal.SIGINT)
    assert partial.exists()
    assert not path.exists()
    assert main([*words, str(path)]) == 0
    assert [found.name for found in tmp_path.iterdir()] == ["d.npz"]
    assert load_dictionary(path).sha256 == sha256


def test_a_training_goes_on_after_the_last_iteration(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "d.npz"
    partial = tmp_path / "d.npz.partial"
    words = ["train", "-o", str(path), *WORDS, "--iterations", "4"]
    saved: list[bytes] = []
    save = Checkpoint.save

    def keep(self: Checkpoint, state: KsvdState) -> None:
        save(self, state)
        saved.append(self.path.read_bytes())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Checkpoint, "save", keep)
        assert main(words) == 0
    whole = load_dictionary(path).sha256
    assert not partial.exists()
    partial.write_bytes(saved[1])
    capsys.readouterr()
    assert main(words) == 0
    output = capsys.readouterr().out
    assert f"the first 2 of them taken from {partial}" in output
    assert "iteration 2 of 4" not in output
    assert "iteration 3 of 4" in output
    assert load_dictionary(path).sha256 == whole


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("atoms", np.full((50, 64), np.nan)),
        ("atoms", np.full((50, 64), np.inf)),
        ("atoms", np.ones((50, 64), dtype=bool)),
        ("iteration", np.array(np.inf)),
        ("iteration", np.array([2])),
    ],
)
def test_a_checkpoint_of_what_is_no_training_is_refused(name: str, value: NDArray[np.generic], tmp_path: Path) -> None:
    """Atoms of NaN were gone on with, and the result was another one; an infinite iteration ended with a traceback."""
    checkpoint = Checkpoint(tmp_path / "d.npz.partial", {"sparsity": 3})
    checkpoint.save(KsvdState(2, np.ones((50, 64), dtype=np.float32)))
    with np.load(checkpoint.path) as arrays:
        content = {**arrays, name: value}
    with checkpoint.path.open("wb") as file:
        np.savez(file, **content)
    with pytest.raises(RecordingError, match=r"damaged \(iteration .*, atoms .*delete .*d.npz.partial to begin anew"):
        checkpoint.load()


def test_a_checkpoint_of_another_training_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "d.npz"
    partial = tmp_path / "d.npz.partial"
    checkpoint = Checkpoint(partial, {"sparsity": 3, "objects": ("a", "b")})
    checkpoint.save(KsvdState(2, np.ones((50, 64), dtype=np.float32)))
    state = checkpoint.load()
    assert state is not None
    assert state.iteration == 2
    with pytest.raises(RecordingError, match=r"other settings or data \(sparsity 3 there, 4 here\).*delete the file"):
        Checkpoint(partial, {"sparsity": 4, "objects": ["a", "b"]}).load()
    assert main(["train", "-o", str(path), *WORDS]) == 1
    assert "patches_sha256 None there" in capsys.readouterr().err
    assert not path.exists()
    assert partial.exists()
    partial.write_bytes(b"nothing")
    with pytest.raises(RecordingError, match=r"not an npz file.*delete .*d.npz.partial to begin anew"):
        checkpoint.load()
    checkpoint.remove()
    assert checkpoint.load() is None
