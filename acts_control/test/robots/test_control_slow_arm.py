# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An arm that comes to the level pose slowly, against the simulated UR5e. Robot address 127.0.17.40."""

from __future__ import annotations

import time
from contextlib import ExitStack

import pytest
from control_rig import SimulatedRobot
from waiting import wait_for

from acts_control.ball import ControlLoop, LoopConfig, Phase
from acts_control.robots import with_robots
from acts_control.robots.ur import UrRobot
from acts_core.robots import ur5e

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("ur_rtde")]


def test_an_arm_that_moves_slowly_at_last_is_tilted_though_its_move_has_not_ended() -> None:
    near = (ur5e.LEVEL_Q_RAD[0] + 0.01, *ur5e.LEVEL_Q_RAD[1:])
    with ExitStack() as stack:
        robot = stack.enter_context(SimulatedRobot("127.0.17.40", near))
        config = with_robots(LoopConfig)(
            robot_ip=robot.host, homing_acceleration_rad_s2=0.01, robot_stale_after_s=1.0, connect_retry_s=0.1
        )
        loop = ControlLoop(config, UrRobot(config), time.time_ns)
        stack.callback(loop.close)
        loop.launch()

        def has_been_tilted_or_ended() -> bool:
            status = loop.status
            return status.steps > 20 or (status.phase is Phase.STOPPED and status.reason != "not started")

        wait_for(has_been_tilted_or_ended, lambda: f"steps, {loop.status}", 60.0)
        assert "another thread" not in robot.text()
        assert loop.status.phase is Phase.WAITING
