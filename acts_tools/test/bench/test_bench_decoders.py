# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The plain decoder that `acts bench` compares with: the same frames from any bytes, whole or damaged."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder, encode_frame
from acts_tools.bench.cases.decode import same_frames
from acts_tools.bench.references.naive_decoder import NaiveDecoder

pytestmark = pytest.mark.slow


@st.composite
def frames(draw: st.DrawFn) -> SampleFrame:
    rows, cols = draw(st.integers(1, 64)), draw(st.integers(1, 64))
    m = draw(st.integers(1, min(rows * cols, 300)))
    random = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    return SampleFrame(
        sequence=draw(st.integers(0, 2**32 - 1)),
        board_us=draw(st.integers(0, 2**64 - 1)),
        duration_us=draw(st.integers(0, 2**32 - 1)),
        scheme=draw(st.sampled_from(Scheme)),
        rows=rows,
        cols=cols,
        overruns=draw(st.integers(0, 2**32 - 1)),
        indices=random.permutation(rows * cols)[:m].astype(np.uint16),
        # Small counts as on an untouched skin, where most bytes are zero, and large ones, where few are.
        counts=random.integers(0, draw(st.sampled_from([1, 4, 1024])), m).astype(np.uint16),
    )


def fed_in_pieces(decoder: StreamDecoder | NaiveDecoder, stream: bytes, cuts: list[int]) -> list[SampleFrame]:
    edges = sorted({0, len(stream), *(cut % (len(stream) + 1) for cut in cuts)})
    return [frame for begin, end in pairwise(edges) for frame in decoder.feed(stream[begin:end])]


@given(st.lists(frames(), max_size=5), st.lists(st.integers(0, 10_000), max_size=8))
def test_both_decoders_yield_what_was_encoded(sent: list[SampleFrame], cuts: list[int]) -> None:
    stream = b"".join(map(encode_frame, sent))
    assert same_frames(fed_in_pieces(StreamDecoder(), stream, cuts), sent)
    assert same_frames(fed_in_pieces(NaiveDecoder(), stream, cuts), sent)


@given(
    st.lists(frames(), min_size=1, max_size=5),
    st.lists(st.tuples(st.integers(0, 10_000), st.integers(0, 255)), min_size=1, max_size=5),
    st.lists(st.integers(0, 10_000), max_size=8),
)
def test_both_refuse_the_same_damage(sent: list[SampleFrame], damage: list[tuple[int, int]], cuts: list[int]) -> None:
    stream = bytearray(b"".join(map(encode_frame, sent)))
    for position, value in damage:
        stream[position % len(stream)] = value
    strict = fed_in_pieces(StreamDecoder(), bytes(stream), cuts)
    assert same_frames(fed_in_pieces(NaiveDecoder(), bytes(stream), cuts), strict)


def test_frames_that_differ_in_one_count_are_not_the_same() -> None:
    frame = SampleFrame(1, 2, 3, Scheme.RANDOM, 4, 4, 0, np.arange(3, dtype=np.uint16), np.zeros(3, dtype=np.uint16))
    other = SampleFrame(1, 2, 3, Scheme.RANDOM, 4, 4, 0, frame.indices, frame.counts + np.uint16(1))
    assert same_frames([frame], [frame])
    assert not same_frames([frame], [other])
    assert not same_frames([frame], [])
