# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The robot of docs/extending.md, as it stands on the page: a table of two axes balances a ball. ROS_DOMAIN_ID 171.

Time is that of the simulation: nothing waits, and every run is the same.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import pairwise
from math import hypot, isfinite
from pathlib import Path
from typing import Any

import pytest
import rclpy
from rclpy.context import Context
from rclpy.parameter import Parameter
from tilting_table import LEVER_ARM_M, SimulatedTable
from waiting import wait_for

from acts_control.ball import (
    Ball,
    BallEstimator,
    BallReport,
    ControlLoop,
    EstimatorConfig,
    LoopConfig,
    LoopStatus,
    Phase,
    Reference,
    ReferenceReport,
)
from acts_control.ball.nodes.ball_control_node import BallControlNode
from acts_control.robots import ROBOTS, RobotKind, make_robot, with_robots
from acts_control.robots.base import CommandRefusedError, Robot
from acts_core.errors import RobotError, SettingsError

# A plate that is turned to and fro as fast as its settings allow.
HASTY = {
    "max_tilt_rad": 0.17,
    "table_reach_rad": 0.2,
    "max_tilt_rate_rad_s": 3.0,
    "max_tilt_acceleration_rad_s2": 40.0,
    "kp": 80.0,
}

FAST_RAD_S = 2.2
PERIOD_S = 0.008

PAGE = (Path(__file__).parents[3] / "docs" / "extending.md").read_text()
DEADLINE_S = 60.0
NAME = "tilting_table"


def longest_step_rad(aims: Sequence[tuple[float, float]]) -> float:
    """Of two tilts that follow each other, how far the axis turned that turned farther; 0 where there are not two."""
    return max(
        (abs(b - a) for first, second in pairwise(aims) for a, b in zip(first, second, strict=True)), default=0.0
    )


@pytest.fixture
def table() -> SimulatedTable:
    return SimulatedTable()


@pytest.fixture
def names(monkeypatch: pytest.MonkeyPatch, table: SimulatedTable) -> dict[str, Any]:
    """What the page's module defines; its line is in the registry, on the simulated motors."""
    section = re.split(r"^## A robot$", PAGE, flags=re.MULTILINE)[1].split("\n## ")[0]
    (code,) = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    names: dict[str, Any] = {"__name__": __name__, "RobotKind": RobotKind, "open_motors": lambda port: table}
    # Its own future annotations count, not those of this file.
    exec(compile(code, "extending.md", "exec", dont_inherit=True), names)
    (line,) = re.findall(r"^The line, in .*: `(.*),`\.$", section, re.MULTILINE)
    ((name, kind),) = eval("{" + line + "}", names).items()
    assert name == NAME
    monkeypatch.setitem(ROBOTS, name, kind)
    return names


@pytest.fixture
def robot(names: dict[str, Any]) -> Robot:
    return make_robot(with_robots(LoopConfig)(robot=NAME))


class Run:
    """A run of the control loop on the table: contacts of the simulated skin, and the centre as reference."""

    def __init__(
        self,
        table: SimulatedTable,
        until_s: float,
        at: Callable[[float, ControlLoop], None] = lambda _time_s, _loop: None,
        **others: float,
    ) -> None:
        self.table = table
        self.places_m: list[tuple[float, float, float]] = []
        self.phases: list[Phase] = []
        self._estimator = BallEstimator(EstimatorConfig(lever_arm_m=LEVER_ARM_M))
        self._until_s = until_s
        self._at = at
        table.on_contact = self._estimator.step
        settings = with_robots(LoopConfig)(robot=NAME, lever_arm_m=LEVER_ARM_M, **others)
        self.loop = ControlLoop(
            settings,
            make_robot(settings),
            table.now_ns,
            lambda now_ns, tilt: self._estimator.set_tilt(now_ns, *tilt),
            steady_s=table.steady_s,
            sleep=table.sleep,
        )
        self.loop.look = self._look
        self.loop.launch()
        wait_for(
            lambda: table.time_s > 0.0 and self.loop.status.phase is Phase.STOPPED,
            timeout_s=DEADLINE_S,
            state=lambda: self.loop.status,
        )
        self.status: LoopStatus = self.loop.status
        self.loop.close()

    def _look(self, phase: Phase) -> None:
        state, table = self._estimator.state, self.table
        self.loop.ball = BallReport(state.stamp_ns, state.valid, Ball(state.x_m, state.y_m, state.vx_m_s, state.vy_m_s))
        self.loop.reference = ReferenceReport(table.now_ns(), Reference(0.0, 0.0))
        self.places_m.append((table.time_s, *table.place_m))
        self.phases.append(phase)
        self._at(table.time_s, self.loop)
        if table.time_s > self._until_s:
            self.loop.stop("the time is up")

    def farthest_m(self, from_s: float) -> float:
        """Farthest from the centre that the ball was from a time on."""
        return max(hypot(x, y) for time_s, x, y in self.places_m if time_s > from_s)


def test_a_table_of_two_axes_balances_a_ball(names: dict[str, Any], table: SimulatedTable) -> None:
    run = Run(table, until_s=6.0)
    assert run.status.reason == "the time is up"
    assert Phase.BALANCING in run.phases
    assert run.farthest_m(0.0) > 0.02
    assert run.farthest_m(3.5) < 0.003
    # Level at the end, and switched off.
    assert run.status.tilt_commanded_rad == pytest.approx((0.0, 0.0), abs=1e-5)
    assert len(run.status.joints) == 2
    assert max(map(abs, table.angles)) < 1e-3
    assert not table.is_on


def test_stale_touch_levels_and_stops_it(names: dict[str, Any], table: SimulatedTable) -> None:
    tilts: list[float] = []
    table.is_silent = lambda time_s: time_s > 1.2
    run = Run(table, until_s=20.0, at=lambda *_moment: tilts.append(max(map(abs, table.angles))))
    assert run.status.reason.startswith("touch is stale: the newest is 3.")
    times_s = [time_s for time_s, _, _ in run.places_m]
    moments = list(zip(times_s, tilts, strict=True))
    assert max(tilt for time_s, tilt in moments if 0.6 < time_s < 1.2) > 0.01
    assert max(tilt for time_s, tilt in moments if time_s > 2.0) < 1e-3
    assert run.phases[-1] is Phase.BALANCING
    assert 4.0 < times_s[-1] < 5.5
    assert not table.is_on


def test_where_touch_returns_the_ball_is_balanced_again(names: dict[str, Any], table: SimulatedTable) -> None:
    table.is_silent = lambda time_s: 2.0 < time_s < 2.5
    run = Run(table, until_s=6.5)
    assert run.status.reason == "the time is up"
    assert run.farthest_m(5.0) < 0.003


def test_a_late_cycle_makes_up_for_no_more_than_the_motors_may_turn_at_once(
    names: dict[str, Any], table: SimulatedTable
) -> None:
    def hold_up(time_s: float, _loop: ControlLoop) -> None:
        if 0.5 < time_s < 1.5 and longest_step_rad(table.aims[-2:]) > FAST_RAD_S * PERIOD_S:
            table.sleep(0.03)

    run = Run(table, until_s=4.0, at=hold_up, **HASTY)
    assert run.status.reason == "the time is up"
    steps = [longest_step_rad(pair) for pair in pairwise(table.aims)]
    assert 0.04 < max(steps) <= 0.05


def test_a_late_cycle_right_after_the_rate_was_lowered_counts_with_the_rate_that_the_plate_still_has(
    names: dict[str, Any], table: SimulatedTable
) -> None:
    settings = {**HASTY, "max_tilt_acceleration_rad_s2": 20.0, "table_step_rad": 0.035}
    slower = with_robots(LoopConfig)(robot=NAME, lever_arm_m=LEVER_ARM_M, **{**settings, "max_tilt_rate_rad_s": 0.5})
    lowered: list[float] = []

    def lower_and_hold_up(time_s: float, loop: ControlLoop) -> None:
        if time_s > 0.5 and not lowered and longest_step_rad(table.aims[-2:]) > FAST_RAD_S * PERIOD_S:
            lowered.append(time_s)
            loop.change(slower)
            table.sleep(0.03)

    run = Run(table, until_s=4.0, at=lower_and_hold_up, **settings)
    assert lowered
    assert run.status.reason == "the time is up"


def test_a_cable_that_is_pulled_ends_motion_and_nothing_more_is_sent(
    names: dict[str, Any], table: SimulatedTable
) -> None:
    def pull(time_s: float, _loop: ControlLoop) -> None:
        table.is_gone = time_s > 2.0

    run = Run(table, until_s=9.0, at=pull)
    assert run.status.reason == "tilting table at /dev/ttyACM0: no such device"
    assert table.is_on  # by whoever is at the table: nothing can be sent to it


def test_a_controller_gone_wrong_is_caught_by_the_gates(
    names: dict[str, Any], table: SimulatedTable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("acts_control.ball.loop.BallController.step", lambda self, inputs, dt: (float("nan"), 0.0))
    run = Run(table, until_s=9.0)
    assert run.status.reason.startswith("tilt = (nan, 0.0) rad")
    assert all(isfinite(angle) for aim in table.aims for angle in aim)


@pytest.mark.parametrize("tilt", [(float("nan"), 0.0), (0.0, float("inf")), (0.2, 0.0), (0.0, -0.06)])
def test_its_own_check_refuses_what_its_motors_must_not_do(
    robot: Robot, table: SimulatedTable, tilt: tuple[float, float]
) -> None:
    robot.connect(lambda: True)
    with pytest.raises(CommandRefusedError):
        robot.tilt(*tilt)
    assert table.aims == []


def test_tilts_become_angles_and_back(robot: Robot, table: SimulatedTable) -> None:
    robot.connect(lambda: True)
    for tilt in ((0.04, 0.0), (0.06, -0.04), (0.05, -0.08)):
        table.angles = list(robot.tilt(*tilt))
        assert robot.read().tilt_rad == pytest.approx(tilt, abs=1e-12)
    robot.disconnect()
    with pytest.raises(RobotError, match="not connected"):
        robot.read()


def test_a_simulated_skin_does_not_move_it(names: dict[str, Any]) -> None:
    with pytest.raises(SettingsError, match=r"robot = 'tilting_table': nothing is controlled.*sim:=false"):
        with_robots(LoopConfig)(robot=NAME, loopback_only=True)


def test_the_node_has_its_settings_as_parameters_and_tells_two_joints(names: dict[str, Any]) -> None:
    context = Context()
    rclpy.init(context=context, domain_id=171)
    try:
        chosen = [Parameter("robot", value=NAME), Parameter("table_step_rad", value=0.04)]
        node = BallControlNode(context=context, parameter_overrides=chosen)
        assert node.get_parameter("table_step_rad").value == 0.04
        assert node.get_parameter("robot_ip").value == "127.0.0.1"
        node._loop.status = LoopStatus(joints=(0.01, -0.02))
        node._publish_status()
        assert list(node._status.joints_commanded) == [0.01, -0.02]
        node.destroy_node()
    finally:
        rclpy.try_shutdown(context=context)
