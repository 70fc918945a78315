# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Parameters of the control nodes that change while they run, and what they log; ROS_DOMAIN_ID 188."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter

from acts_control.ball import LoopStatus, Phase
from acts_control.ball.nodes.ball_control_node import BallControlNode
from acts_control.ball.nodes.ball_state_node import BallStateNode
from acts_control.ball.nodes.ball_trajectory_node import BallTrajectoryNode
from acts_control.robots.base import RobotReading
from acts_core.errors import RobotError, SettingsError
from acts_ros.diagnostics import ERROR, OK, WARN


class NoArm:
    """Is never there."""

    address = "nowhere"
    is_busy = False
    longest_step_rad = 0.05

    def connect(self, is_wanted: Callable[[], bool]) -> None:
        raise RobotError("no arm")

    def read(self) -> RobotReading:
        raise RobotError("no arm")

    def begin_levelling(self) -> float:
        raise RobotError("no arm")

    def end_levelling(self) -> None: ...

    def tilt(self, tilt_x_rad: float, tilt_y_rad: float) -> tuple[float, ...]:
        raise RobotError("no arm")

    def end_tilting(self) -> None: ...

    def release(self) -> None: ...

    def disconnect(self) -> None: ...


@pytest.fixture
def context() -> Iterator[Context]:
    context = Context()
    rclpy.init(context=context, domain_id=188)
    yield context
    rclpy.try_shutdown(context=context)


def change(node: Node, **values: object) -> str:
    """Set parameters together; why not, or nothing."""
    result = node.set_parameters_atomically([Parameter(name, value=value) for name, value in values.items()])
    assert result.successful or result.reason
    return str(result.reason)


def test_gains_and_limits_of_control(context: Context) -> None:
    node = BallControlNode(lambda _settings: NoArm(), context=context)
    assert change(node, kp=20.0, kd=8.0, max_tilt_rad=0.08, max_tilt_rate_rad_s=0.5, status_rate_hz=100.0) == ""
    assert "kp" in change(node, kp=-1.0)
    # What fits alone does not fit together with the rest: the last look at the joints would trip over it.
    assert "max_wrist_offset_rad = 0.14: allowed is 0.33" in change(node, max_tilt_rad=0.3)
    # Nothing of it: they are set together.
    assert "max_tilt_rad" in change(node, ki=1.0, max_tilt_rad=9.0)
    for fixed in ("robot_ip", "control_rate_hz", "max_wrist_offset_rad", "touch_stale_after_s", "level_q_rad"):
        assert change(node, **{fixed: node.get_parameter(fixed).value})
    values = {name: node.get_parameter(name).value for name in ("kp", "ki", "kd", "max_tilt_rad")}
    assert values == {"kp": 20.0, "ki": 15.0, "kd": 8.0, "max_tilt_rad": 0.08}
    assert 10_000_000 in [timer.timer_period_ns for timer in node.timers]
    node.destroy_node()


@pytest.mark.parametrize("is_driven", [True, False])
def test_rates_of_state_and_trajectory(context: Context, is_driven: bool) -> None:
    for kind in (BallStateNode, BallTrajectoryNode):
        node = kind(is_driven=is_driven, context=context)
        assert change(node, publish_rate_hz=50.0) == ""
        assert (20_000_000 in [timer.timer_period_ns for timer in node.timers]) is not is_driven
        assert change(node, publish_rate_hz=0.0)
        node.destroy_node()


def test_the_estimator_takes_its_settings_in_force(context: Context) -> None:
    node = BallStateNode(context=context)
    assert change(node, measurement_sigma_m=0.004, gate_reset_s=0.1) == ""
    assert change(node, lever_arm_m=0.1)
    assert "gate_sigmas" in change(node, gate_sigmas=0.5)
    node.destroy_node()


def test_estimator_and_controller_with_different_lever_arms_do_not_work_together(context: Context) -> None:
    state = BallStateNode(is_driven=True, context=context, parameter_overrides=[Parameter("lever_arm_m", value=0.12)])
    trajectory = BallTrajectoryNode(is_driven=True, context=context)
    control = BallControlNode(lambda _: NoArm(), subscribes=False, context=context)
    with pytest.raises(SettingsError, match=r"lever_arm_m: ball_state has 0\.12 and ball_control 0\.155"):
        control.follow(state, trajectory)
    for node in (control, trajectory, state):
        node.destroy_node()


def test_a_reason_that_comes_and_goes_is_logged_now_and_then_and_a_state_always(
    context: Context, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    now_s = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now_s[0])
    node = BallControlNode(lambda _settings: NoArm(), context=context)

    def logged(phase: Phase, *reasons: str) -> str:
        for reason in reasons:
            node._loop.status = LoopStatus(phase=phase, reason=reason)
            node._publish_status()
            now_s[0] += 0.02
        return capfd.readouterr().err

    assert "waiting: for touch" in logged(Phase.WAITING, "for touch")
    assert 4 <= logged(Phase.WAITING, *["for a ball", "for touch"] * 50).count("waiting: ") <= 6
    assert logged(Phase.WAITING, *["neither"] * 100).count("waiting: neither") == 1
    assert "balancing: well" in logged(Phase.BALANCING, "well")
    assert "stopped: no data" in logged(Phase.STOPPED, "no data")
    node.destroy_node()


def test_the_diagnostics_warn_while_there_is_no_touch_that_counts(context: Context) -> None:
    node = BallControlNode(lambda _settings: NoArm(), context=context)

    def level(phase: Phase, touch_age_s: float) -> int:
        node._loop.status = LoopStatus(phase=phase, reason="a reason", touch_age_s=touch_age_s)
        level, words, _values = node._report()
        assert words.endswith(": a reason")
        return level

    for phase in (Phase.WAITING, Phase.BALANCING):
        assert [level(phase, age_s) for age_s in (0.1, 0.3, math.inf)] == [OK, WARN, WARN]
    assert level(Phase.HOMING, math.inf) == OK  # nobody has looked yet
    assert level(Phase.STOPPED, 0.1) == ERROR
    node.destroy_node()


def test_the_diagnostics_warn_while_the_reference_is_not_followed(context: Context) -> None:
    node = BallControlNode(lambda _settings: NoArm(), context=context)

    def level(phase: Phase, reference_problem: str) -> int:
        node._loop.status = LoopStatus(phase=phase, touch_age_s=0.0, reference_problem=reference_problem)
        level, _words, _values = node._report()
        return level

    for phase in (Phase.WAITING, Phase.BALANCING):
        assert [level(phase, problem) for problem in ("", "the reference is stale")] == [OK, WARN]
    assert level(Phase.HOMING, "the reference is stale") == OK  # nobody has looked yet
    assert level(Phase.STOPPED, "the reference is stale") == ERROR
    node.destroy_node()
