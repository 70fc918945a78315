# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""What the UR5e's controller says of itself in numbers, told in words: each number alone."""

from __future__ import annotations

import math

import pytest

from acts_control.robots.ur import UrConfig
from acts_control.robots.ur.state import UrState
from acts_core.robots import ur5e

STATE = UrState(connected=True, timestamp_s=2.5, q_rad=ur5e.LEVEL_Q_RAD, safety_bits=1, runtime_state=2)


@pytest.mark.parametrize(
    ("bit", "words"),
    [
        (0, ""),  # normal mode
        (1, ""),  # reduced mode
        (2, "protective stop"),
        (3, "recovery mode"),
        (4, "safeguard stop"),
        (5, "emergency stop"),  # of the system
        (6, "emergency stop"),  # of the robot
        (7, "emergency stop"),
        (8, "safety violation"),
        (9, "safety fault"),
        (10, "stopped due to safety"),
    ],
)
def test_each_safety_function_that_holds_the_robot_is_told_by_its_bit_alone(bit: int, words: str) -> None:
    state = STATE._replace(safety_bits=1 << bit)
    assert state.safety_stop == words
    assert state.reading(UrConfig()).stopped == (f"robot: {words}" if words else "")


@pytest.mark.parametrize(
    ("runtime_state", "words"), [(0, "stopping"), (1, "stopped"), (3, "pausing"), (4, "paused"), (5, "resuming")]
)
def test_a_program_that_does_not_run_is_told_with_its_state(runtime_state: int, words: str) -> None:
    stopped = STATE._replace(runtime_state=runtime_state).reading(UrConfig()).stopped
    assert stopped == f"the robot's program is not running ({words})"


@pytest.mark.parametrize(
    ("mode", "words"),
    [
        (-1, "there is no controller"),
        (0, "it is not connected to its controller"),
        (1, "its safety settings wait to be confirmed"),
        (2, "it is booting"),
        (3, "it is off"),
        (4, "it is on, but not ready"),
        (5, "its brakes are on"),
        (6, "it is guided by hand"),
        (7, ""),
        (8, "its firmware is being updated"),
    ],
)
def test_each_mode_of_an_arm_that_is_not_ready_is_told_in_words(mode: int, words: str) -> None:
    assert STATE._replace(robot_mode=mode).unready == words


def test_a_single_joint_whose_angle_is_not_known_stops_motion_and_hides_no_safety_function() -> None:
    state = STATE._replace(q_rad=(*ur5e.LEVEL_Q_RAD[:5], math.nan))
    reading = state.reading(UrConfig())
    assert reading.stopped.startswith("the robot reports joint angles (")
    assert all(map(math.isnan, (reading.off_level, *reading.tilt_rad)))
    assert state._replace(safety_bits=1 << 7).reading(UrConfig()).stopped == "robot: emergency stop"
