# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames per second that one core decodes, and the ratio to a simple decoder in Python.

The decoders take turns on the same data, so that other load on the machine affects all of them; the ratio is the median
over the turns. Time is the thread's CPU time, which excludes that of other programs.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

import numpy as np

from acts_core.frames import SampleFrame
from acts_core.wire import RasterDecoder, StreamDecoder
from acts_tools.bench.references.naive_decoder import NaiveDecoder
from acts_tools.bench.result import Figure, Result
from acts_tools.bench.rigs.processes import virtual_board
from acts_tools.bench.rigs.skin import pressed
from acts_tools.bench.rigs.stream_recording import Decoder, record
from acts_tools.bench.workbench import Workbench

_FRAMES = 1000
_LINES = 100
_TURNS_MIN = 3
# Lines at the rate of binary frames, as recording would otherwise take longer than the measurement.
_RASTER_OPTIONS = ("--protocol", "raster_ascii", "--sample-us", "4", "--rate-hz", "200")


def measure(workbench: Workbench) -> Result:
    """Record a stream, check that both decoders agree on it, and time them."""
    skin = pressed(workbench.folder)
    with virtual_board(workbench.folder, *skin) as board:
        pieces = record(board.link, StreamDecoder(), _FRAMES, workbench)
    with virtual_board(workbench.folder, *skin, *_RASTER_OPTIONS) as board:
        lines = record(board.link, RasterDecoder(), _LINES, workbench)

    frames = _decode(StreamDecoder, pieces)
    problems = []
    if not same_frames(frames, _decode(NaiveDecoder, pieces)):
        problems.append("the plain decoder yields other frames than StreamDecoder")
    contenders: list[tuple[Callable[[], Decoder], Sequence[bytes]]] = [
        (StreamDecoder, pieces),
        (NaiveDecoder, pieces),
        (RasterDecoder, lines),
    ]
    counts = [len(_decode(make, data)) for make, data in contenders]
    seconds = _take_turns(contenders, workbench)
    rates = np.array(counts) / seconds
    frame_hz, naive_hz, line_hz = np.median(rates, axis=0).tolist()
    ratio = float(np.median(rates[:, 0] / rates[:, 1]))
    return Result(
        [
            Figure("frames_hz", "StreamDecoder, on one core", frame_hz, "frames/s"),
            Figure("us_per_frame", "    that is per frame", 1e6 / frame_hz, "us"),
            Figure("naive_hz", "plain Python decoder of the same frames", naive_hz, "frames/s"),
            Figure("ratio", "StreamDecoder to plain Python", ratio, "times", is_ratio=True),
            Figure("raster_hz", "raster_ascii, lines of 1024 taxels", line_hz, "lines/s"),
            Figure("bytes_per_read", "bytes a read of the port gave, median", float(np.median([*map(len, pieces)]))),
            Figure("turns", "turns, 1000 frames each", len(seconds)),
        ],
        problems,
    )


def same_frames(some: Sequence[SampleFrame], others: Sequence[SampleFrame]) -> bool:
    """Whether two lists of frames are equal."""
    return len(some) == len(others) and all(map(_same, some, others))


def _same(one: SampleFrame, other: SampleFrame) -> bool:
    fields = ("sequence", "board_us", "duration_us", "scheme", "rows", "cols", "overruns")
    return (
        all(getattr(one, name) == getattr(other, name) for name in fields)
        and np.array_equal(one.indices, other.indices)
        and np.array_equal(one.counts, other.counts)
    )


def _decode(make: Callable[[], Decoder], pieces: Sequence[bytes]) -> list[SampleFrame]:
    decoder = make()
    return [frame for piece in pieces for frame in decoder.feed(piece)]


def _take_turns(
    contenders: Sequence[tuple[Callable[[], Decoder], Sequence[bytes]]], workbench: Workbench
) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """CPU time of each contender in each turn; np.ndarray [shape=(turns, contenders)] [s]."""
    turns: list[list[float]] = []
    end_s = time.monotonic() + workbench.seconds
    while time.monotonic() < end_s or len(turns) < _TURNS_MIN:
        workbench.check_stop()
        turn = []
        for make, pieces in contenders:
            decoder = make()
            feed = decoder.feed
            begin_s = time.thread_time()
            for piece in pieces:
                feed(piece)
            turn.append(time.thread_time() - begin_s)
        turns.append(turn)
    return np.array(turns)
