# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The plain decoder that `acts bench` compares with: the same frames from any bytes, whole or damaged."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sample_frames import frames

from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder, encode_frame
from acts_tools.bench.cases.decode import same_frames
from acts_tools.bench.references.naive_decoder import NaiveDecoder

pytestmark = pytest.mark.slow


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
