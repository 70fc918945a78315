# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Which commands for joints are followed, and how far: by a clock that the tests set."""

from __future__ import annotations

import pytest

from acts_control.hand.control import commands as module
from acts_control.hand.control.commands import JointCommands
from acts_control.hand.control.torque_wish import PendingAnswer
from acts_control.hand.description import LEAP_RIGHT

STALE_S = 0.5
PIP, DIP = (LEAP_RIGHT.names.index(name) for name in ("index_pip", "index_dip"))
HOLDING: tuple[dict[int, float], str] = ({}, "holding")


class Clocked:
    """Commands whose loop has begun at 100 s, and the sentences that were logged."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now_s = 100.0
        self.log: list[str] = []
        monkeypatch.setattr(module, "steady_s", lambda: self.now_s)
        self.commands = JointCommands(LEAP_RIGHT, STALE_S, lambda _level, sentence: self.log.append(sentence))
        self.commands.begin()

    def run(self, seconds: float) -> tuple[dict[int, float], str]:
        """Let time pass while the loop looks every 10 ms; what it follows then."""
        for _ in range(round(seconds / 0.01)):
            self.now_s += 0.01
            followed = self.commands.targets(self.now_s)
        return followed


@pytest.fixture
def clocked(monkeypatch: pytest.MonkeyPatch) -> Clocked:
    return Clocked(monkeypatch)


def test_joints_that_are_not_named_again_are_followed_as_long_as_any_command_counts(clocked: Clocked) -> None:
    clocked.commands.take({"index_pip": 0.4})
    assert clocked.run(0.3) == ({PIP: 0.4}, "moving as commanded")
    clocked.commands.take({"index_dip": 0.2})
    assert clocked.run(0.3) == ({PIP: 0.4, DIP: 0.2}, "moving as commanded")
    assert clocked.run(0.3) == HOLDING
    # What was commanded before the pause is not followed again.
    clocked.commands.take({"index_dip": 0.3})
    assert clocked.run(0.01) == ({DIP: 0.3}, "moving as commanded")


def test_angles_beyond_the_limits_of_a_joint_count_as_the_limits(clocked: Clocked) -> None:
    joint = LEAP_RIGHT.joints[PIP]
    for angle_rad, followed_rad in ((1e9, joint.upper_rad), (-1e9, joint.lower_rad)):
        clocked.commands.take({"index_pip": angle_rad})
        assert clocked.run(0.01) == ({PIP: followed_rad}, "moving as commanded")


def test_after_a_standstill_commands_are_left_out_for_as_long_as_one_counts(clocked: Clocked) -> None:
    clocked.commands.take({"index_pip": 0.4})
    clocked.now_s += 2.0
    clocked.commands.take({"index_pip": 0.5})
    assert clocked.run(0.01) == HOLDING
    assert clocked.log == [
        "this program stood still for 2.0 s: commands are left out for 0.5 s, because they may have waited"
    ]
    clocked.commands.take({"index_pip": 0.6})
    assert clocked.run(0.4) == HOLDING
    clocked.run(0.2)
    clocked.commands.take({"index_pip": 0.7})
    assert clocked.run(0.01) == ({PIP: 0.7}, "moving as commanded")
    assert len(clocked.log) == 1


def test_what_was_commanded_before_the_torque_came_on_again_is_forgotten(clocked: Clocked) -> None:
    clocked.commands.take({"index_pip": 0.4})
    clocked.commands.begin_again(0.1)
    clocked.now_s += 0.1
    assert clocked.run(0.01) == HOLDING
    clocked.commands.take({"index_dip": 0.2})
    assert clocked.run(0.01) == ({DIP: 0.2}, "moving as commanded")
    assert clocked.log == []


def test_a_standstill_before_the_torque_came_on_again_is_noticed_all_the_same(clocked: Clocked) -> None:
    clocked.now_s += 2.0
    clocked.commands.begin_again(0.1)
    assert clocked.run(0.01) == HOLDING
    assert clocked.log[0].startswith("this program stood still for 1.9 s")


def test_an_answer_that_is_known_is_not_waited_for() -> None:
    assert PendingAnswer.known("it is off").poll() == "it is off"
