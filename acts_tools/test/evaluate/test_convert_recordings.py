# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Public recordings, made here in their published formats, become files that can be evaluated."""

from __future__ import annotations

import bz2
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import load_frames
from acts_tools.cli import main
from acts_tools.evaluate.public import insole, weiss

RANDOM = np.random.default_rng(0)


def weiss_file(path: Path, frames: NDArray[np.integer]) -> Path:
    """A recording of 486 texels a frame, zeros as runs, lines of seven words."""
    text = []
    for number, frame in enumerate(frames):
        words: list[float] = []
        for value in frame.tolist():
            if value == 0 and words and words[-1] < 0:
                words[-1] -= 1
            else:
                words.append(value or -1)
        digits = np.array(words, dtype=">f4").tobytes().hex().upper()
        lines = "\n        ".join(digits[i : i + 56] for i in range(0, len(digits), 56))
        text.append(
            f'<frame index="{number}"><time_stamp>{number}</time_stamp><frame_data>{lines}</frame_data></frame>'
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    content = f'<?xml version="1.0" encoding="utf-8"?>\n<root><sensor/><data>{"".join(text)}</data></root>'
    path.write_bytes(bz2.compress(content.encode()))
    return path


def hand(n: int) -> NDArray[np.int64]:
    return RANDOM.integers(0, 4096, (n, 486)) * (RANDOM.random((n, 486)) < 0.1)


def converted(which: str, folder: Path) -> Path:
    assert main(["evaluate", "convert", which, str(folder), "-o", str(folder / "out.npz")]) == 0
    return folder / "out.npz"


def test_grasps(tmp_path: Path) -> None:
    folder = tmp_path / "python/classification/training_grasp_profiles_thesis"
    recorded = {name: [hand(2), hand(3)] for name in weiss.OBJECTS}
    for name, recordings in recorded.items():
        for number, frames in enumerate(recordings):
            weiss_file(folder / name / f"{name}_{number}.dsa", frames)
    weiss_file(folder / "teapot_top" / "teapot_top_0.dsa", hand(1))
    found = load_frames(converted("grasps", tmp_path), labels=True)
    assert found.label == tuple(name for name in weiss.OBJECTS for _ in range(2))
    assert found.length.tolist() == [2, 3] * len(weiss.OBJECTS)
    assert found.rate_hz == 31.0
    assert found.live.sum() == 486
    # The first texel of the first array, the last one of the last.
    everything = np.concatenate([frames for recordings in recorded.values() for frames in recordings]) // 4
    np.testing.assert_array_equal(found.frames[:, 17, 2], everything[:, 0])
    np.testing.assert_array_equal(found.frames[:, 14, 29], everything[:, -1])
    assert found.frames.sum() == everything.sum()


def test_slips(tmp_path: Path) -> None:
    for number, name in enumerate(weiss.SLIPS):
        weiss_file(tmp_path / "pressure_profiles" / name, hand(number + 1))
    assert load_frames(converted("slips", tmp_path)).length.tolist() == [1, 2, 3, 4, 5]


def test_insoles(tmp_path: Path) -> None:
    feet = RANDOM.integers(0, 4096, (2, 3, 33, 15))
    for name in insole.RECORDINGS:
        path = tmp_path / "Experiment_Dataset" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        rows = [",".join(f'"{",".join(map(str, cells.ravel()))}"' for cells in feet[:, n]) for n in range(3)]
        path.write_text("\n".join(["Timestamp,head_x,Matrix_0,Matrix_1", *(f"1.5,0.1,{row}" for row in rows)]))
    found = load_frames(converted("insole", tmp_path), labels=True)
    assert found.frames.shape == (2 * 7 * 3, 33, 15)
    np.testing.assert_array_equal(found.frames[:3], feet[0] // 4)
    np.testing.assert_array_equal(found.frames[-3:], feet[1] // 4)
    assert found.label[0] == "plotting_0"


@pytest.mark.parametrize("which", ["grasps", "slips", "insole"])
def test_another_folder_is_refused_by_name(which: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["evaluate", "convert", which, str(tmp_path), "-o", str(tmp_path / "out.npz")]) == 1
    assert f"is {tmp_path} the repository?" in capsys.readouterr().err
    assert not (tmp_path / "out.npz").exists()


@pytest.mark.parametrize("digits", ["C3F3", "C3F40000", "FF800000", "7FC00000", "C3F2000045FFF800", "4300"])
def test_a_damaged_frame_is_refused(digits: str, tmp_path: Path) -> None:
    xml = f"<root><data><frame><frame_data>{digits}</frame_data></frame></data></root>"
    (tmp_path / "a.dsa").write_bytes(bz2.compress(xml.encode()))
    with pytest.raises(RecordingError, match=r"a\.dsa"):
        weiss.read(tmp_path / "a.dsa")


def test_what_unpacks_to_too_much_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(weiss, "_UNPACKED_BYTES_MAX", 1000)
    with pytest.raises(RecordingError, match="more than 1000 bytes"):
        weiss.read(weiss_file(tmp_path / "a.dsa", hand(5)))


@given(st.binary(max_size=300), st.booleans())
def test_any_bytes_are_refused_in_words(content: bytes, packed: bool) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a"
        path.write_bytes(bz2.compress(content) if packed else content)
        for read in (weiss.read, insole.read):
            with pytest.raises(RecordingError, match="a"):
                read(path)
