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
    Trajectory,
    TrajectoryConfig,
)
from acts_control.robots.ur import UrConfig
from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.robots import ur5e
from acts_core.sampling import SamplingConfig
from acts_recon.fusion import known_noise
from acts_recon.settings import ReconstructionSettings
from acts_sim.ball import JointMotion, Phase, World, WorldConfig
from acts_sim.ur import JointState, Servo
from acts_tools.demo.ball.recording import Recording
from acts_tools.firmware.board_sampler import BoardSampler

STEP_S = 0.001
_SPEED_LIMIT_RAD_S = np.pi
_ACCELERATION_LIMIT_RAD_S2 = 40.0
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
    rng = np.random.default_rng(chain.seed)
    geometry = ArrayGeometry()
    world = World(chain.world)
    sampler = BoardSampler(
        SamplingConfig(chain.scheme, geometry.rows, geometry.cols, 55, threshold_counts=chain.threshold_counts)
    )
    recovery = ReconstructionSettings(method=chain.method, noise_counts=known_noise(chain.noise_counts)).recovery()
    estimator = BallEstimator(chain.estimator)
    controller = BallController(chain.controller)
    trajectory = Trajectory(chain.trajectory)
    joints = JointState(ur5e.LEVEL_Q_RAD, _SPEED_LIMIT_RAD_S, _ACCELERATION_LIMIT_RAD_S2)
    servo = Servo()
    control_every = round(1000 / chain.robot.control_rate_hz)
    touches: deque[tuple[int, ContactMeasurement]] = deque()
    commands: deque[tuple[int, list[float]]] = deque([(0, list(ur5e.LEVEL_Q_RAD))])
    recording = Recording()
    started_ms: int | None = None
    for now_ms in range(1, round(limit_s / STEP_S)):
        if now_ms % 100 == 0:
            show(now_ms * STEP_S)
        while commands and commands[0][0] <= now_ms:
            servo.set(commands.popleft()[1], chain.robot.servo_lookahead_s)
        servo.step(joints, STEP_S)
        motion = JointMotion(np.array(joints.q), np.array(joints.qd), np.array(joints.qdd))
        state = world.step(motion, STEP_S)

        noisy = world.counts + rng.normal(0.0, chain.noise_counts, world.counts.shape)
        counts = np.clip(np.rint(noisy), 0, COUNT_MAX).astype(np.uint16)
        # Here a frame is taken at one instant.
        indices, values = sampler.frame(counts.reshape(1, geometry.rows, geometry.cols), 0.0, 0.0)
        contact = recovery.step(indices, values, now_ms * STEP_S, 0.0)
        stamp_ns = now_ms * 1_000_000
        measurement = ContactMeasurement(stamp_ns, contact.in_contact, contact.x_m, contact.y_m, contact.force_n)
        touches.append((now_ms + chain.touch_delay_ms, measurement))
        while touches and touches[0][0] <= now_ms:
            estimator.step(touches.popleft()[1])

        if now_ms % control_every:
            continue
        tilt = ur5e.tilt_of(joints.q)
        estimator.set_tilt(stamp_ns, *tilt)
        estimate = estimator.state
        ball = Ball(estimate.x_m, estimate.y_m, estimate.vx_m_s, estimate.vy_m_s)
        time_s = 0.0 if started_ms is None else (now_ms - started_ms) * STEP_S
        wanted = trajectory.at(time_s)
        report = ReferenceReport(stamp_ns, wanted.reference)
        aim = controller.step(
            ControlInput(stamp_ns, BallReport(estimate.stamp_ns, estimate.valid, ball), report, tilt),
            control_every * STEP_S,
        )
        q_rad = list(ur5e.LEVEL_Q_RAD)
        q_rad[_WRISTS[0]], q_rad[_WRISTS[1]] = ur5e.wrist_angles_for_tilt(ur5e.LEVEL_Q_RAD, *aim)
        commands.append((now_ms + chain.command_delay_ms, q_rad))

        if controller.state.phase.name != "BALANCING":
            if started_ms is not None:
                recording.stop_reason = controller.state.reason
                break
            continue
        if started_ms is None:
            started_ms = now_ms
        if state.phase is not Phase.ROLLING:
            recording.stop_reason = f"the ball is {state.phase.value}"
            break
        seconds = now_ms * STEP_S
        recording.truth.add(seconds, state.ball.x_m, state.ball.y_m)
        recording.reference.add(seconds, wanted.reference.x_m, wanted.reference.y_m)
        recording.segments.append(wanted.segment)
        pressure = recording.segment_pressure.setdefault(wanted.segment, np.zeros(recovery.image.shape))
        pressure += recovery.image
        if wanted.finished:
            recording.finished = True
            break
    return recording
