# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Recordings that somebody damaged or made up: they are replayed, or refused by name, and nothing else is raised."""

from __future__ import annotations

import io
import struct
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pty_board import frame
from recorded import write_bag

from acts_core.errors import RecordingError
from acts_core.sampling import SamplingConfig
from acts_driver.replay import ReplayOptions, ReplaySource, open_recording

pytestmark = pytest.mark.slow

FRAMES = 12
KINDS = ("samples.npz", "frames.npz", "bag.mcap")
STRANGE: tuple[Any, ...] = (
    np.zeros(0),
    np.array("text"),
    np.array(True),
    np.array(1 + 2j),
    np.array([np.nan]),
    np.array(5e-324),
    np.array(1e308),
    np.array(-1),
    np.array(2**63 - 1),
    np.array(np.datetime64("2026-11-23")),
    np.zeros((2, 2), [("a", "i4")]),
    np.zeros((2, 2, 2, 2)),
    np.full((FRAMES, 5), -1),
    np.full((FRAMES, 5), 2**63, np.uint64),
    np.full((FRAMES, 8, 8), np.inf),
    np.arange(FRAMES)[::-1],
)


def written(folder: Path) -> dict[str, tuple[bytes, dict[str, Any]]]:
    """The bytes of a good file of each kind, and the arrays of the npz files."""
    sent = [frame(k) for k in range(FRAMES)]
    samples = {"indices": [one.indices for one in sent], "counts": [one.counts for one in sent], "rate_hz": 1000.0}
    full = {"frames": np.arange(FRAMES * 64, dtype=np.uint16).reshape(FRAMES, 8, 8), "rate_hz": 100.0}
    bag = write_bag(folder / "bag", {"/plate/samples": [(one, 1_000_000 * one.board_us) for one in sent]})
    return {
        "samples.npz": (packed(samples), samples),
        "frames.npz": (packed(full), full),
        "bag.mcap": (next(bag.glob("*.mcap")).read_bytes(), {}),
    }


def packed(arrays: dict[str, Any]) -> bytes:
    file = io.BytesIO()
    np.savez_compressed(file, **arrays)
    return file.getvalue()


PLACES = st.floats(0.0, 1.0, exclude_max=True)
CHANGES = st.lists(
    st.one_of(
        st.tuples(st.just("flip"), PLACES, st.integers(0, 7)),
        st.tuples(st.just("cut"), PLACES, PLACES),
        st.tuples(st.just("end"), PLACES, st.none()),
        st.tuples(st.just("put"), PLACES, st.binary(max_size=8) | st.just(b"\xff" * 8)),
    ),
    max_size=4,
)
ARRAYS = st.dictionaries(
    st.sampled_from(
        ["indices", "counts", "frames", "rate_hz", "stamp_ns", "sequence", "rows", "scheme", "duration_us"]
    ),
    st.sampled_from(range(len(STRANGE))),
    max_size=2,
)


def damaged(data: bytes, changes: list[tuple[str, float, Any]]) -> bytes:
    changed = bytearray(data)
    for what, place, value in changes:
        at = int(place * len(changed))
        if what == "flip" and changed:
            changed[at] ^= 1 << value
        elif what == "cut":
            del changed[at : at + int(value * 50)]
        elif what == "end":
            del changed[at:]
        elif what == "put":
            changed[at : at + len(value)] = value
    return bytes(changed)


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[bytes, dict[str, Any]]]:
    return written(tmp_path_factory.mktemp("good"))


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(KINDS), CHANGES, ARRAYS, st.sampled_from([0.001, 1.0, 1000.0]))
def test_any_file_is_replayed_or_refused_by_name(
    good: dict[str, tuple[bytes, dict[str, Any]]],
    tmp_path: Path,
    kind: str,
    changes: list[tuple[str, float, Any]],
    strange: dict[str, int],
    speed: float,
) -> None:
    data, arrays = good[kind]
    if arrays and strange:
        data = packed(arrays | {name: STRANGE[number] for name, number in strange.items()})
    path = tmp_path / kind
    path.write_bytes(damaged(data, changes))
    options = ReplayOptions(path, sampling=lambda rows, cols: SamplingConfig(rows=rows, cols=cols, m=1))
    told = kind
    try:
        recording = open_recording(options)
        assert recording.length_us >= 0
        assert len(list(islice(recording.frames(), 2 * FRAMES))) <= 2 * FRAMES
        # The bytes of the first frames are made as well.
        source = ReplaySource(str(path), lambda: recording, speed=speed)
        source.open()
        source.close()
    except RecordingError as error:
        told = str(error)
    assert kind in told


def test_a_bag_with_a_stamp_of_more_nanoseconds_than_a_second_has(
    good: dict[str, tuple[bytes, dict[str, Any]]], tmp_path: Path
) -> None:
    data, _ = good["bag.mcap"]
    # Of the sixth message: seconds and nanoseconds.
    seconds, nanoseconds = divmod(1_000_000 * frame(5).board_us, 10**9)
    stamp = struct.pack("<iI", seconds, nanoseconds)
    assert data.count(stamp) == 1
    path = tmp_path / "bag.mcap"
    path.write_bytes(data.replace(stamp, struct.pack("<iI", seconds, 2 * 10**9)))
    read = open_recording(ReplayOptions(path)).frames()
    assert len(list(islice(read, 5))) == 5
    with pytest.raises(RecordingError, match=r"message 5 of /plate/samples in '.*bag.mcap' .* a second has"):
        next(read)


def test_a_bag_whose_metadata_say_that_it_ends_before_it_begins(
    good: dict[str, tuple[bytes, dict[str, Any]]], tmp_path: Path
) -> None:
    data, _ = good["bag.mcap"]
    path = tmp_path / "bag.mcap"
    path.write_bytes(data)
    length_us = open_recording(ReplayOptions(path)).length_us
    # As the recorder saw it, see write_bag.
    first_ns, last_ns = (1_000_000 * frame(number).board_us + 5_000_000 for number in (0, FRAMES - 1))
    span = struct.pack("<QQ", first_ns, last_ns)
    # The statistics stand behind the chunks and their index.
    before, found, after = data.rpartition(span)
    assert found
    path.write_bytes(before + struct.pack("<QQ", last_ns, first_ns) + after)
    assert open_recording(ReplayOptions(path)).length_us == length_us == (last_ns - first_ns) // 1000
