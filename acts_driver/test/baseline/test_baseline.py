# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Baseline and noise of untouched taxels, and the file they are kept in."""

from pathlib import Path
from typing import Any

import baseline_reference
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tracked_skin import COLS, CONFIG, FRAME_NS, ROWS, SIZE, Skin

from acts_core.errors import ArrayError, CalibrationError, SettingsError
from acts_core.frames import SampleFrame, Scheme
from acts_core.skin import layout
from acts_driver.baseline import Baseline, BaselineTracker, baseline_kernels
from acts_driver.baseline.baseline import BaselineSource
from acts_driver.baseline.baseline_tracker import Calibration


@pytest.mark.parametrize("m", [SIZE, 7])
def test_calibration_finds_baseline_and_noise_in_any_scheme(m: int) -> None:
    skin = Skin(m=m)
    skin.field = np.linspace(10, 50, SIZE).reshape(ROWS, COLS)
    skin.field[1, 3] = 700  # a stuck taxel is no touch
    with pytest.raises(CalibrationError, match="0 s of frames so far, a calibration needs 1 s"):
        skin.tracker.calibrate()
    assert skin.tracker.present() is None
    skin.run(2.5)
    baseline = skin.tracker.calibrate().baseline
    assert baseline.valid.all()
    assert np.abs(baseline.counts - skin.field).max() < 1.5
    assert np.median(baseline.noise_counts) == pytest.approx(1.5, rel=0.25)
    assert baseline.source is BaselineSource.CALIBRATION
    assert skin.now_ns - baseline.time_ns <= FRAME_NS


def test_calibration_is_refused_while_touched_and_shortly_after() -> None:
    skin = Skin()
    skin.run(1.5)
    skin.run(0.1, skin.pressed())
    for seconds in (0.0, 0.5):
        skin.run(seconds)
        with pytest.raises(CalibrationError, match="4 taxels, for example row 2, column 2"):
            skin.tracker.calibrate()
    skin.run(1.5)
    skin.tracker.calibrate()
    # An object that stands still is a touch, too.
    skin.run(3.0, skin.pressed())
    with pytest.raises(CalibrationError, match="tare first"):
        skin.tracker.calibrate()


def test_a_pause_of_the_stream_begins_anew() -> None:
    skin = Skin()
    skin.run(1.5)
    skin.now_ns += 3 * 10**9
    skin.run(0.5)
    with pytest.raises(CalibrationError, match="so far"):
        skin.tracker.calibrate()
    skin.now_ns -= 10 * 10**9
    skin.run(1.5)
    assert skin.tracker.calibrate().baseline.valid.all()


def test_of_a_slow_stream_each_frame_counts() -> None:
    skin = Skin(noise=0.0)
    for _ in range(12):
        skin.run(0.01)
        skin.now_ns += 1_000_000_000 - FRAME_NS
    assert skin.tracker.tare().baseline.valid.all()
    with pytest.raises(CalibrationError, match="8 times in the last 1 s: raise the frame rate"):
        skin.tracker.calibrate()


@pytest.mark.parametrize("m", [SIZE, 20])
def test_a_tare_of_few_readings_takes_no_taxel_for_one_without_noise(m: int) -> None:
    """Of a board of one frame a second a tare has two readings at most: they may be equal, and one tells no noise."""
    skin = Skin(noise=6.0, m=m)
    for second in range(12):
        skin.field[5, 4] = 900 * (second % 2)  # one that changes says nothing of the others
        skin.run(0.01)
        skin.now_ns += 1_000_000_000 - FRAME_NS
    baseline = skin.tracker.tare().baseline
    assert baseline.valid.all()
    assert baseline.noise_counts.min() > 4.0
    assert baseline.noise_counts.max() < 8.0
    # As of a calibration it is kept.
    skin.run(1.5)
    assert skin.tracker.tare().baseline.noise_counts.tolist() == baseline.noise_counts.tolist()


def test_taxels_that_are_not_measured_are_not_known() -> None:
    skin = Skin()
    skin.run(1.0)
    frame = SampleFrame(
        0, 0, 0, Scheme.ADAPTIVE, ROWS, COLS, 0, np.arange(3, dtype=np.uint16), np.full(3, 9, np.uint16)
    )
    few = BaselineTracker(ROWS, COLS, CONFIG)
    for i in range(200):
        few.observe([(frame, i * FRAME_NS)])
    baseline = few.calibrate().baseline
    assert baseline.valid.ravel().tolist() == [True] * 3 + [False] * (SIZE - 3)
    assert baseline.counts.ravel().tolist() == [9.0] * 3 + [0.0] * (SIZE - 3)


def test_what_is_of_another_array_is_refused_and_leaves_the_baseline_as_it_was() -> None:
    skin = Skin()
    skin.run(1.0)
    before = skin.tracker.tare().baseline
    row = np.arange(SIZE, dtype=np.uint16)
    whole = SampleFrame(0, 0, 0, Scheme.RASTER, ROWS, COLS, 0, row, row)
    others = {
        "a frame of 64 x 64": whole._replace(rows=64, cols=64),
        f"{SIZE} indices and {SIZE - 1} counts": whole._replace(counts=row[:-1]),
        f"{SIZE - 1} indices and {SIZE} counts": whole._replace(indices=row[:-1]),
    }
    for told, frame in others.items():
        with pytest.raises(ArrayError, match=told):
            skin.tracker.observe([(whole, 10**10), (frame, 10**10 + FRAME_NS)])
    with pytest.raises(ArrayError, match=f"layout of 8 x 4: this baseline is of {ROWS} x {COLS}"):
        skin.tracker.arrange(layout("square", 8, 4))
    counts = np.zeros((8, 4), dtype=np.float32)
    with pytest.raises(ArrayError, match=f"baseline of 8 x 4: this baseline is of {ROWS} x {COLS}"):
        skin.tracker.set(Baseline(counts, counts, counts > 0, BaselineSource.FILE, 0))
    present = skin.tracker.present()
    assert present is not None
    assert present.time_ns == before.time_ns
    assert present.counts.tolist() == before.counts.tolist()


def test_taxels_that_are_not_measured_are_not_told_to_be_calibrated_or_tared() -> None:
    skin = Skin()
    skin.run(2.5)
    assert str(skin.tracker.calibrate()).startswith("calibrated 30 of 30 taxels, noise ")
    skin.m = 1  # one taxel, the same in every frame
    skin.frames = 0
    for _ in range(250):
        skin.run(0.01)
        skin.frames = 0
    told = str(skin.tracker.calibrate())
    assert told.startswith("calibrated 1 of 30 taxels, noise ")
    others = "(median); the other 29 had fewer than 8 readings and stay as they were: the schemes raster and uniform"
    assert told.endswith(f"{others} measure all")
    tare = skin.tracker.tare()
    others = "the other 29 had no reading and stay as they were: the schemes raster and uniform measure all"
    assert str(tare) == f"tared 1 of 30 taxels; {others}"
    assert tare.baseline.valid.all()


def test_what_is_known_of_another_skin_can_be_left_out_of_a_tare_and_of_a_calibration() -> None:
    for determine in (BaselineTracker.tare, BaselineTracker.calibrate):
        skin = Skin()
        skin.run(2.5)
        skin.tracker.calibrate()
        # Another skin, of which one taxel is measured; the one before read 20 there, which is no touch of this one.
        skin.field[:] = 70.0
        skin.m = 1
        skin.frames = 0
        for _ in range(250):
            skin.run(0.01)
            skin.frames = 0
        determined = determine(skin.tracker, keeps_others=False)
        few = "fewer than 8 readings" if isinstance(determined, Calibration) else "no reading"
        assert f"; the other 29 had {few} and have no baseline: the schemes raster and uniform" in str(determined)
        baseline = determined.baseline
        assert baseline.valid.ravel().tolist() == [True] + [False] * (SIZE - 1)
        assert baseline.counts[0, 0] == pytest.approx(70.0, abs=1.5)
        assert not baseline.counts.ravel()[1:].any()
        assert baseline.noise_counts[0, 0] == pytest.approx(1.5, rel=0.25)


def test_tare_takes_what_lies_on_the_skin_for_zero() -> None:
    skin = Skin()
    with pytest.raises(CalibrationError, match=r"less than 0\.2 s"):
        skin.tracker.tare()
    skin.run(2.0)
    noise = skin.tracker.calibrate().baseline.noise_counts
    skin.run(1.0, skin.pressed())
    tare = skin.tracker.tare()
    assert str(tare) == "tared 30 of 30 taxels"
    tared = tare.baseline
    assert np.abs(tared.counts - skin.pressed()).max() < 2
    assert (tared.noise_counts == noise).all()
    assert tared.source is BaselineSource.TARE
    # Taken away, the object leaves taxels that read below zero; that is no drift.
    assert skin.tracker.below() == 0
    skin.run(10.0)
    present = skin.tracker.present()
    assert present is not None
    assert np.abs(present.counts[2:4, 2:4] - 420).max() < 2
    assert skin.tracker.below() == 4


def test_a_tare_is_of_the_last_readings_alone() -> None:
    """Of 0.2 to 0.4 s, as soon as there are so many."""
    skin = Skin(noise=0.0)
    skin.run(0.21)
    assert skin.tracker.tare().measured == SIZE
    skin.run(1.79)
    skin.run(0.4, skin.pressed())
    tare = skin.tracker.tare()
    assert tare.unsteady == 0
    assert (tare.baseline.counts == skin.pressed()).all()


def test_taxels_that_were_not_measured_lately_are_not_told_to_read_low() -> None:
    skin = Skin()
    skin.field += 100
    skin.run(2.0)
    skin.tracker.tare()
    skin.field -= 100
    skin.m = 1  # one taxel, the same in every frame
    for _ in range(50):
        skin.frames = 0
        skin.run(0.01)
    assert skin.tracker.below() == 1


def test_a_tare_tells_what_moved_meanwhile() -> None:
    skin = Skin()
    skin.run(2.0)
    skin.run(0.1, skin.pressed())
    skin.run(0.1)
    told = "tared 30 of 30 taxels, but 4 of them changed meanwhile: keep what lies on the skin still and tare again"
    assert str(skin.tracker.tare()) == told
    skin.run(0.5)
    assert skin.tracker.tare().unsteady == 0
    # A single taxel that jumps is broken.
    broken = skin.field.copy()
    broken[1, 1] = 500
    skin.run(0.1, broken)
    assert skin.tracker.tare().unsteady == 0


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans(), st.integers(1, 8), st.integers(1, 8))
def test_kernel_equals_reference(seed: int, is_tracking: bool, rows: int, cols: int) -> None:
    rng = np.random.default_rng(seed)
    size = rows * cols

    def state() -> list[Any]:
        return [
            np.zeros(size, dtype=np.int64),
            np.zeros((size, 2)),
            np.tile(np.array([1024, -1]), (size, 1)),
            baseline.copy(),
            freeze,
            np.zeros(size, dtype=np.int64),
            np.zeros(size, dtype=np.int64),
        ]

    baseline = rng.uniform(0, 60, size)
    freeze = np.where(rng.random(size) < 0.2, -1, 20).astype(np.float32)
    neighbours = rng.integers(-1, size, (size, 8)).astype(np.int32)
    one, other = state(), state()
    for frame in range(6):
        indices = rng.permutation(size)[: rng.integers(0, size + 1)].astype(np.uint16)
        counts = rng.integers(0, 90, len(indices)).astype(np.uint16)
        rest: list[Any] = [is_tracking, 2e9, 150_000_000, 0.05]
        baseline_kernels.observe(indices, counts, frame * 10**8, neighbours, *one, *rest)
        baseline_reference.observe(indices, counts, frame * 10**8, neighbours, *other, *rest)
    for mine, reference in zip(one, other, strict=True):
        assert np.allclose(mine, reference, rtol=1e-5, atol=1e-5)


def some_baseline() -> Baseline:
    rng = np.random.default_rng(1)
    counts = rng.uniform(0, 40, (ROWS, COLS)).astype(np.float32)
    return Baseline(
        counts, counts / np.float32(20), rng.random((ROWS, COLS)) < 0.9, BaselineSource.CALIBRATION, 5, 2**64 - 1
    )


def test_a_file_keeps_the_baseline(tmp_path: Path) -> None:
    path = tmp_path / "new folder" / "skin.npz"
    baseline = some_baseline()
    baseline.save(path)
    baseline.save(path)
    assert [entry.name for entry in path.parent.iterdir()] == ["skin.npz"]
    again = Baseline.load(path, ROWS, COLS)
    assert (again.counts == baseline.counts).all()
    assert (again.noise_counts == baseline.noise_counts).all()
    assert (again.valid == baseline.valid).all()
    assert (again.source, again.time_ns, again.board_id) == (BaselineSource.FILE, baseline.time_ns, baseline.board_id)
    tracker = BaselineTracker(ROWS, COLS)
    tracker.set(again)
    present = tracker.present()
    assert present is not None
    assert (present.counts == np.where(baseline.valid, baseline.counts, 0)).all()


def test_files_that_are_no_baseline_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "skin.npz"
    with pytest.raises(SettingsError, match="cannot be read"):
        Baseline.load(path, ROWS, COLS)
    some_baseline().save(path)
    with pytest.raises(SettingsError, match="6 x 5 taxels, the array has 5 x 6"):
        Baseline.load(path, COLS, ROWS)
    whole = path.read_bytes()
    for damaged in (b"", b"words", whole[: len(whole) // 2]):
        path.write_bytes(damaged)
        with pytest.raises(SettingsError, match="again"):
            Baseline.load(path, ROWS, COLS)
    numbers: dict[str, Any] = {
        "format": "acts_baseline",
        "version": 1,
        "valid": np.ones((ROWS, COLS), bool),
        "time_ns": 0,
    }
    for wrong in (np.full((ROWS, COLS), 1e300), np.full((ROWS, COLS), 1 + 2j)):
        np.savez(path, baseline=wrong, noise=wrong, **numbers)
        with pytest.raises(SettingsError, match="no baseline, or a damaged one"):
            Baseline.load(path, ROWS, COLS)
    np.savez(path, frames=np.zeros(3))
    with pytest.raises(SettingsError, match="no baseline, or a damaged one"):
        Baseline.load(path, ROWS, COLS)
    with pytest.raises(SettingsError, match="it lacks baseline;"):
        Baseline.load(path, ROWS, COLS)
    # Below a file, and under names that are too long, with what is added to them until they are whole: or without.
    for where in (Path("/proc/skin.npz"), path / "skin.npz", tmp_path / ("a" * 250), tmp_path / ("a" * 300)):
        with pytest.raises(SettingsError, match="cannot be saved"):
            some_baseline().save(where)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        *(("time_ns", value, "time_ns = .* a time lies between 0") for value in (-1, 2**31 * 10**9, 1e300)),
        *(("time_ns", value, "cannot convert float") for value in (np.inf, np.nan)),
        ("board_id", -1, "board_id = -1: a serial number"),
        ("board_id", np.nan, "cannot convert float"),
        ("version", np.inf, "cannot convert float"),
        ("valid", np.full((ROWS, COLS), np.nan), "Cannot cast"),
    ],
)
def test_damaged_values_beside_the_counts_are_refused(tmp_path: Path, name: str, value: object, words: str) -> None:
    path = tmp_path / "skin.npz"
    some_baseline().save(path)
    with np.load(path) as arrays:
        content = dict(arrays)
    np.savez(path, **{**content, name: value})
    with pytest.raises(SettingsError, match=f"a damaged one .{words}.*; calibrate again"):
        Baseline.load(path, ROWS, COLS)


def test_a_file_of_an_older_release_has_no_board(tmp_path: Path) -> None:
    path = tmp_path / "skin.npz"
    some_baseline().save(path)
    with np.load(path) as arrays:
        content = dict(arrays)
    del content["board_id"]
    np.savez(path, **content)
    assert Baseline.load(path, ROWS, COLS).board_id == 0


@pytest.mark.parametrize("value", [np.nan, -1.0, 1024.0])
def test_impossible_values_are_refused(value: float) -> None:
    counts = np.full((ROWS, COLS), value, dtype=np.float32)
    with pytest.raises(ArrayError, match="between 0 and 1023"):
        Baseline(counts, np.zeros_like(counts), counts > 0, BaselineSource.TARE, 0)
