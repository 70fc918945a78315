# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""How well the ball is held and the letters are traced, on any machine: the whole chain stepped without a clock."""

from __future__ import annotations

from dataclasses import replace

import pytest

from acts_control.ball import EstimatorConfig, TrajectoryConfig
from acts_sim.ball import WorldConfig
from acts_tools.demo.ball.offline_chain import Chain, run
from acts_tools.demo.ball.score import HOLD_SETTLE_S, LETTERS, rms_error_mm

pytestmark = pytest.mark.slow

# Measured with seeds 1 and 2: held within 0.15 mm, N within 1.02, B 1.45, I 1.00; the slow chain holds within
# 0.49 mm, the paper's scheme within 0.39.
HOLD_LIMIT_MM = 1.0
LETTER_LIMIT_MM = 2.5


@pytest.mark.parametrize("seed", [1, 2])
def test_the_ball_is_held_and_the_letters_are_traced(seed: int) -> None:
    recording = run(Chain(seed=seed))
    assert recording.stop_reason == ""
    assert recording.finished
    hold_mm = rms_error_mm(recording, "hold", skip_s=HOLD_SETTLE_S)
    assert hold_mm is not None
    assert hold_mm < HOLD_LIMIT_MM
    for letter in LETTERS:
        error_mm = rms_error_mm(recording, letter)
        assert error_mm is not None
        assert error_mm < LETTER_LIMIT_MM, letter


def test_pushes_are_caught() -> None:
    world = WorldConfig(start_after_s=0.1, push_speed_m_s=0.08, push_period_s=3.0)
    recording = run(Chain(world=world, trajectory=TrajectoryConfig(trajectory="hold", hold_s=12.0)))
    assert recording.stop_reason == ""
    assert recording.finished


def test_a_much_slower_chain_still_balances() -> None:
    slow = replace(Chain(trajectory=TrajectoryConfig(trajectory="hold")), touch_delay_ms=15, command_delay_ms=10)
    recording = run(slow)
    assert recording.finished
    hold_mm = rms_error_mm(recording, "hold", skip_s=HOLD_SETTLE_S)
    assert hold_mm is not None
    assert hold_mm < HOLD_LIMIT_MM


def test_the_papers_scheme_holds_the_ball_at_the_centre() -> None:
    # Elsewhere it does not see every place; see docs/simulation.md.
    chain = Chain(trajectory=TrajectoryConfig(trajectory="hold"), estimator=EstimatorConfig(), scheme="adaptive")
    recording = run(chain)
    assert recording.finished
    hold_mm = rms_error_mm(recording, "hold", skip_s=HOLD_SETTLE_S)
    assert hold_mm is not None
    assert hold_mm < HOLD_LIMIT_MM
