# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The last look at a tilt before it is commanded, and the watch on the robot."""

import math

import pytest

from acts_control.robots.base import RobotReading, RobotWatch, SafetyConfig, TiltGate, TiltLimits, touch_age_s

NOW_NS = 1_700_000_000_000_000_000
MS = 1_000_000
DT = 0.004
NAN = float("nan")
LEVEL = (0.0, 0.0)
NORMAL = RobotReading(connected=True, time_s=0.0, joints=(0.0, 0.0), off_level=0.0, tilt_rad=LEVEL)


# --- the gate


def test_the_gate_lets_tilts_pass_up_to_the_limits() -> None:
    gate = TiltGate(TiltLimits(max_tilt_rad=0.1, max_tilt_rate_rad_s=1.0))
    for k in range(25):
        tilt = (DT * k, 0.0)
        assert gate.fault(tilt, DT) == ""
        gate.sent(tilt)


@pytest.mark.parametrize(
    ("tilt", "words"),
    [
        ((NAN, 0.0), "tilt = (nan, 0.0) rad: only finite"),
        ((0.0, -math.inf), "tilt = (0.0, -inf) rad: only finite"),
        ((0.09, 0.09), "is 0.1273 rad off the level pose, allowed is 0.1100"),
        ((0.0, -0.2), "is 0.2000 rad off the level pose"),
        ((0.03, 0.0), "jumps by 0.0200 rad, allowed is 0.0062"),
        ((-0.01, 0.0), "jumps by 0.0200 rad"),
    ],
)
def test_the_gate_stops_what_must_not_reach_the_robot(tilt: tuple[float, float], words: str) -> None:
    gate = TiltGate(TiltLimits(max_tilt_rad=0.1, max_tilt_rate_rad_s=1.0))
    assert gate.fault((0.01, 0.0), 0.01) == ""
    gate.sent((0.01, 0.0))
    assert words in gate.fault(tilt, DT)
    # It counts from what was sent last, and the time since then.
    assert gate.fault((0.02, 0.0), 2 * DT) == ""


def test_the_first_command_counts_from_level() -> None:
    gate = TiltGate(TiltLimits(max_tilt_rad=0.1, max_tilt_rate_rad_s=1.0))
    assert "jumps by 0.0500 rad, allowed is 0.0062" in gate.fault((0.05, 0.0), DT)


def test_where_limits_are_tightened_the_gate_lets_the_plate_come_back() -> None:
    gate = TiltGate(TiltLimits(max_tilt_rad=0.1, max_tilt_rate_rad_s=1.0))
    for tilt_x in (0.05, 0.1):
        assert gate.fault((tilt_x, 0.0), 0.05) == ""
        gate.sent((tilt_x, 0.0))
    gate.limits = TiltLimits(max_tilt_rad=0.02, max_tilt_rate_rad_s=0.1)
    for tilt_x in (0.096, 0.0955, 0.05, 0.015):
        assert gate.fault((tilt_x, 0.0), 0.004 if tilt_x > 0.09 else 0.4) == ""
        gate.sent((tilt_x, 0.0))
    assert "jumps" in gate.fault((0.011, 0.0), DT)
    assert "off the level pose, allowed is 0.0220" in gate.fault((0.03, 0.0), 1.0)


# --- the watch


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"connected": False}, "connection to the robot lost"),
        ({"connected": False, "silent_s": 0.1}, "connection to the robot lost"),
        ({"connected": False, "silent_s": 2.5}, "no data from the robot for 2.50 s"),
        ({"stopped": "robot: protective stop"}, "robot: protective stop"),
        ({"waiting_s": 0.25}, "the robot has not taken a command for 0.25 s"),
        ({"joints": (NAN, 0.0)}, "the robot reports joint angles (nan, 0.0)"),
        ({"joints": (0.0,) * 5}, "the robot reports 5 joints, and 2 before"),
        ({"tilt_rad": (0.0, math.inf)}, "the robot reports a tilt of (0.0, inf) rad"),
    ],
)
def test_the_watch_tells_why_the_robot_stopped(changes: dict[str, object], words: str) -> None:
    watch = RobotWatch(SafetyConfig())
    assert watch.step(NORMAL, DT) == ""
    assert watch.step(NORMAL._replace(**changes), DT) == words  # type: ignore[arg-type]


def test_joints_that_appear_after_the_first_reading_are_a_fault() -> None:
    watch = RobotWatch(SafetyConfig())
    assert watch.step(NORMAL._replace(joints=()), DT) == ""
    assert watch.step(NORMAL, DT) == "the robot reports 2 joints, and 0 before"


def test_a_clock_that_stands_still_is_a_lost_connection() -> None:
    watch = RobotWatch(SafetyConfig(robot_stale_after_s=0.1))
    for k in range(100):
        assert watch.step(NORMAL._replace(time_s=0.008 * (k // 2)), DT) == ""
    words = [watch.step(NORMAL._replace(time_s=1.0), DT) for _ in range(30)]
    assert words[24] == ""
    assert words[27].startswith("no data from the robot for 0.1")


@pytest.mark.parametrize("time_s", [NAN, math.inf])
def test_a_clock_that_is_no_number_stands_still(time_s: float) -> None:
    watch = RobotWatch(SafetyConfig(robot_stale_after_s=0.1))
    words = [watch.step(NORMAL._replace(time_s=time_s), DT) for _ in range(30)]
    assert words[20] == ""
    assert words[29].startswith("no data from the robot for 0.1")


def test_the_age_of_touch() -> None:
    assert touch_age_s(NOW_NS, NOW_NS - 7 * MS) == pytest.approx(0.007)
    assert touch_age_s(NOW_NS, NOW_NS + MS) == pytest.approx(-0.001)
    assert touch_age_s(NOW_NS, NOW_NS + 60 * MS) == math.inf
