# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Any message, finite or not, of any time: the tilt keeps its limits, and with good input the ball is held again.

ROS_DOMAIN_ID 173.
"""

from __future__ import annotations

from math import hypot, isfinite
from typing import Any, NamedTuple

import pytest
import rclpy
from geometry_msgs.msg import Vector3Stamped
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rclpy.context import Context

from acts_control.ball import (
    Ball,
    BallEstimator,
    BallReport,
    ContactMeasurement,
    EstimatorConfig,
    Phase,
    Reference,
    ReferenceReport,
)
from acts_control.ball.controller import BallController, ControlInput, ControllerConfig
from acts_control.ball.nodes.ball_control_node import BallControlNode
from acts_control.ball.nodes.ball_state_node import BallStateNode
from acts_control.ball.nodes.ball_trajectory_node import BallTrajectoryNode
from acts_control.ball.plate import acceleration_of
from acts_control.robots.base import TiltGate
from acts_msgs.msg import BalanceStatus, BallReference, BallState
from acts_ros.messages import ContactFields, write_contact

DT = 0.008
DT_NS = 8_000_000
START_NS = 1_700_000_000_000_000_000
EPSILON = 1e-9

# Longer than the bad input lasts: that motion ends when touch stays away is tested elsewhere.
CONFIG = ControllerConfig(lever_arm_m=0.0, touch_stop_after_s=10.0, engage_after_s=0.05)

# Mostly within a plate's reach, where it does the most harm.
NUMBERS = st.one_of(st.floats(-0.1, 0.1), st.floats(-3.0, 3.0), st.floats(), st.sampled_from([1e6, -1e300]))
OFF_NS = st.one_of(
    st.just(0),
    st.integers(-200_000_000, 200_000_000),
    st.sampled_from([-3_600_000_000_000, 900_000_000, 3_600_000_000_000]),
    st.integers(-START_NS, 2**62 - START_NS),
)


class Bad(NamedTuple):
    """What one step is given: each with how far its stamp is off; and by how much the clock was set."""

    ball: tuple[int, bool, Ball] | None
    reference: tuple[int, Reference] | None
    contacts: list[tuple[int, ContactMeasurement]]
    tilts: list[tuple[int, tuple[float, float]]]
    clock_step_ns: int


BALLS = st.builds(Ball, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
REFERENCES = st.builds(Reference, NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS, NUMBERS)
CONTACTS = st.builds(ContactMeasurement, st.just(0), st.booleans(), NUMBERS, NUMBERS, NUMBERS)
STEPS = st.builds(
    Bad,
    st.none() | st.tuples(OFF_NS, st.booleans(), BALLS),
    st.none() | st.tuples(OFF_NS, REFERENCES),
    st.lists(st.tuples(OFF_NS, CONTACTS), max_size=4),
    st.lists(st.tuples(OFF_NS, st.tuples(NUMBERS, NUMBERS)), max_size=2),
    st.sampled_from([0, 0, 0, -3_600_000_000_000, -100_000_000, 3_600_000_000_000]),
)


class Loop:
    """Estimator and controller on a ball on a plate that turns about it, both without delay."""

    def __init__(self) -> None:
        self.controller = BallController(CONFIG)
        self.gate = TiltGate(CONFIG)
        self.estimator = BallEstimator(EstimatorConfig(lever_arm_m=0.0))
        self.now_ns = START_NS
        self.tilt = self.rate = (0.0, 0.0)
        self.ball: BallReport | None = None
        self.reference: ReferenceReport | None = None
        self.x = self.y = self.vx = self.vy = 0.0

    def step(self) -> None:
        self.now_ns += DT_NS
        inputs = ControlInput(self.now_ns, self.ball, self.reference, self.tilt)
        tilt = self.controller.step(inputs, DT)
        assert all(map(isfinite, tilt))
        assert self.gate.fault(tilt, DT) == ""
        self.gate.sent(tilt)
        assert hypot(*tilt) <= CONFIG.max_tilt_rad + EPSILON
        for new, old in zip(tilt, self.tilt, strict=True):
            assert abs(new - old) <= CONFIG.max_tilt_rate_rad_s * DT + EPSILON
        self.tilt = tilt

    def estimated(self) -> BallReport:
        state = self.estimator.state
        return BallReport(state.stamp_ns, state.valid, Ball(state.x_m, state.y_m, state.vx_m_s, state.vy_m_s))

    def bad(self, given: Bad, *, through_estimator: bool) -> None:
        self.now_ns += given.clock_step_ns
        for off_ns, contact in given.contacts:
            self.estimator.step(contact._replace(stamp_ns=self.now_ns + off_ns))
        for off_ns, tilt in given.tilts:
            self.estimator.set_tilt(self.now_ns + off_ns, *tilt)
        if through_estimator:
            self.ball = self.estimated()
        elif given.ball is not None:
            off_ns, valid, ball = given.ball
            self.ball = BallReport(self.now_ns + off_ns, valid, ball)
        if given.reference is not None:
            off_ns, reference = given.reference
            self.reference = ReferenceReport(self.now_ns + off_ns, reference)
        self.step()

    def good(self) -> None:
        """One step with a true ball, contacts every 2 ms."""
        ax, ay = acceleration_of(*self.tilt)
        self.estimator.set_tilt(self.now_ns, *self.tilt)
        for k in range(4):
            self.vx, self.vy = self.vx + DT / 4 * ax, self.vy + DT / 4 * ay
            self.x, self.y = self.x + DT / 4 * self.vx, self.y + DT / 4 * self.vy
            stamp_ns = self.now_ns + (k + 1) * DT_NS // 4
            self.estimator.step(ContactMeasurement(stamp_ns, True, self.x, self.y, 8.0))
        self.ball = self.estimated()
        self.reference = ReferenceReport(self.now_ns + DT_NS, Reference(0.0, 0.0))
        self.step()


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(STEPS, max_size=15), st.booleans())
def test_after_any_input_the_ball_is_held_again(bad: list[Bad], through_estimator: bool) -> None:
    loop = Loop()
    for _ in range(20):
        loop.good()
    assert loop.controller.state.phase is Phase.BALANCING
    for step in bad:
        loop.bad(step, through_estimator=through_estimator)
    # Somebody puts the ball back where it may have rolled off.
    loop.x, loop.y, loop.vx, loop.vy = 0.020, -0.015, 0.0, 0.0
    for _ in range(round(2.5 / DT)):
        loop.good()
    assert loop.controller.state.reason == "balancing"
    assert hypot(loop.x, loop.y) < 0.003


# --- the nodes' own callbacks


class NoRobot:
    """Nobody connects to it: the control loop is not launched."""

    address = "nowhere"


class Nodes:
    """The three nodes, and a controller at the place of the control loop's thread."""

    def __init__(self, context: Context) -> None:
        arguments: dict[str, Any] = {"context": context, "namespace": "/plate"}
        self.control = BallControlNode(lambda _settings: NoRobot(), **arguments)  # type: ignore[arg-type, return-value]
        self.state = BallStateNode(**arguments)
        self.trajectory = BallTrajectoryNode(**arguments)
        self.all = (self.control, self.state, self.trajectory)


@pytest.fixture(scope="module")
def nodes() -> Any:
    context = Context()
    rclpy.init(context=context, domain_id=173)
    nodes = Nodes(context)
    yield nodes
    for node in nodes.all:
        node.destroy_node()
    rclpy.try_shutdown(context=context)


FLOAT32 = st.floats(width=32)
UINT32 = st.integers(0, 2**32 - 1)
STAMPS = st.one_of(st.tuples(st.integers(-(2**31), 2**31 - 1), UINT32), st.just((2**31 - 1, 2**32 - 1)))


def stamped(message: Any, stamp: tuple[int, int]) -> Any:
    message.header.stamp.sec, message.header.stamp.nanosec = stamp
    return message


def placed(message: Any, numbers: list[float]) -> Any:
    for vector, (x, y, z) in zip(
        [getattr(message, name) for name in ("position", "velocity", "acceleration") if hasattr(message, name)],
        (numbers[0:3], numbers[3:6], numbers[6:9]),
        strict=False,
    ):
        vector.x, vector.y, vector.z = x, y, z
    return message


def raw_contact(stamp: tuple[int, int], numbers: list[float], small: list[float], touched: bool) -> bytes:
    first, last = (small[0], small[1], small[2]), (numbers[2], numbers[3], small[4], small[5], small[6])
    fields = ContactFields(0, "plate", 7, touched, numbers[0], numbers[1], *first, 5, small[3], *last)
    data = bytearray(write_contact(fields))
    data[4:12] = stamp[0].to_bytes(4, "little", signed=True) + stamp[1].to_bytes(4, "little")
    return bytes(data)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    st.lists(STAMPS, min_size=5, max_size=5),
    st.lists(st.one_of(NUMBERS, st.floats()), min_size=9, max_size=9),
    st.lists(FLOAT32, min_size=7, max_size=7),
    st.booleans(),
    st.integers(0, 255),
    st.binary(max_size=200),
)
def test_no_message_ends_a_node_and_none_gets_a_tilt_beyond_its_limits(
    nodes: Nodes,
    stamps: list[tuple[int, int]],
    numbers: list[float],
    small: list[float],
    flag: bool,
    state: int,
    junk: bytes,
) -> None:
    control, ball_state, trajectory = nodes.all
    control._on_state(placed(stamped(BallState(valid=flag), stamps[0]), numbers))
    control._on_reference(placed(stamped(BallReference(), stamps[1]), numbers))
    ball_state._on_tilt(stamped(Vector3Stamped(), stamps[2]))
    for data in (
        raw_contact(stamps[3], numbers, small, flag),
        raw_contact(stamps[4], [0.0] * 9, [1.0] * 7, True),
        junk,
    ):
        ball_state._take(data, START_NS, is_heard=True)
    ball_state._publish_statistics()
    trajectory._on_status(stamped(BalanceStatus(state=state), stamps[4]))
    trajectory._on_timer()
    for node in nodes.all:
        node._report() if hasattr(node, "_report") else None
    loop = Loop()
    loop.ball, loop.reference = control._loop.ball, control._loop.reference
    for _ in range(30):
        loop.step()
