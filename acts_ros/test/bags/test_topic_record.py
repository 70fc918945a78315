# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the recorder knows of one topic."""

from __future__ import annotations

import pytest

from acts_ros.bags.recorder import TopicRecord


@pytest.mark.parametrize(
    ("received", "last_s", "silent_s"),
    [(100, 10.0, None), (100, 8.5, 1.5), (9, 5.0, None), (11, 9.0, None), (11, 3.0, 7.0), (0, 0.0, None)],
)
def test_a_silence_is_measured_by_the_rate_before_it(received: int, last_s: float, silent_s: float | None) -> None:
    record = TopicRecord("/plate/contact", "acts_msgs/msg/Contact", received, first_s=last_s - 1.0, last_s=last_s)
    assert record.silent_s(10.0) == silent_s
