# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Exports of npz recordings; the real ones are measured where they are at hand."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.errors import RecordingError
from acts_core.files import export_recording

pytestmark = pytest.mark.slow


def evaluation(path: Path, **changes: object) -> Path:
    content: dict[str, Any] = {
        "frames": np.arange(6 * 4 * 5).reshape(6, 4, 5).astype(np.uint16),
        "rate_hz": np.float64(31.0),
        "start": np.array([0, 2, 4]),
        "length": np.array([2, 2, 2]),
        "label": np.array(["mug", "can", "mug"]),
        "live": np.ones((4, 5), dtype=bool),
    }
    content.update(changes)
    np.savez(path, **{name: value for name, value in content.items() if value is not None})
    return path


def figures(path: Path, **changes: object) -> Path:
    frames = np.full((3, 4, 4), 7.6, dtype=np.float32)
    frames[0, 0] = -10
    content: dict[str, Any] = {
        "frames": frames,
        "measured": frames >= 0,
        "names": np.array(["a", "b", "c"]),
        "kind": np.array(["raw", "reconstruction", "full_raster"]),
    }
    content.update(changes)
    np.savez(path, **content)
    return path


@pytest.fixture
def out(tmp_path: Path) -> Path:
    return tmp_path / "out.npy"


def test_a_whole_file_comes_out_as_it_is(tmp_path: Path, out: Path) -> None:
    exported = export_recording(evaluation(tmp_path / "in.npz"), out)
    frames = np.load(out)
    assert frames.dtype == np.uint16
    assert frames.flags.c_contiguous
    np.testing.assert_array_equal(frames, np.arange(120).reshape(6, 4, 5))
    assert (exported.frames, exported.rows, exported.cols, exported.rate_hz) == (6, 4, 5, 31.0)
    assert exported.labels == ("mug", "can", "mug")


def test_the_header_of_the_npy_file_is_the_plain_one(tmp_path: Path, out: Path) -> None:
    export_recording(evaluation(tmp_path / "in.npz"), out)
    header = out.read_bytes()[:128]
    assert header[:8] == b"\x93NUMPY\x01\x00"
    assert b"'descr': '<u2', 'fortran_order': False, 'shape': (6, 4, 5), }" in header
    assert out.stat().st_size == 128 + 240


@pytest.mark.parametrize(
    ("choice", "wanted"),
    [
        ({"recordings": [2, 0]}, [4, 5, 0, 1]),
        ({"label": "mug"}, [0, 1, 4, 5]),
        ({"label": "mug", "recordings": [1, 2]}, [4, 5]),
        ({"max_frames": 3}, [0, 1, 2]),
        ({"recordings": [1], "repeat": 2}, [2, 2, 3, 3]),
    ],
)
def test_recordings_are_selected(tmp_path: Path, out: Path, choice: dict, wanted: list[int]) -> None:
    export_recording(evaluation(tmp_path / "in.npz"), out, **choice)
    np.testing.assert_array_equal(np.load(out), np.arange(120).reshape(6, 4, 5)[wanted])


@pytest.mark.parametrize(
    ("max_frames", "labels"), [(1, ("mug",)), (2, ("mug",)), (3, ("mug", "can")), (9, ("mug", "can", "mug"))]
)
def test_labels_are_those_of_the_frames_that_are_written(
    tmp_path: Path, out: Path, max_frames: int, labels: tuple[str, ...]
) -> None:
    assert export_recording(evaluation(tmp_path / "in.npz"), out, max_frames=max_frames).labels == labels


def test_a_file_without_recordings_is_one(tmp_path: Path, out: Path) -> None:
    path = evaluation(tmp_path / "in.npz", start=None, length=None, label=None, live=None)
    assert export_recording(path, out).labels == ()
    assert len(np.load(out)) == 6


def test_files_are_read_as_load_frames_reads_them(tmp_path: Path, out: Path) -> None:
    numbers = {"start": None, "length": None, "rec_start": np.array([0.0, 2.0]), "rec_len": np.array([2.0, 4.0])}
    path = evaluation(tmp_path / "in.npz", label=None, **numbers)
    export_recording(path, out, recordings=[1])
    np.testing.assert_array_equal(np.load(out), np.arange(120).reshape(6, 4, 5)[2:])
    with pytest.raises(RecordingError, match=r"allowed are 0.001 to 1e\+06"):
        export_recording(evaluation(tmp_path / "in.npz", rate_hz=1e9), out)


def test_frames_have_the_name_that_an_export_of_a_bag_gives_them(tmp_path: Path, out: Path) -> None:
    image = np.arange(120, dtype=np.uint16).reshape(6, 4, 5)
    export_recording(evaluation(tmp_path / "in.npz", frames=None, image=image), out)
    np.testing.assert_array_equal(np.load(out), image)
    with pytest.raises(RecordingError, match=r"'rate_hz'.*; add it, or export the bag again with --rate 100"):
        export_recording(evaluation(tmp_path / "in.npz", frames=None, rate_hz=None, image=image), out)


def test_single_frames_are_rounded(tmp_path: Path, out: Path) -> None:
    exported = export_recording(figures(tmp_path / "in.npz"), out, kind="full_raster", repeat=3)
    np.testing.assert_array_equal(np.load(out), np.full((3, 4, 4), 8))
    assert exported.labels == ("c",)
    assert len(export_recording(figures(tmp_path / "in.npz"), out, recordings=[2, 1], max_frames=1).labels) == 1
    export_recording(figures(tmp_path / "in.npz"), out, recordings=[2, 1])
    assert len(np.load(out)) == 2


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"frames": None}, "has no array 'frames'"),
        ({"rate_hz": None}, "has no array 'rate_hz'"),
        ({"rate_hz": np.float64("nan")}, "one positive number"),
        ({"rate_hz": np.array([1.0, 2.0])}, "one positive number"),
        ({"frames": np.zeros((6, 20), dtype=np.uint16)}, r"needed is \(n, rows, cols\)"),
        ({"frames": np.zeros((6, 65, 4), dtype=np.uint16)}, r"needed is \(n, rows, cols\)"),
        ({"frames": np.full((6, 4, 5), 1024, dtype=np.uint16)}, "allowed are 0 to 1023"),
        ({"frames": np.full((6, 4, 5), -1, dtype=np.int16)}, "allowed are 0 to 1023"),
        ({"frames": np.full((6, 4, 5), np.nan)}, "NaN or infinity"),
        ({"frames": np.full((6, 4, 5), "x")}, "needed are counts"),
        ({"frames": np.full((6, 4, 5), None)}, r"frames is an array of Python objects, .*such as frames.astype\(str\)"),
        ({"frames": np.zeros((0, 4, 5), dtype=np.uint16), "start": None, "length": None, "label": None}, "no frames"),
        ({"length": np.array([2, 2, 3])}, "reach beyond the 6 frames"),
        ({"start": np.array([-1, 2, 4])}, "reach beyond the 6 frames"),
        ({"start": np.array([0, 2])}, "one for every recording"),
        ({"label": np.array(["mug"])}, "needed is one for each"),
    ],
)
def test_a_bad_file_is_refused_and_writes_nothing(
    tmp_path: Path, out: Path, changes: dict[str, object], message: str
) -> None:
    with pytest.raises(RecordingError, match=message):
        export_recording(evaluation(tmp_path / "in.npz", **changes), out)
    assert not out.exists()


@pytest.mark.parametrize(
    ("choice", "message"),
    [
        ({"recordings": [3]}, "no number 3 among 3 recordings"),
        ({"recordings": [-1]}, "no number -1"),
        ({"recordings": []}, "no frames are selected"),
        ({"label": "cup"}, "nothing is called 'cup'; there are can, mug"),
        ({"kind": "raw"}, "no kind of frames"),
        ({"repeat": 0}, "allowed is 1 or more"),
        ({"max_frames": 0}, "allowed is 1 or more"),
    ],
)
def test_a_choice_of_nothing_is_refused(tmp_path: Path, out: Path, choice: dict, message: str) -> None:
    with pytest.raises(RecordingError, match=message):
        export_recording(evaluation(tmp_path / "in.npz"), out, **choice)
    assert not out.exists()


@pytest.mark.parametrize(
    ("changes", "choice", "message"),
    [
        ({}, {}, "some of the frames are subsampled"),
        ({}, {"kind": "video"}, "no frame of kind 'video'"),
        ({"measured": np.ones((3, 4, 5), dtype=bool)}, {}, "measured of shape"),
        ({"measured": np.zeros((3, 4, 4), dtype=[("a", int)])}, {}, "needed is true or false"),
        ({"kind": np.array(["raw"])}, {}, "needed is one for each"),
        ({"measured": np.ones((3, 4, 4), dtype=bool)}, {"label": "a"}, "allowed are 0 to 1023"),
    ],
)
def test_bad_single_frames_are_refused(
    tmp_path: Path, out: Path, changes: dict[str, object], choice: dict, message: str
) -> None:
    with pytest.raises(RecordingError, match=message):
        export_recording(figures(tmp_path / "in.npz", **changes), out, **choice)


def test_paths_that_do_not_work_are_refused(tmp_path: Path, out: Path) -> None:
    with pytest.raises(RecordingError, match="cannot be read"):
        export_recording(tmp_path / "missing.npz", out)
    np.save(tmp_path / "single.npy", np.zeros((2, 4, 4), dtype=np.uint16))
    with pytest.raises(RecordingError, match="not an npz file"):
        export_recording(tmp_path / "single.npy", out)
    with pytest.raises(RecordingError, match="its folder must exist"):
        export_recording(evaluation(tmp_path / "in.npz"), tmp_path / "missing" / "out.npy")


@settings(max_examples=40, deadline=None)
@given(content=st.binary(max_size=200), cut=st.integers(0, 2000), flip=st.integers(0, 2000))
def test_garbage_and_cut_files_are_refused_or_read(
    tmp_path_factory: pytest.TempPathFactory, content: bytes, cut: int, flip: int
) -> None:
    folder = tmp_path_factory.mktemp("recording")
    whole = evaluation(folder / "in.npz").read_bytes()
    damaged = bytearray(whole[:cut] if cut % 2 else whole)
    if damaged:
        damaged[flip % len(damaged)] ^= 0x55
    for number, data in enumerate((content, bytes(damaged))):
        path = folder / f"{number}.npz"
        path.write_bytes(data)
        try:
            export_recording(path, folder / "out.npy")
        except RecordingError:
            continue
        assert np.load(folder / "out.npy").max() <= 1023


def test_real_grasps_are_exported(out: Path, recording_path: Callable[[str], Path]) -> None:
    path = recording_path("sdh_weiss/grasps_canvas.npz")
    exported = export_recording(path, out, recordings=[0, 5])
    with np.load(path) as archive:
        start, length = archive["start"], archive["length"]
        wanted = np.concatenate([archive["frames"][start[i] : start[i] + length[i]] for i in (0, 5)])
    np.testing.assert_array_equal(np.load(out), wanted)
    assert exported.rate_hz == 31.0
    assert (exported.rows, exported.cols) == (32, 32)


def test_real_figures_are_exported(out: Path, recording_path: Callable[[str], Path]) -> None:
    path = recording_path("paper/frames.npz")
    exported = export_recording(path, out, kind="full_raster")
    assert (exported.frames, exported.labels) == (1, ("fig5__FR_twoPole",))
    export_recording(path, out, kind="reconstruction")
    assert np.load(out).shape == (18, 32, 32)
