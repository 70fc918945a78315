# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""An arm that is not ready, or not wanted any more, when it is connected to, against the simulated UR5e.

Robot addresses 127.0.17.30 to 127.0.17.39.
"""

from __future__ import annotations

from contextlib import ExitStack

import pytest
from balancing_rig import Rig
from control_rig import SimulatedRobot, wait_for

from acts_control.ball import Phase
from acts_core.robots import ur5e

pytestmark = pytest.mark.slow

FAR = (ur5e.LEVEL_Q_RAD[0] + 0.5, *ur5e.LEVEL_Q_RAD[1:])
PROGRAM, MOVE_J = "program rtde_control", "command 1"


@pytest.mark.parametrize(
    ("before", "meanwhile", "words"),
    [
        (["power off"], ["power on", "brake release"], "it is off"),
        (["power off", "power on"], ["brake release"], "its brakes are on"),
    ],
    ids=["off", "brakes"],
)
def test_an_arm_that_is_made_ready_at_its_panel_does_not_move_before_it_is_started(
    before: list[str], meanwhile: list[str], words: str
) -> None:
    with ExitStack() as stack:
        simulated = stack.enter_context(SimulatedRobot("127.0.17.30", FAR))
        for line in before:
            simulated.ask_dashboard(line)
        rig = Rig(simulated.host, stack, simulated=simulated)
        wait_for(lambda: words in rig.loop.status.reason, f"the reason, {rig.loop.status}")
        reason = rig.await_phase(Phase.STOPPED)
        assert reason.endswith("switch the arm on, release its brakes, put it into remote control, then call start")
        for line in meanwhile:
            simulated.ask_dashboard(line)
        assert simulated.state()["robot_mode"] == "RUNNING"
        # Attempts to connect would come every 0.1 s.
        rig.await_time(2.0)
        assert rig.loop.status.phase is Phase.STOPPED
        assert not {PROGRAM, MOVE_J} & set(rig.orders_since(0.0))
        assert simulated.state()["q_rad"] == pytest.approx(FAR, abs=1e-6)
        assert rig.loop.start()
        wait_for(lambda: MOVE_J in rig.orders_since(0.0), f"the way to the level pose, {rig.loop.status}")
