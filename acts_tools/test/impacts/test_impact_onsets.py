# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How well the onsets of simulated bounces are known, and how well they are told to be known."""

from __future__ import annotations

import pytest

from acts_tools.evaluate.impacts.impacts_command import TOUCH_MS, drops_of, seen_by_us

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("seed", [1, 2])
def test_onsets_of_bounces_are_as_uncertain_as_they_are_told(seed: int) -> None:
    entry = seen_by_us(drops_of(30, seed, TOUCH_MS), "adaptive", 128, noise_counts=3.0)
    assert entry["told_as_bounce"] == 30
    # Of a normal distribution 0.68. The share of 30 drops has a standard deviation of 0.09.
    assert 0.5 < entry["onset_within_1_sigma"] < 0.86
    # 100 drops: 0.14 ms, with frames of 2.3 ms.
    assert entry["onset_error_ms"]["mean"] < 0.2
