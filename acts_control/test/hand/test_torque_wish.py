# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Answers to who asks for the torque of a hand, which wait for the motors."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from acts_control.hand.control import HandPhase, PendingAnswer, torque_wish
from acts_control.hand.control.status import HandStatus
from acts_control.hand.control.torque_wish import TorqueWish


def test_motors_are_not_told_as_silent_because_this_program_stood_still(monkeypatch: pytest.MonkeyPatch) -> None:
    now_s = [0.0]
    monkeypatch.setattr(torque_wish, "time", SimpleNamespace(monotonic=lambda: now_s[0]))
    wish = TorqueWish(is_on=True)
    wish.is_served = True
    wish.off("released by request")
    status = HandStatus(phase=HandPhase.ENABLED)
    asked = PendingAnswer(wish.off_is_known, lambda: wish.why_not_off(status), waits=True)
    now_s[0] += 5.0
    assert asked.poll() is None
    # The loop goes on, and with it the motors; or these are silent.
    answers = []
    for _ in range(25):
        now_s[0] += 0.1
        answers.append(asked.poll())
    assert answers[10] is None
    assert "have not said within 2 s that they are released" in str(answers[-1])
    wish.off_is_known.set()
    assert asked.poll() == ""
