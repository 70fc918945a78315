# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames of samples for property tests."""

import numpy as np
from hypothesis import strategies as st

from acts_core.frames import SampleFrame, Scheme


@st.composite
def frames(draw: st.DrawFn, m_max: int = 300) -> SampleFrame:
    """Frames of every kind that can be sent, of so many samples at most."""
    rows, cols = draw(st.integers(1, 64)), draw(st.integers(1, 64))
    m = draw(st.integers(1, min(rows * cols, m_max)))
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
