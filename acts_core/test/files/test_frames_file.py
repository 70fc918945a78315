# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Files of recorded frames, as other people write them."""

from __future__ import annotations

import tracemalloc
import warnings
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from numpy.typing import NDArray

from acts_core.errors import RecordingError
from acts_core.files import FramesFile, load_frames

pytestmark = pytest.mark.slow

FRAMES = np.zeros((6, 4, 5), dtype=np.uint16)
FRAMES[[1, 4]] = 7


def loaded(path: Path, *, labels: bool = True, **arrays: Any) -> FramesFile:
    np.savez(path / "f.npz", **{"frames": FRAMES, **arrays})
    # A warning of NumPy's would be a surprise that nobody turned into a message.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return load_frames(path / "f.npz", labels=labels)


def test_what_a_file_does_not_say(tmp_path: Path) -> None:
    file = loaded(tmp_path)
    assert file.live.all()
    assert file.rate_hz is None
    assert file.label == ()
    assert (file.start.tolist(), file.length.tolist()) == ([0], [6])


def test_the_strongest_frame_of_each_recording(tmp_path: Path) -> None:
    file = loaded(tmp_path, start=[0, 3], length=[3, 3])
    assert file.peak_frames().tolist() == FRAMES[[1, 4]].tolist()
    # A value where no taxel is does not count, and sums do not overflow.
    frames = np.full((3, 64, 64), 1023, dtype=np.uint16)
    frames[0, 1, 1] -= 1
    frames[2, 1, 1] -= 2
    frames[:, 0, 0] = [0, 0, 1000]
    live = np.ones((64, 64), dtype=bool)
    live[0, 0] = False
    assert loaded(tmp_path, frames=frames, live=live).peak_frames().tolist() == frames[[1]].tolist()


@pytest.mark.parametrize("kind", ["u1", "i1", "u2", ">u2", "i4", "u8", "f2", "f4", "f8"])
def test_any_kind_of_number_is_a_count(tmp_path: Path, kind: str) -> None:
    file = loaded(tmp_path, frames=FRAMES.astype(kind))
    assert file.frames.dtype == np.uint16
    np.testing.assert_array_equal(file.frames, FRAMES)


def test_fractions_are_rounded_and_any_order_in_memory_is_read(tmp_path: Path) -> None:
    np.testing.assert_array_equal(loaded(tmp_path, frames=FRAMES + 0.4).frames, FRAMES)
    file = loaded(tmp_path, frames=np.asfortranarray(FRAMES))
    assert file.frames.flags.c_contiguous
    np.testing.assert_array_equal(file.frames, FRAMES)


@pytest.mark.parametrize(("kind", "order"), [(np.uint8, "C"), (np.float16, "C"), (np.uint16, "F")])
def test_frames_that_would_fill_the_memory_while_they_are_converted_are_refused(
    tmp_path: Path, kind: type[np.generic], order: Literal["C", "F"]
) -> None:
    path = tmp_path / "f.npz"
    frames = np.zeros((1000, 4, 5), dtype=kind, order=order)
    np.savez(path, frames=frames)
    with pytest.raises(RecordingError, match=r"take 0 MB while they become uint16; .*save them as uint16"):
        load_frames(path, limit_bytes=frames.nbytes + 1000)
    assert load_frames(path, limit_bytes=100_000).frames.shape == frames.shape
    np.savez(path, frames=frames.astype(np.uint16, order="C"))
    assert load_frames(path, limit_bytes=41_000).frames.shape == frames.shape


@pytest.mark.parametrize("rate_hz", [31, 31.0, np.float32(31), [31], [[31.0]], np.uint64(31)])
def test_one_number_of_any_shape_is_a_rate(tmp_path: Path, rate_hz: Any) -> None:
    assert loaded(tmp_path, rate_hz=rate_hz).rate_hz == 31


@pytest.mark.parametrize("kind", [bool, np.uint8, float])
def test_live_taxels_in_any_kind(tmp_path: Path, kind: type) -> None:
    live = np.indices((4, 5)).sum(axis=0) % 2 == 0
    np.testing.assert_array_equal(loaded(tmp_path, live=live.astype(kind)).live, live)


def test_recordings_may_overlap_and_their_numbers_be_floats(tmp_path: Path) -> None:
    file = loaded(tmp_path, start=[0.0, 2.0], length=[4.0, 4.0])
    assert (file.start.tolist(), file.length.tolist()) == ([0, 2], [4, 4])


def test_recordings_are_found_by_either_pair_of_names(tmp_path: Path) -> None:
    file = loaded(tmp_path, rec_start=[0, 4], rec_len=[4, 2], label=["a", "b"])
    assert (file.start.tolist(), file.length.tolist(), file.label) == ([0, 4], [4, 2], ("a", "b"))
    file = loaded(tmp_path, start=[1], length=[2], rec_start=[0, 4], rec_len=[4, 2])
    assert (file.start.tolist(), file.length.tolist()) == ([1], [2])


def test_labels_are_words_or_numbers_and_read_only_when_asked_for(tmp_path: Path) -> None:
    assert loaded(tmp_path, start=[0, 2], length=[2, 4], label=[7, 10]).label == ("7", "10")
    assert loaded(tmp_path, label="cup").label == ("cup",)
    for label in (["a", "b", "c"], np.array([{}])):
        assert loaded(tmp_path, labels=False, label=label).label == ()


def test_recordings_without_frames_are_left_out(tmp_path: Path) -> None:
    file = loaded(tmp_path, start=[0, 2, 6], length=[2, 4, 0], label=["a", "b", "c"])
    assert (file.start.tolist(), file.length.tolist(), file.label) == ([0, 2], [2, 4], ("a", "b"))
    for start, length in (([], []), ([3], [0])):
        with pytest.raises(RecordingError, match="no recording has a frame"):
            loaded(tmp_path, start=np.array(start, dtype=int), length=np.array(length, dtype=int))


@pytest.mark.parametrize(
    ("arrays", "words"),
    [
        ({"frames": FRAMES[0]}, r"frames \(4, 5\), uint16: needed are numbers"),
        ({"frames": FRAMES[:0]}, "needed are numbers"),
        ({"frames": FRAMES[:, :0]}, "needed are numbers"),
        ({"frames": FRAMES > 0}, "bool: needed are numbers"),
        ({"frames": FRAMES.astype(complex)}, "complex128: needed are numbers"),
        ({"frames": np.full((1, 4, 5), "7")}, "needed are numbers"),
        ({"frames": np.full((1, 4, 5), np.nan)}, "without NaN"),
        ({"frames": np.full((1, 4, 5), np.inf)}, "between 0 and 1023"),
        ({"frames": np.full((1, 4, 5), 1024)}, "hold 1024 to 1024; they must lie between 0 and 1023"),
        ({"frames": np.full((1, 4, 5), -1)}, "hold -1 to -1.*set to 0 what is below"),
        ({"frames": np.where(np.arange(6)[:, None, None] == 2, np.nan, FRAMES)}, "leave out frames that hold NaN"),
        ({"live": np.zeros((4, 5), dtype=bool)}, "no taxel is live"),
        ({"rec_start": [4], "rec_len": [3]}, "within 6 frames: the one numbered 0 starts at 4 and has 3"),
        ({"live": np.ones(3)}, r"live \(3,\) does not fit"),
        ({"live": np.full((4, 5), np.nan)}, "needed are true and false"),
        ({"live": np.full((4, 5), "yes")}, "needed are true and false"),
        ({"start": [4], "length": [3]}, "within 6 frames: the one numbered 0 starts at 4 and has 3"),
        ({"start": [0, 9], "length": [3, 1]}, "the one numbered 1 starts at 9"),
        ({"start": [-1], "length": [3]}, "starts at -1"),
        ({"start": [0], "length": [-3]}, "has -3"),
        ({"start": [2**62], "length": [2**62]}, "start and length do not mark"),
        ({"start": np.array([2**64 - 1], dtype=np.uint64), "length": [2]}, "start and length do not mark"),
        ({"start": [0, 3]}, "start has 2 numbers, length 1"),
        ({"start": [[0], [3]], "length": [[3], [3]]}, r"start \(2, 1\), int64: needed is one whole number"),
        ({"start": ["a"], "length": [3]}, "needed is one whole number"),
        ({"start": [np.nan], "length": [3.0]}, "needed is one whole number"),
        ({"start": [0], "length": [2.5]}, r"length \(1,\), float64: needed is one whole number"),
        ({"rate_hz": 0.0}, "rate_hz = 0.0"),
        ({"rate_hz": -3}, "one positive number"),
        ({"rate_hz": np.nan}, "one positive number"),
        ({"rate_hz": 1e-9}, r"rate_hz = 1e-09 frames per second; allowed are 0.001 to 1e\+06"),
        ({"rate_hz": 1e9}, r"allowed are 0.001 to 1e\+06"),
        ({"rate_hz": "31"}, "one positive number"),
        ({"rate_hz": [31, 31]}, "one positive number"),
        ({"rate_hz": np.zeros(0)}, "one positive number"),
        ({"label": ["a", "b"]}, r"label \(2,\), <U1: needed is a text or a whole number for each of 1"),
        ({"label": [0.5]}, "needed is a text or a whole number"),
        ({"label": np.array([{}])}, r"label is an array of Python objects, .* such as label.astype\(str\)"),
    ],
)
def test_what_does_not_fit_is_refused(tmp_path: Path, arrays: dict[str, Any], words: str) -> None:
    with pytest.raises(RecordingError, match=words):
        loaded(tmp_path, **arrays)


def test_files_without_frames_are_refused(tmp_path: Path) -> None:
    np.savez(tmp_path / "f.npz", other=FRAMES)
    with pytest.raises(RecordingError, match="array `frames`"):
        load_frames(tmp_path / "f.npz")
    (tmp_path / "f.npz").write_bytes(b"nothing")
    with pytest.raises(RecordingError, match="not an npz file"):
        load_frames(tmp_path / "f.npz")


@pytest.mark.parametrize(("kind", "copies"), [("u2", 1.0), ("f4", 1.5)])
def test_a_long_recording_is_held_once(tmp_path: Path, kind: str, copies: float) -> None:
    frames: NDArray = np.zeros((20000, 32, 32), dtype=kind)
    np.savez_compressed(tmp_path / "f.npz", frames=frames)
    tracemalloc.start()
    try:
        load_frames(tmp_path / "f.npz")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # In bytes of the file's own array; reading and rounding work in pieces.
    assert peak < (copies + 0.25) * frames.nbytes
