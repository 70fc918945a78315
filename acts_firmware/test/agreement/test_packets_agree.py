# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The core writes the packets that `acts_core.wire.samples` reads and writes."""

import core_library
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from acts_core.frames import SampleFrame, Scheme
from acts_core.wire import StreamDecoder, cobs, encode_frame


@st.composite
def frames(draw: st.DrawFn) -> SampleFrame:
    rows, cols = draw(st.integers(1, 64)), draw(st.integers(1, 64))
    m = draw(st.integers(1, rows * cols))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    u32 = st.integers(0, 2**32 - 1)
    return SampleFrame(
        sequence=draw(u32),
        board_us=draw(st.integers(0, 2**64 - 1)),
        duration_us=draw(u32),
        scheme=draw(st.sampled_from([scheme for scheme in Scheme if scheme != Scheme.UNKNOWN])),
        rows=rows,
        cols=cols,
        overruns=draw(u32),
        indices=rng.permutation(rows * cols)[:m].astype(np.uint16),
        counts=rng.integers(0, 1024, m).astype(np.uint16),
    )


@settings(max_examples=100, deadline=None)
@given(frames())
def test_same_bytes_as_the_reference(frame: SampleFrame) -> None:
    wire = core_library.cobs_encode(core_library.encode_samples(frame)) + b"\0"
    assert wire == encode_frame(frame)
    (decoded,) = StreamDecoder().feed(wire)
    for name in ("sequence", "board_us", "duration_us", "scheme", "rows", "cols", "overruns"):
        assert getattr(decoded, name) == getattr(frame, name)
    assert decoded.indices.tolist() == frame.indices.tolist()
    assert decoded.counts.tolist() == frame.counts.tolist()


@settings(max_examples=100, deadline=None)
@given(st.one_of(st.binary(max_size=1100), st.integers(0, 1100).map(lambda size: b"\x7f" * size)))
def test_byte_stuffing(data: bytes) -> None:
    stuffed = core_library.cobs_encode(data)
    assert stuffed == cobs.encode(data)
    assert core_library.cobs_decode(stuffed) == data
