# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The loop of a hand where the program stands still in the middle of an exchange with the motors."""

from __future__ import annotations

import time
from collections.abc import Sequence

import pytest
from hand_loop_rig import STALE_S, Made

from acts_control.hand.control import HandPhase
from acts_control.hand.motors import HandError, HandReading

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("lost", ["read", "command"])
def test_an_answer_that_is_lost_after_one_in_which_this_program_stood_still_ends_nothing(
    made: Made, monkeypatch: pytest.MonkeyPatch, lost: str
) -> None:
    bus, loop, until = made
    until(lambda: loop.status.phase is HandPhase.RELEASED)
    assert loop.enable() == ""
    until(lambda: len(bus.sent) > 3)
    answered, to_be_lost = getattr(bus, lost), [False, True]

    def is_lost(*arguments: Sequence[float]) -> HandReading | None:
        if not to_be_lost:
            return answered(*arguments)
        if to_be_lost.pop():
            begin_s = time.monotonic()
            until(lambda: time.monotonic() - begin_s > 1.5 * STALE_S)
        raise HandError("no answer")

    monkeypatch.setattr(bus, lost, is_lost)
    until(lambda: loop.status.unanswered == 2)
    sent = len(bus.sent)
    until(lambda: len(bus.sent) > sent)
    assert bus.connects == 1
    assert loop.status.phase is HandPhase.ENABLED
