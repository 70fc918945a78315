# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Balancing of a ball on a plate that a robot carries.

In come contacts and references; out come the plate's tilt and, by the loop, the robot's motion. Estimator, controller,
limits and trajectories know neither ROS nor the robot.
"""

from acts_control.ball.controller import BallController, BallReport, ControlInput, ControllerConfig, Phase
from acts_control.ball.estimator import BallEstimator, ContactMeasurement, EstimatorConfig
from acts_control.ball.loop import ControlLoop, LoopConfig, LoopStatus
from acts_control.ball.pid import Ball
from acts_control.ball.reference import Reference, ReferenceReport
from acts_control.ball.trajectory import TimedReference, Trajectory, TrajectoryConfig

__all__ = [
    "Ball",
    "BallController",
    "BallEstimator",
    "BallReport",
    "ContactMeasurement",
    "ControlInput",
    "ControlLoop",
    "ControllerConfig",
    "EstimatorConfig",
    "LoopConfig",
    "LoopStatus",
    "Phase",
    "Reference",
    "ReferenceReport",
    "TimedReference",
    "Trajectory",
    "TrajectoryConfig",
]
