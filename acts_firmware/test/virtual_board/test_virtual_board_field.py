# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the virtual board measures: the simulated world's ring or a recording, each taxel at its own time."""

import os
import select
import subprocess
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from board_process import DEADLINE_S, BoardProcess
from core_library import installed
from numpy.typing import NDArray
from waiting import wait_for

from acts_core.frames import SampleFrame
from acts_core.wire import BoardMessage, Reply, StreamDecoder, encode_query
from acts_sim.shared import TimedRingWriter

ROWS, COLS = 6, 5
TAXELS = ROWS * COLS
SAMPLE_NS = 20_000
SMALL = ("--rows", ROWS, "--cols", COLS, "--m", 20, "--scheme", "random", "--sample-us", 20, "--noise-counts", 0)


@contextmanager
def pressed(ring: Path, field: NDArray[np.float64]) -> Iterator[TimedRingWriter]:
    """A world that writes one field [shape=(n,)] every 10 ms, killed at the end of the block: its file stays."""
    writer = TimedRingWriter(ring, len(field), slots=8)
    writer.write(time.monotonic_ns(), field)
    ended = threading.Event()

    def run() -> None:
        while not ended.wait(0.01):
            writer.write(time.monotonic_ns(), field)

    world = threading.Thread(target=run)
    world.start()
    try:
        yield writer
    finally:
        ended.set()
        world.join()


def is_all(counts: float, frame: SampleFrame) -> bool:
    return bool((frame.counts == counts).all())


def measured_at_ns(board: BoardProcess, frame: SampleFrame, drift_ppm: float = 0.0) -> NDArray[np.float64]:
    """Host time (monotonic) of each measurement of a frame; frames begin every millisecond of the board's clock."""
    board_ns = frame.board_us // 1000 * 1_000_000 + np.arange(len(frame.indices)) * SAMPLE_NS
    return board.start["epoch_monotonic_ns"] + board_ns / (1 + drift_ppm * 1e-6)


def expected(
    at_ns: NDArray[np.float64], indices: NDArray[np.uint16], times_ns: NDArray[np.float64], fields: NDArray
) -> NDArray[np.float64]:
    return np.array(
        [np.interp(t, times_ns, fields[:, index]) for t, index in zip(at_ns, indices.tolist(), strict=True)]
    )


@pytest.mark.parametrize("stands_still", [False, True])
def test_ring_is_read_at_the_time_of_each_measurement(tmp_path: Path, stands_still: bool) -> None:
    rng = np.random.default_rng(2)
    ring = tmp_path / "field.ring"
    # A world that knows the next twelve seconds: every 4 ms another field, hundreds of counts apart.
    times_ns = time.monotonic_ns() - 100_000_000 + np.arange(3000) * 4_000_000
    fields = rng.uniform(0, 1023, (len(times_ns), TAXELS))
    with TimedRingWriter(ring, TAXELS, slots=4096) as writer:
        for time_ns, field in zip(times_ns.tolist(), fields, strict=True):
            writer.write(time_ns, field)
        while True:
            with BoardProcess(tmp_path, *SMALL, "--field-ring", ring) as board:
                board.open_port()
                frames = board.read_frames(150)
                stood_s = 0.0
                if stands_still:
                    # What it then makes up for is what it would have measured meanwhile.
                    _, stood_s = board.stand_still(0.12)
                    frames += board.read_frames(150)
            # Where the machine prolongs it beyond what is made up for, another board is to.
            if stood_s < 0.2:
                break
        if stands_still:
            assert frames[-1].overruns == frames[0].overruns
        known = [frame for frame in frames if measured_at_ns(board, frame)[-1] < times_ns[-1]]
        assert known
        for frame in known:
            at_ns = measured_at_ns(board, frame)
            truth = expected(at_ns, frame.indices, times_ns.astype(float), fields)
            assert np.abs(frame.counts - truth).max() < 0.6


def test_newest_slot_is_held_and_strange_values_are_clipped(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    field = np.linspace(0, 1000, TAXELS)
    field[:5] = (np.nan, np.inf, -np.inf, -20.0, 5000.0)
    with pressed(ring, field), BoardProcess(tmp_path, *SMALL, "--scheme", "raster", "--field-ring", ring) as board:
        board.open_port()
        frame = board.read_frames(1)[0]
    assert frame.counts[:5].tolist() == [0, 1023, 0, 0, 1023]
    assert np.abs(frame.counts[5:] - field[5:]).max() <= 0.5


def test_ring_appears_is_replaced_and_goes(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    with BoardProcess(tmp_path, *SMALL, "--field-ring", ring) as board:
        board.open_port()
        assert all(not frame.counts.any() for frame in board.read_frames(20))
        for value in (100.0, 200.0):
            # Not closed: its writer was killed, and the next one replaces the file.
            with pressed(ring, np.full(TAXELS, value)):
                board.read_until(partial(is_all, value))
        # A ring of another array is refused in words, and its successor taken up.
        with pressed(ring, np.full(TAXELS + 1, 300.0)):
            board.read_until(lambda frame: not frame.counts.any())
        assert f"holds {TAXELS + 1} values a slot, the array has {TAXELS} taxels" in board.errors.read_text()
        with pressed(ring, np.full(TAXELS, 400.0)) as last:
            board.read_until(lambda frame: bool((frame.counts == 400).all()))
            last.close()
            board.read_until(lambda frame: not frame.counts.any())


def test_a_world_that_stands_still_is_told_and_nothing_is_measured_of_it(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    frames: list[SampleFrame] = []
    with BoardProcess(tmp_path, *SMALL, "--field-ring", ring) as board:
        port = board.open_port()
        with pressed(ring, np.full(TAXELS, 300.0)):
            board.read_until(lambda frame: bool((frame.counts == 300).all()))
        died_ns = time.monotonic_ns()
        deadline_ns = died_ns + int(DEADLINE_S * 1e9)
        while "no frames until it goes on" not in board.errors.read_text() or time.monotonic_ns() < died_ns + 1e9:
            assert time.monotonic_ns() < deadline_ns, "it tells nothing of the dead world"
            if select.select([port], [], [], 0.01)[0]:
                frames += board.decoder.feed(os.read(port, 65536))
        back_ns = time.monotonic_ns()
        with pressed(ring, np.full(TAXELS, 400.0)):
            # Also those from before it stood still that have not been read yet.
            while not (frames and (frames[-1].counts == 400).all()):
                assert time.monotonic_ns() < back_ns + DEADLINE_S * 1e9, "it does not go on with the world"
                frames += board.decoder.feed(board.read_bytes())
        assert "frames again" in board.errors.read_text()
    ends_ns = [board.start["epoch_monotonic_ns"] + 1000 * frame.board_us for frame in frames]
    assert not [end_ns for end_ns in ends_ns if died_ns + 6e8 < end_ns < back_ns]
    # As of a frozen board, there are none that would have to be missed.
    for before, after in pairwise(frames):
        assert after.sequence - before.sequence - 1 == after.overruns - before.overruns


def test_a_query_that_waited_for_the_world_is_answered_with_the_time_by_then(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    replies: list[BoardMessage] = []
    with BoardProcess(tmp_path, *SMALL, "--field-ring", ring) as board:
        board.decoder = StreamDecoder(on_message=replies.append)
        port = board.open_port()
        with pressed(ring, np.full(TAXELS, 300.0)):
            board.read_until(partial(is_all, 300))
        frames: list[SampleFrame] = []

        def read() -> None:
            if select.select([port], [], [], 0.01)[0]:
                frames.extend(board.decoder.feed(os.read(port, 65536)))

        wait_for(lambda: "no frames until it goes on" in board.errors.read_text(), timeout_s=DEADLINE_S, meanwhile=read)
        os.write(port, encode_query(1))
        with pressed(ring, np.full(TAXELS, 400.0)):
            wait_for(
                lambda: replies and is_all(400, frames[-1]),
                "a reply",
                DEADLINE_S,
                lambda: frames.extend(board.decoder.feed(board.read_bytes())),
            )
    (reply,) = replies
    assert isinstance(reply, Reply)
    last = [frame for frame in frames if is_all(300, frame)][-1]
    # It looks at the world again after 50 ms.
    assert reply.state.uptime_us >= last.board_us + 50_000


def test_a_ring_that_is_written_all_the_time_is_never_torn(tmp_path: Path) -> None:
    ring = tmp_path / "field.ring"
    with TimedRingWriter(ring, TAXELS, slots=2) as writer:
        writer.write(time.monotonic_ns(), np.full(TAXELS, 500.0))
        with BoardProcess(tmp_path, *SMALL, "--field-ring", ring) as board:
            board.open_port()
            board.read_until(lambda frame: bool(frame.counts.all()))
            frames: list[SampleFrame] = []
            while len(frames) < 100:
                for _ in range(200):
                    writer.write(time.monotonic_ns(), np.full(TAXELS, 500.0))
                frames += board.decoder.feed(board.read_bytes())
    assert all((frame.counts == 500).all() for frame in frames)


@pytest.mark.parametrize("loop", [True, False])
@pytest.mark.parametrize("drift_ppm", [0.0, 5000.0])
def test_recording_is_interpolated_between_its_frames(tmp_path: Path, loop: bool, drift_ppm: float) -> None:
    rng = np.random.default_rng(4)
    recording = rng.integers(0, 1024, (7, ROWS, COLS), dtype=np.uint16)
    np.save(tmp_path / "frames.npy", recording)
    options: list[str | float | Path] = ["--recording", tmp_path / "frames.npy", "--recording-rate-hz", 40]
    options += ["--drift-ppm", drift_ppm]
    with BoardProcess(tmp_path, *SMALL, *options, *(["--loop"] if loop else [])) as board:
        board.open_port()
        frames = board.read_frames(400)
    flat = recording.reshape(7, TAXELS).astype(float)
    fields = np.concatenate([flat] * 100 + [flat[:1]]) if loop else flat
    times_ns = board.start["epoch_monotonic_ns"] + np.arange(len(fields)) * 25e6
    for frame in frames:
        truth = expected(measured_at_ns(board, frame, drift_ppm), frame.indices, times_ns, fields)
        assert np.abs(frame.counts - truth).max() < 0.6


def test_counts_of_a_recording_beyond_the_converter_are_told_once(tmp_path: Path) -> None:
    recording = np.full((2, ROWS, COLS), 1023, dtype=np.uint16)
    recording[1, 2, 3] = 1024
    np.save(tmp_path / "frames.npy", recording)
    with BoardProcess(tmp_path, *SMALL, "--recording", tmp_path / "frames.npy", "--loop") as board:
        board.open_port()
        frames = board.read_frames(400)
        told = board.errors.read_text()
    assert all((frame.counts == 1023).all() for frame in frames)
    assert told.count("frame 1 has 1024 counts; all above 1023 are sent as 1023") == 1


def test_noise_is_seeded_and_of_the_size_asked_for(tmp_path: Path) -> None:
    np.save(tmp_path / "frames.npy", np.full((1, ROWS, COLS), 500, dtype=np.uint16))
    # A stall of the machine makes a board skip frames, which draw no noise: then nothing can be compared any more.
    for _ in range(10):
        runs = noisy_frames(tmp_path)
        common = runs[0].keys() & runs[1].keys() & runs[2].keys()
        if len(common) >= 100:
            break
    assert len(common) >= 100, "the machine stalled in every run"
    values = np.concatenate(list(runs[0].values())).astype(float)
    assert values.mean() == pytest.approx(500, abs=0.5)
    assert values.std() == pytest.approx(4, rel=0.1)
    assert all((runs[0][k] == runs[1][k]).all() for k in common)
    assert not any((runs[0][k] == runs[2][k]).all() for k in common)


def noisy_frames(folder: Path) -> list[dict[int, NDArray[np.uint16]]]:
    """Counts by sequence number from boards of seeds 1, 1 and 2; 100 in common, or fewer where one of them stalled."""
    options = ("--recording", folder / "frames.npy", "--scheme", "raster", "--noise-counts", 4)
    runs: list[dict[int, NDArray[np.uint16]]] = [{}, {}, {}]
    with ExitStack() as stack:
        boards = [
            stack.enter_context(BoardProcess(folder / str(i), *SMALL, *options, "--seed", seed))
            for i, seed in enumerate((1, 1, 2))
        ]
        for board in boards:
            board.open_port()
        while len(runs[0].keys() & runs[1].keys() & runs[2].keys()) < 100:
            for board, run in zip(boards, runs, strict=True):
                frames = board.read_frames(1)
                if frames[-1].overruns:
                    return runs
                run.update({frame.sequence: frame.counts for frame in frames})
    return runs


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros((3, ROWS, COLS + 1), dtype=np.uint16), "shape (frames, 6, 5)"),
        (np.zeros((3, 16, 32), dtype=np.uint16), "--rows 16 --cols 32 (of launch files rows:=16 cols:=32)"),
        (np.zeros((3, ROWS, COLS)), "save frames.astype(numpy.uint16, order='C')"),
        (np.asfortranarray(np.zeros((3, ROWS, COLS), dtype=np.uint16)), "save frames.astype(numpy.uint16, order='C')"),
        (np.zeros((3, ROWS, COLS)), "uint16"),
        (np.zeros((ROWS, COLS), dtype=np.uint16), "shape (frames, 6, 5)"),
        (np.asfortranarray(np.zeros((3, ROWS, COLS), dtype=np.uint16)), "C order"),
        (np.zeros((0, ROWS, COLS), dtype=np.uint16), "one frame or more"),
    ],
)
def test_recordings_that_do_not_fit_are_refused(tmp_path: Path, array: NDArray, message: str) -> None:
    np.save(tmp_path / "frames.npy", array)
    assert message in refusal(tmp_path / "frames.npy")


def test_broken_recordings_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "frames.npy"
    assert "cannot be read" in refusal(path)
    os.mkfifo(path)
    assert "cannot be mapped" in refusal(path)
    path.unlink()
    path.write_bytes(b"")
    assert "empty" in refusal(path)
    path.write_bytes(b"not a recording at all")
    assert "is no .npy file" in refusal(path)
    np.save(path, np.zeros((3, ROWS, COLS), dtype=np.uint16))
    whole = path.read_bytes()
    path.write_bytes(whole[:-2])
    assert "shorter than its header says" in refusal(path)
    path.write_bytes(whole[:20])
    assert "cut off" in refusal(path)


def test_a_path_that_only_a_shell_knows_is_refused_in_words() -> None:
    assert "~ is replaced by no shell there; write $HOME" in refusal(Path("~/frames.npy"))


def refusal(path: Path) -> str:
    command: list[str | Path] = [installed("virtual_board"), *map(str, SMALL), "--recording", path]
    result = subprocess.run(command, capture_output=True, text=True, timeout=30)
    assert result.returncode == 2
    assert str(path) in result.stderr
    return result.stderr
