# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Transitions of the driver that there are not, and that are not completed; ROS_DOMAIN_ID 209."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from driver_rig import Rig
from lifecycle_msgs.msg import Transition
from pty_board import PtyBoard, frame
from rclpy.impl.implementation_singleton import rclpy_implementation

from acts_driver.nodes.transitions import TransitionError

pytestmark = pytest.mark.slow


@pytest.fixture
def board(tmp_path: Path) -> Iterator[PtyBoard]:
    with PtyBoard(tmp_path) as board:
        yield board


@pytest.fixture
def rig() -> Iterator[Rig]:
    rig = Rig(209)
    yield rig
    rig.close()


class Unheard:
    """A state machine whose changes to one state are made, but not published."""

    def __init__(self, machine: Any, state: str) -> None:
        self._machine = machine
        self._state = state

    def __getattr__(self, name: str) -> Any:
        return getattr(self._machine, name)

    def trigger_transition_by_id(self, number: int, publishes: bool) -> None:
        self._machine.trigger_transition_by_id(number, publishes)
        if self.current_state[1] == self._state:
            raise rclpy_implementation.RCLError("Failed to publish: cannot publish data, at x.cpp:68")


def test_one_that_there_is_not_is_refused_and_the_driver_goes_on(board: PtyBoard, rig: Rig) -> None:
    rig.start_driver(port=board.path)
    rig.wait_until_active()
    for transition in (Transition.TRANSITION_CLEANUP, Transition.TRANSITION_CONFIGURE, 250):
        assert not rig.change_state(transition)
        assert rig.state() == "active"
    board.write_frames(frame(0, m=55))
    rig.spin_until(lambda: rig.samples, "a message")


def test_a_driver_that_is_left_in_one_at_its_start_ends(board: PtyBoard, rig: Rig) -> None:
    driver = rig.start_driver(port=board.path)
    driver._state_machine = Unheard(driver._state_machine, "configuring")
    with pytest.raises(TransitionError, match=r"/plate/driver is left between two states \(configuring\)"):
        rig.wait_until_active()


def test_a_driver_that_is_left_in_one_that_was_asked_for_ends(board: PtyBoard, rig: Rig) -> None:
    driver = rig.start_driver(port=board.path)
    rig.wait_until_active()
    driver._state_machine = Unheard(driver._state_machine, "deactivating")
    with pytest.raises(TransitionError, match=r"left between two states \(deactivating\).*started anew"):
        rig.change_state(Transition.TRANSITION_DEACTIVATE)
