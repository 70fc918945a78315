# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Broken wiring of the virtual board, seen through a whole frame of a known field."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from board_process import BoardProcess
from core_library import installed
from numpy.typing import NDArray

ROWS, COLS = 6, 8
FIELD = (np.arange(ROWS * COLS, dtype=np.uint16) * 4 + 100).reshape(ROWS, COLS)
OPTIONS = ("--rows", ROWS, "--cols", COLS, "--scheme", "raster", "--noise-counts", 0)


def picture(folder: Path, *faults: str) -> NDArray[np.int64]:
    np.save(folder / "field.npy", FIELD[np.newaxis])
    words = [word for fault in faults for word in ("--hardware-fault", fault)]
    with BoardProcess(folder, *OPTIONS, "--recording", folder / "field.npy", *words) as board:
        board.open_port()
        frame = board.read_frames(1)[0]
    image = np.zeros(ROWS * COLS, dtype=np.int64)
    image[frame.indices] = frame.counts
    return image.reshape(ROWS, COLS)


def test_open_lines_carry_nothing(tmp_path: Path) -> None:
    expected = FIELD.copy()
    expected[2] = 0
    expected[:, 5] = 0
    assert (picture(tmp_path, "open-row=2", "open-col=5") == expected).all()


def test_shorted_lines_conduct_together(tmp_path: Path) -> None:
    expected = FIELD.astype(int)
    expected[[1, 3, 4]] = FIELD[1].astype(int) + FIELD[3] + FIELD[4]
    expected[:, [0, 7]] = (expected[:, 0] + expected[:, 7])[:, np.newaxis]
    # Two shorts that share a row join three.
    image = picture(tmp_path, "short-rows=1,3", "short-rows=4,3", "short-cols=0,7")
    assert (image == np.minimum(expected, 1023)).all()


def test_a_short_to_an_open_row_brings_nothing(tmp_path: Path) -> None:
    expected = FIELD.copy()
    expected[[1, 3]] = FIELD[1]
    assert (picture(tmp_path, "short-rows=1,3", "open-row=3") == expected).all()


def test_broken_taxels_read_the_same_always(tmp_path: Path) -> None:
    expected = FIELD.copy()
    expected[4, 2], expected[0, 7], expected[5, 5] = 0, 700, 0
    assert (picture(tmp_path, "dead=4,2", "stuck=0,7,700", "stuck=5,5,1000", "open-row=5")[:5] == expected[:5]).all()
    assert (picture(tmp_path, "stuck=5,5,1000", "open-row=5")[5] == 0).all()


def test_a_broken_address_line_is_pulled_low(tmp_path: Path) -> None:
    columns = np.arange(COLS) & ~2
    assert (picture(tmp_path, "address-bit=1") == FIELD[:, columns]).all()


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("open-row", "allowed is one of open-row=R"),
        ("open-row=", "allowed is one of"),
        ("open-row=6", "an array of 6 x 8 has the rows 0 to 5"),
        ("open-col=8", "an array of 6 x 8"),
        ("open-row=64", "R and C from 0 to 63"),
        ("open-row=1,2", "allowed is one of"),
        ("short-rows=3", "allowed is one of"),
        ("short-cols=3,3", "two lines of a short unlike"),
        ("dead=1,-1", "allowed is one of"),
        ("stuck=1,1,1024", "COUNTS to 1023"),
        ("address-bit=6", "B to 5"),
        ("address-bit=3", "none of 8 columns has this bit set"),
        ("loose-row=1", "allowed is one of"),
    ],
)
def test_impossible_faults_are_refused(fault: str, words: str) -> None:
    command: list[str | Path] = [installed("virtual_board"), *map(str, OPTIONS), "--hardware-fault", fault]
    result = subprocess.run(command, capture_output=True, text=True, timeout=30)
    assert result.returncode == 2
    assert "--hardware-fault" in result.stderr
    assert words in result.stderr
