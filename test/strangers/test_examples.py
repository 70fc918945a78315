# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The scripts of examples/ as docs/without_ros.md has them, on a recording made here and on virtual boards."""

from __future__ import annotations

import os
import re
import runpy
import signal
import subprocess
import sys
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from ament_index_python.packages import get_package_prefix

from acts_core.array import ArrayGeometry
from acts_recon.sparse import Reconstructor, load_dictionary

pytestmark = pytest.mark.slow

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
TRIES = 10

Run = Callable[..., str]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs an example with words of a command line; returns what it prints."""

    def run_example(name: str, *words: str) -> str:
        monkeypatch.setattr(sys, "argv", [name, *words])
        runpy.run_path(str(EXAMPLES / name), run_name="__main__")
        return capsys.readouterr().out

    return run_example


@pytest.fixture
def presses(tmp_path: Path) -> Path:
    """Twenty presses of an array of 16 x 12, and a long last one at row 5, column 8."""
    rows, cols = np.indices((16, 12))
    random = np.random.default_rng(0)
    places = [(*random.uniform(2, 10, 2), random.uniform(1, 2)) for _ in range(20)] + [(5.0, 8.0, 1.5)] * 20
    frames = [600 * np.exp(-((rows - row) ** 2 + (cols - col) ** 2) / (2 * width**2)) for row, col, width in places]
    path = tmp_path / "presses.npz"
    np.savez(path, frames=np.rint(frames).astype(np.uint16), rate_hz=100.0)
    return path


def test_a_frame_is_recovered(run: Run) -> None:
    said = run("recover_frame.py")
    assert "128 of 1024 taxels measured" in said
    assert float(re.findall(r"relative error of the image ([\d.]+)", said)[0]) < 0.15
    assert "contact at row 14.0, column 20.0" in said


def test_a_recording_is_fused(run: Run, presses: Path) -> None:
    last = run("fuse_recording.py", str(presses)).splitlines()[-1]
    x_mm, y_mm = map(float, re.findall(r"[xy] +(-?[\d.]+) mm,", last)[:2])
    geometry = ArrayGeometry(16, 12)
    assert x_mm == pytest.approx(1000 * float(geometry.x_m(8)), abs=0.3)
    assert y_mm == pytest.approx(1000 * float(geometry.y_m(5)), abs=0.3)


def test_a_recording_in_which_taxels_come_twice_is_fused(run: Run, tmp_path: Path) -> None:
    indices = np.tile([5, 6, 5, 6], (60, 1))
    np.savez(
        tmp_path / "fixed.npz", indices=indices, counts=indices * 100, rate_hz=1000.0, rows=4, cols=4, scheme="fixed"
    )
    assert re.match(r" +0\.050 s: x ", run("fuse_recording.py", str(tmp_path / "fixed.npz")).splitlines()[1])


def test_contacts_are_told_on_where_the_board_was_restarted(run: Run, tmp_path: Path) -> None:
    indices, pressed = np.tile(np.arange(64), (300, 1)), np.isin(np.arange(64), (27, 28))
    np.savez(
        tmp_path / "restarted.npz",
        indices=indices,
        counts=np.where(pressed, 500, 0) * np.ones((300, 1), dtype=np.int64),
        sequence=np.concatenate((np.arange(100_000, 100_100), np.arange(200))),
        rate_hz=1000.0,
        rows=8,
        cols=8,
    )
    times = re.findall(r"^ +(\d\.\d{3}) s: x ", run("fuse_recording.py", str(tmp_path / "restarted.npz")), re.MULTILINE)
    assert times == ["0.000", "0.050", "0.100", "0.150", "0.200", "0.250"]


def test_a_recording_of_volts_is_told_to_hold_no_contact(run: Run, tmp_path: Path) -> None:
    np.savez(tmp_path / "volts.npz", frames=np.full((3, 8, 8), 3.3), rate_hz=100.0)
    assert run("fuse_recording.py", str(tmp_path / "volts.npz")).startswith("no contact: none of the taxels measured")


def test_a_dictionary_is_learnt_that_the_reconstruction_takes(run: Run, presses: Path, tmp_path: Path) -> None:
    assert "iteration 10" in run("learn_dictionary.py", str(presses), str(tmp_path / "mine.npz"), "30")
    dictionary = load_dictionary(tmp_path / "mine.npz")
    assert dictionary.n_atoms == 30
    Reconstructor(ArrayGeometry(16, 12), dictionary)


@contextmanager
def virtual_board(folder: Path, protocol: str) -> Iterator[Path]:
    """A virtual board of 16 x 16 taxels, pressed at row 4, column 11; its port."""
    rows, cols = np.indices((16, 16))
    press = np.rint(600 * np.exp(-((rows - 4) ** 2 + (cols - 11) ** 2) / 4)).astype(np.uint16)
    np.save(folder / "press.npy", np.repeat(press[np.newaxis], 2, axis=0))
    program = Path(get_package_prefix("acts_firmware")) / "lib/acts_firmware/virtual_board"
    options = ["--rows", "16", "--cols", "16", "--scheme", "tracking", "--m", "55", "--protocol", protocol]
    options += ["--recording", str(folder / "press.npy"), "--link", str(folder / "board"), "--print-status"]
    with subprocess.Popen([str(program), *options], stdout=subprocess.PIPE, text=True) as board:
        try:
            assert board.stdout is not None
            assert board.stdout.readline().startswith("{")
            yield folder / "board"
        finally:
            board.kill()


@pytest.mark.parametrize("pressed_from", [0, 60])
def test_a_short_press_is_told_whenever_it_comes(run: Run, tmp_path: Path, pressed_from: int) -> None:
    """It was told only in every fiftieth frame."""
    frames = np.zeros((90, 8, 8))
    frames[pressed_from : pressed_from + 10, 3:5, 3:5] = 400
    np.savez(tmp_path / "short.npz", frames=frames, rate_hz=1000.0)
    (line,) = run("fuse_recording.py", str(tmp_path / "short.npz")).splitlines()
    assert f"{pressed_from / 1000:.2f}" in line[:7]


def test_a_board_that_is_no_more_listened_to_is_told_of_at_the_end(tmp_path: Path) -> None:
    with virtual_board(tmp_path, "binary") as port:
        command = [sys.executable, str(EXAMPLES / "read_board.py"), str(port)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as example:
            try:
                assert example.stdout is not None
                assert example.stdout.readline().startswith("an array of 16 x 16")
                example.stdout.readline()
                example.send_signal(signal.SIGINT)
                rest, errors = example.communicate(timeout=30)
            finally:
                example.kill()
    assert example.returncode == 0
    assert errors == ""
    assert "frames, 0 packets damaged" in rest.splitlines()[-1]


def test_a_second_ctrl_c_changes_nothing() -> None:
    code = (
        "import signal, sys\n"
        f"sys.path.insert(0, {str(EXAMPLES)!r})\n"
        "import read_board\n"
        "class Source:\n"
        "    name = 'port'\n"
        "    def read(self):\n"
        "        signal.raise_signal(signal.SIGINT)\n"
        "class Decoder:\n"
        "    def feed(self, data):\n"
        "        return []\n"
        "try:\n"
        "    read_board.read(Source(), Decoder(), 60.0)\n"
        "finally:\n"
        "    signal.raise_signal(signal.SIGINT)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 1
    assert re.fullmatch(r"error: no frame from port in \S+ s\n", done.stderr)


@pytest.mark.parametrize("protocol", ["binary", "raster_ascii"])
def test_a_board_is_read_over_serial(run: Run, tmp_path: Path, protocol: str) -> None:
    words = ["--ascii", "16", "16"] if protocol == "raster_ascii" else []
    with virtual_board(tmp_path, protocol) as port:
        # On a busy machine a second may be too short to find the press.
        for _ in range(TRIES):
            said = run("read_board.py", str(port), "--seconds", "1.2", *words).splitlines()[-1]
            assert "frames, 0 packets damaged" in said
            if "touched at" in said:
                break
    frames, damaged, x_mm, y_mm = map(float, re.findall(r"-?\d+(?:\.\d+)?", said))
    geometry = ArrayGeometry(16, 16)
    assert frames > 10
    assert damaged == 0
    assert (x_mm, y_mm) == pytest.approx((1000 * float(geometry.x_m(11)), 1000 * float(geometry.y_m(4))), abs=0.5)


def test_what_came_in_less_than_a_second_is_told_at_the_end(run: Run, tmp_path: Path) -> None:
    with virtual_board(tmp_path, "binary") as port:
        said = run("read_board.py", str(port), "--seconds", "0.9").splitlines()
    assert said[0].startswith("an array of 16 x 16")
    assert "frames, 0 packets damaged" in said[1]


def test_a_port_that_sends_nothing_is_told(run: Run) -> None:
    master, slave = os.openpty()
    tty.setraw(slave)
    try:
        with pytest.raises(SystemExit, match=f"^error: no frame from {os.ttyname(slave)} in 0.1 s"):
            run("read_board.py", os.ttyname(slave), "--seconds", "0.1")
    finally:
        os.close(master)
        os.close(slave)


@pytest.mark.parametrize(
    ("example", "words", "said"),
    [
        ("read_board.py", ["serial:"], "error: port = 'serial:': allowed are a path such as /dev/ttyACM0, auto, or"),
        ("read_board.py", ["{here}"], "error: {here} is no serial port. "),
        ("read_board.py", ["{here}/board"], "error: port {here}/board is not there; plug the board in or name another"),
        ("fuse_recording.py", ["{here}/no.npz"], "error: there is no recording '{here}/no.npz'; give a bag"),
        ("fuse_recording.py", ["{here}/words.npz"], "error: {here}/words.npz: not an npz file, or a part of one; need"),
        ("fuse_recording.py", ["{here}/words.txt"], "error: '{here}/words.txt' is no recording that can be replayed: "),
        (
            "fuse_recording.py",
            ["{here}"],
            "error: '{here}' holds no bag that can be read: it has no metadata.yaml, and no",
        ),
        (
            "learn_dictionary.py",
            ["{here}/no.npz", "{here}/d.npz"],
            "error: {here}/no.npz: cannot be read (No such file",
        ),
        ("learn_dictionary.py", ["{here}/words.npz", "{here}/d.npz"], "error: {here}/words.npz: not an npz file"),
        ("learn_dictionary.py", ["{here}/words.npz", "{here}/d.npz", "1"], "error: atoms"),
    ],
)
def test_what_cannot_be_read_is_said_in_words(
    run: Run, tmp_path: Path, example: str, words: list[str], said: str
) -> None:
    for name in ("words.npz", "words.txt"):
        (tmp_path / name).write_text("no recording")
    # An exit with words: Python writes them to stderr, and ends with code 1.
    with pytest.raises(SystemExit, match="^" + re.escape(said.format(here=tmp_path))):
        run(example, *[word.format(here=tmp_path) for word in words])


@pytest.mark.parametrize(
    ("example", "words", "said"),
    [
        ("fuse_recording.py", [], "required: file"),
        ("learn_dictionary.py", ["FILE.npz"], "required: dictionary"),
        ("learn_dictionary.py", ["FILE.npz", "{here}/no/d.npz"], "there is no folder {here}/no; make it first"),
        ("learn_dictionary.py", ["FILE.npz", "{here}"], "{here} is a folder; name the file to write"),
        ("learn_dictionary.py", ["FILE.npz", "{here}/d.npz", "many"], "invalid int value: 'many'"),
    ],
)
def test_a_wrong_command_line_is_refused(
    run: Run, capsys: pytest.CaptureFixture[str], tmp_path: Path, example: str, words: list[str], said: str
) -> None:
    with pytest.raises(SystemExit) as end:
        run(example, *[word.format(here=tmp_path) for word in words])
    assert end.value.code == 2
    assert said.format(here=tmp_path) in capsys.readouterr().err
