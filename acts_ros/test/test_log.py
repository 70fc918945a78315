# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which changes of a state are logged."""

import time

import pytest

from acts_ros.log import LoggedChanges


@pytest.fixture
def now_s(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now_s = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now_s[0])
    return now_s


def test_a_first_state_and_what_has_not_changed_are_not_logged(now_s: list[float]) -> None:
    changes = LoggedChanges("waiting", "not started")
    assert not changes.is_due("waiting", "not started")
    assert changes.is_due("moving", "asked for")
    now_s[0] += 100.0
    assert not changes.is_due("moving", "asked for")


def test_reasons_that_come_and_go_are_logged_once_a_second_after_the_first(now_s: list[float]) -> None:
    changes = LoggedChanges("waiting", "not started")
    due = 0
    for _ in range(500):
        for reason in ("for touch", "for a ball"):
            due += changes.is_due("waiting", reason)
            now_s[0] += 0.01
    # In 10 s.
    assert 14 <= due <= 15
    assert sum(changes.is_due("waiting", f"{number}") for number in range(9)) <= 1
    # What holds in the end is told, and no state is left out.
    now_s[0] += 1.0
    assert changes.is_due("waiting", "for nothing")
    assert all(changes.is_due(state, "again") for state in ["moving", "waiting"] * 20)
