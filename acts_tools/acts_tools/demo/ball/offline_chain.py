# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The whole chain without processes, clocks or ROS: joints, ball, skin, sampling, recovery, estimate, control.

The same modules as in the processes, stepped a millisecond at a time, so that the quality of control can be tested on
any machine, however busy. What scheduling and transport add is set as fixed delays.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from acts_control.ball import (
    Ball,
    BallController,
    BallEstimator,
    BallReport,
    ContactMeasurement,
    ControlInput,
    ControllerConfig,
    EstimatorConfig,
    ReferenceReport,
    TimedReference,
    Trajectory,
    TrajectoryConfig,
)
from acts_control.robots.ur import UrConfig
from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.robots import ur5e
from acts_core.sampling import SamplingConfig
from acts_recon.fusion import known_noise
from acts_recon.methods import Recovery
from acts_recon.settings import ReconstructionSettings
from acts_sim.ball import JointMotion, Phase, World, WorldConfig
from acts_sim.ur import ACCELERATION_LIMIT_RAD_S2, JointState, Servo
from acts_tools.demo.ball.recording import Recording
from acts_tools.firmware.board_sampler import BoardSampler

STEP_S = 0.001
_NS_PER_MS = 1_000_000
_SPEED_LIMIT_RAD_S = np.pi
_WRISTS = (3, 4)


@dataclass(frozen=True)
class Chain:
    """Settings of all stages.

    Attributes
    ----------
    scheme : str
        How the board samples.
    method : str
        How images are recovered, see `acts_recon.methods.METHODS`.
    touch_delay_ms, command_delay_ms : int
        From the last measurement to the estimate, and from the control step to the robot's servo.
    """

    world: WorldConfig = field(default_factory=lambda: WorldConfig(start_after_s=0.1))
    estimator: EstimatorConfig = field(default_factory=EstimatorConfig)
    controller: ControllerConfig = field(default_factory=ControllerConfig)
    robot: UrConfig = field(default_factory=UrConfig)
    trajectory: TrajectoryConfig = field(default_factory=TrajectoryConfig)
    scheme: str = "tracking"
    method: str = "fusion"
    threshold_counts: int = 60
    noise_counts: float = 1.5
    touch_delay_ms: int = 2
    command_delay_ms: int = 3
    seed: int = 1


def run(chain: Chain, limit_s: float = 60.0, show: Callable[[float], None] = lambda _: None) -> Recording:
    """Balance until the trajectory has ended, and call `show` with the time of the simulation [s] now and then.

    Returns
    -------
    Recording
        Truth and reference over time; `stop_reason` where it did not come to its end.
    """
    balancing = _Run(chain)
    control_every = round(1000 / chain.robot.control_rate_hz)
    for now_ms in range(1, round(limit_s / STEP_S)):
        if now_ms % 100 == 0:
            show(now_ms * STEP_S)
        balancing.move(now_ms)
        balancing.sense(now_ms)
        balancing.estimate(now_ms)
        if now_ms % control_every == 0:
            wanted = balancing.command(now_ms, control_every * STEP_S)
            if balancing.record(now_ms, wanted):
                break
    return balancing.recording


class _Run:
    """All stages, and what is under way between them.

    Parameters
    ----------
    chain : Chain

    Attributes
    ----------
    recording : Recording
    """

    def __init__(self, chain: Chain) -> None:
        self.recording = Recording()
        self._chain = chain
        self._random = np.random.default_rng(chain.seed)
        self._world = World(chain.world)
        geometry = ArrayGeometry()
        self._sampler = BoardSampler(
            SamplingConfig(chain.scheme, geometry.rows, geometry.cols, 55, threshold_counts=chain.threshold_counts)
        )
        settings = ReconstructionSettings(method=chain.method, noise_counts=known_noise(chain.noise_counts))
        self._recovery: Recovery = settings.recovery()
        self._estimator = BallEstimator(chain.estimator)
        self._controller = BallController(chain.controller)
        self._trajectory = Trajectory(chain.trajectory)
        self._joints = JointState(ur5e.LEVEL_Q_RAD, _SPEED_LIMIT_RAD_S, ACCELERATION_LIMIT_RAD_S2)
        self._servo = Servo()
        # Each with the time at which it arrives [ms].
        self._touches: deque[tuple[int, ContactMeasurement]] = deque()
        self._commands: deque[tuple[int, list[float]]] = deque([(0, list(ur5e.LEVEL_Q_RAD))])
        self._started_ms: int | None = None

    def move(self, now_ms: int) -> None:
        """A step of the robot, by the newest command that has arrived, and of the ball on it."""
        while self._commands and self._commands[0][0] <= now_ms:
            self._servo.set(self._commands.popleft()[1], self._chain.robot.servo_lookahead_s)
        self._servo.step(self._joints, STEP_S)
        motion = JointMotion(np.array(self._joints.q), np.array(self._joints.qd), np.array(self._joints.qdd))
        self._world.step(motion, STEP_S)

    def sense(self, now_ms: int) -> None:
        """Sample the skin, recover, and send the contact."""
        world, chain = self._world, self._chain
        noisy = world.counts + self._random.normal(0.0, chain.noise_counts, world.counts.shape)
        counts = np.clip(np.rint(noisy), 0, COUNT_MAX).astype(np.uint16)
        # Here a frame is taken at one instant.
        indices, values = self._sampler.frame(counts.reshape(1, *self._recovery.image.shape), 0.0, 0.0)
        contact = self._recovery.step(indices, values, now_ms * STEP_S, 0.0)
        touch = ContactMeasurement(now_ms * _NS_PER_MS, contact.in_contact, contact.x_m, contact.y_m, contact.force_n)
        self._touches.append((now_ms + chain.touch_delay_ms, touch))

    def estimate(self, now_ms: int) -> None:
        """Update the estimate by the contacts that have arrived."""
        while self._touches and self._touches[0][0] <= now_ms:
            self._estimator.step(self._touches.popleft()[1])

    def command(self, now_ms: int, dt_s: float) -> TimedReference:
        """A step of the controller: send the robot how the plate is to be tilted; return what the ball is to follow."""
        stamp_ns = now_ms * _NS_PER_MS
        tilt = ur5e.tilt_of(self._joints.q)
        self._estimator.set_tilt(stamp_ns, *tilt)
        estimate = self._estimator.state
        ball = Ball(estimate.x_m, estimate.y_m, estimate.vx_m_s, estimate.vy_m_s)
        report = BallReport(estimate.stamp_ns, estimate.valid, ball)
        wanted = self._trajectory.at(0.0 if self._started_ms is None else (now_ms - self._started_ms) * STEP_S)
        reference = ReferenceReport(stamp_ns, wanted.reference)
        aim = self._controller.step(ControlInput(stamp_ns, report, reference, tilt), dt_s)
        q_rad = list(ur5e.LEVEL_Q_RAD)
        q_rad[_WRISTS[0]], q_rad[_WRISTS[1]] = ur5e.wrist_angles_for_tilt(ur5e.LEVEL_Q_RAD, *aim)
        self._commands.append((now_ms + self._chain.command_delay_ms, q_rad))
        return wanted

    def record(self, now_ms: int, wanted: TimedReference) -> bool:
        """Record where the ball is and is to be; whether that was the end, well or not."""
        recording = self.recording
        if self._controller.state.phase.name != "BALANCING":
            if self._started_ms is None:
                return False
            recording.stop_reason = self._controller.state.reason
            return True
        if self._started_ms is None:
            self._started_ms = now_ms
        state = self._world.state
        if state.phase is not Phase.ROLLING:
            recording.stop_reason = f"the ball is {state.phase.value}"
            return True
        seconds = now_ms * STEP_S
        recording.truth.add(seconds, state.ball.x_m, state.ball.y_m)
        recording.reference.add(seconds, wanted.reference.x_m, wanted.reference.y_m)
        recording.segments.append(wanted.segment)
        pressure = recording.segment_pressure.setdefault(wanted.segment, np.zeros(self._recovery.image.shape))
        pressure += self._recovery.image
        recording.finished = wanted.finished
        return wanted.finished
