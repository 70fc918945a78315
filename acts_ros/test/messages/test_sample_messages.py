# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames of samples as messages and back."""

import numpy as np
import pytest

from acts_core.frames import SampleFrame, Scheme
from acts_msgs.msg import TactileSamples
from acts_ros.messages import SamplesMessage, frame_of

STAMP_NS = 1_700_000_000_123_456_789


def frame(duration_us: int, scheme: Scheme) -> SampleFrame:
    return SampleFrame(
        sequence=7,
        board_us=1,
        duration_us=duration_us,
        scheme=scheme,
        rows=8,
        cols=16,
        overruns=2,
        indices=np.array([3, 127], np.uint16),
        counts=np.array([1023, 5], np.uint16),
    )


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize("duration_us", [0, 945, 1_000_000, 2_500_001])
def test_a_frame_is_what_was_written(duration_us: int, scheme: Scheme) -> None:
    message = SamplesMessage("plate").fill(frame(duration_us, scheme), STAMP_NS)
    assert (message.header.frame_id, message.header.stamp.sec) == ("plate", 1_700_000_000)
    assert message.header.stamp.nanosec == 123_456_789
    assert (message.duration.sec, message.duration.nanosec) == (duration_us // 10**6, duration_us % 10**6 * 1000)
    assert (message.sequence, message.rows, message.cols, message.scheme) == (7, 8, 16, scheme)
    read = frame_of(message)
    # The board's own clock is not in a message, nor what the board had to leave out.
    assert (read.board_us, read.overruns) == (STAMP_NS // 1000, 0)
    assert (read.sequence, read.duration_us, read.scheme) == (7, duration_us, scheme)
    assert (read.rows, read.cols) == (8, 16)
    assert (read.indices.tolist(), read.counts.tolist()) == ([3, 127], [1023, 5])


def test_a_scheme_of_a_later_release_is_unknown() -> None:
    assert frame_of(TactileSamples(scheme=255)).scheme is Scheme.UNKNOWN
