# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the UR5e is told, in which order, and what of former connections counts. Nothing is connected to.

Address 127.0.17.50.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

import acts_control.robots.ur.robot
from acts_control.robots.base import CommandRefusedError, RobotStoppedError
from acts_control.robots.ur import UrConfig, UrRobot
from acts_control.robots.ur.state import UrState
from acts_core.robots import ur5e

HOST = "127.0.17.50"
PLAYING = UrState(connected=True, timestamp_s=2.5, q_rad=ur5e.LEVEL_Q_RAD, safety_bits=1, runtime_state=2)
STOPPED = PLAYING._replace(runtime_state=1)


class Told:
    """A robot whose commands are noted instead of being sent, and a clock."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.robot = UrRobot(UrConfig(robot_ip=HOST, robot_watchdog_s=0.5))
        self.state = PLAYING
        self.names: list[str] = []
        self.now_s = 10.0
        link = self.robot._link
        link._sent_s = self.now_s
        monkeypatch.setattr(acts_control.robots.ur.robot, "steady_s", lambda: self.now_s)
        monkeypatch.setattr(acts_control.robots.ur.robot, "probe", lambda _host: None)
        monkeypatch.setattr(link, "start", lambda: None)
        monkeypatch.setattr(link, "newest", lambda: self.state)
        monkeypatch.setattr(link, "send", lambda name, *_arguments: self.names.append(name))
        monkeypatch.setattr(link, "carry_out", self._carry_out)

    def _carry_out(self, name: str, _is_wanted: Callable[[], bool], *_arguments: object) -> None:
        self.names.append(name)
        if name == "take_control":
            self.state = PLAYING

    def kicks(self, for_s: float) -> int:
        """How often the robot's watchdog is told that all is well while the robot is read for so long [s]."""
        self.names.clear()
        end_s = self.now_s + for_s
        while self.now_s < end_s:
            self.now_s += 0.01
            self.robot.read()
        assert set(self.names) <= {"kickWatchdog"}
        return len(self.names)


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> Iterator[Told]:
    told = Told(monkeypatch)
    yield told
    told.robot.disconnect()


@pytest.mark.parametrize(
    "end",
    [
        lambda robot: robot.end_levelling(),
        lambda robot: robot.tilt(0.0, 0.0),
        lambda robot: robot.release(),
        lambda robot: robot.disconnect(),
    ],
    ids=["end_levelling", "tilt", "release", "disconnect"],
)
def test_the_robots_watchdog_is_told_that_all_is_well_on_the_way_to_level_and_not_after_that(
    told: Told, end: Callable[[UrRobot], object]
) -> None:
    assert told.kicks(1.0) == 0
    told.robot.begin_levelling()
    # Five times in robot_watchdog_s: one may be late.
    assert told.kicks(2.0) == pytest.approx(20, abs=2)
    end(told.robot)
    assert told.kicks(1.0) == 0


def test_the_move_to_the_level_pose_is_ended_before_the_first_tilt_alone(told: Told) -> None:
    told.robot.begin_levelling()
    for _ in range(2):
        told.robot.tilt(0.0, 0.0)
    assert told.names == ["moveJ", "end_move", "servoJ", "servoJ"]
    told.names.clear()
    told.robot.begin_levelling()
    told.robot.end_levelling()
    told.robot.tilt(0.0, 0.0)
    assert told.names == ["moveJ", "stopJ", "servoJ"]


def test_after_the_arm_was_levelled_anew_tilts_count_from_level(told: Told) -> None:
    for step in range(4):
        told.robot.tilt(0.03 * step, 0.0)
    told.robot.begin_levelling()
    told.names.clear()
    with pytest.raises(CommandRefusedError, match="jumps by"):
        told.robot.tilt(0.09, 0.0)
    assert told.names == []
    told.robot.tilt(0.0, 0.0)
    assert told.names == ["end_move", "servoJ"]


def test_a_program_of_ours_is_replaced_only_until_a_connection_has_come_about(
    told: Told, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(acts_control.robots.ur.robot, "_PROGRAM_TIMEOUT_S", 0.0)
    told.robot._is_left_running = True
    told.robot.connect(lambda: True)
    assert told.names == ["watch", "take_control", "setWatchdog"]
    told.robot.disconnect()
    told.names.clear()
    # This one is somebody else's, and may move the arm.
    with pytest.raises(RobotStoppedError, match="a program runs on the robot already"):
        told.robot.connect(lambda: True)
    assert told.names == ["watch"]


def test_how_long_connecting_took_is_not_blamed_for_a_later_stop(told: Told) -> None:
    told.state = STOPPED
    told.robot._link.silent_s = 3.0
    told.robot._link._silent_at_s = told.now_s
    told.robot.connect(lambda: True)
    told.state = STOPPED
    assert told.robot.read().stopped == "the robot's program is not running (stopped)"
