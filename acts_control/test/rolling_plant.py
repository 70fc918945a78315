# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A ball on a plate on two lagging wrist joints, and the skin under it: the controller without ROS meets it here."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from math import hypot, pi, sin

import numpy as np
from numpy.typing import NDArray

from acts_control.ball import (
    Ball,
    BallEstimator,
    BallReport,
    ContactMeasurement,
    EstimatorConfig,
    Phase,
    ReferenceReport,
    Trajectory,
    TrajectoryConfig,
)
from acts_control.ball.controller import BallController, ControlInput, ControllerConfig
from acts_core.robots import ur5e

STEP_S = 0.001
START_NS = 1_700_000_000_000_000_000
G = 9.81


@dataclass(frozen=True)
class PlantConfig:
    """The world; defaults are those of the simulated robot and ball.

    `height_m` is from the flange to where the ball feels the plate's turning: the skin's surface (20 mm) and 7/5 of the
    ball's radius. `partial` is how much of the contact is not found at the worst places, as it happens to subsampling.
    """

    x_m: float = 0.020
    y_m: float = -0.015
    height_m: float = 0.020 + 1.4 * 0.025
    lookahead_s: float = 0.05
    rolling_resistance: float = 0.005
    delay_s: float = 0.008
    noise_m: float = 0.0008
    ripple_m: float = 0.0
    no_contact: float = 0.02
    partial: float = 0.0
    level_error_rad: float = 0.0
    seed: int = 1


@dataclass
class Plant:
    """Steps of 1 ms."""

    config: PlantConfig
    q: list[float] = field(default_factory=lambda: list(ur5e.LEVEL_Q_RAD))
    command: list[float] = field(default_factory=lambda: list(ur5e.LEVEL_Q_RAD))

    def __post_init__(self) -> None:
        self.x, self.y, self.vx, self.vy = self.config.x_m, self.config.y_m, 0.0, 0.0
        self._speed = [0.0] * 6
        _, origin = self._plate()
        self._origins = [origin, origin]
        self._random = random.Random(self.config.seed)
        self._on_the_way: deque[tuple[float, ContactMeasurement]] = deque()

    # Plain floats: NumPy takes several times as long for three of them.
    def _plate(self) -> tuple[list[list[float]], list[float]]:
        """Rows of the rotation base <- skin, and where the ball feels the plate's turning [m]."""
        # A level pose that is a little off: the true pose differs from what the joints say.
        q = list(self.q)
        q[3] += self.config.level_error_rad
        rows = ur5e.forward_kinematics(q)[:3].tolist()
        return rows, [row[3] + self.config.height_m * row[2] for row in rows]

    def step(self) -> None:
        """Joints follow critically damped with w = 2 / lookahead; the ball rolls with 5/7 of what it feels."""
        w = 2.0 / self.config.lookahead_s
        for joint in (3, 4):
            acceleration = w * w * (self.command[joint] - self.q[joint]) - 2.0 * w * self._speed[joint]
            self._speed[joint] += STEP_S * acceleration
            self.q[joint] += STEP_S * self._speed[joint]
        rotation, origin = self._plate()
        before, last = self._origins
        self._origins = [last, origin]
        x, y, z = ((o - 2.0 * o1 + o0) / STEP_S**2 for o, o1, o0 in zip(origin, last, before, strict=True))
        # What it feels, in the base frame, then along the plate's axes.
        felt = (-x, -y, -G - z)
        self.vx += STEP_S * 5 / 7 * sum(row[0] * f for row, f in zip(rotation, felt, strict=True))
        self.vy += STEP_S * 5 / 7 * sum(row[1] * f for row, f in zip(rotation, felt, strict=True))
        speed, loss = hypot(self.vx, self.vy), 5 / 7 * G * self.config.rolling_resistance * STEP_S
        share = 1.0 - loss / speed if speed > loss else 0.0
        self.vx, self.vy = self.vx * share, self.vy * share
        self.x += STEP_S * self.vx
        self.y += STEP_S * self.vy

    def touch(self, time_s: float, clock_ns: int) -> ContactMeasurement | None:
        """Measure now, stamped with the clock of the stamps; what was measured `delay_s` ago arrives."""
        config, noise = self.config, self._random
        # Places where the samples hit only a part of the contact: the rest of it draws the centre to its side.
        missing = config.partial * max(sin(2 * pi * self.x / 0.023) * sin(2 * pi * self.y / 0.031), 0.0)
        ripple = [config.ripple_m * sin(2 * pi * place / 0.004375) for place in (self.x, self.y)]
        stamp_ns = clock_ns + round(noise.uniform(-1e-4, 1e-4) * 1e9)
        measured = ContactMeasurement(
            stamp_ns,
            noise.random() >= config.no_contact,
            self.x + 0.009 * missing + ripple[0] + noise.gauss(0.0, config.noise_m),
            self.y + ripple[1] + noise.gauss(0.0, config.noise_m),
            8.0 * (1.0 - missing) * noise.uniform(0.97, 1.03),
        )
        self._on_the_way.append((time_s + config.delay_s, measured))
        if self._on_the_way[0][0] <= time_s:
            return self._on_the_way.popleft()[1]
        return None


@dataclass
class Run:
    """What a run left behind, one row a millisecond."""

    time_s: NDArray[np.float64]
    error_mm: NDArray[np.float64]
    segment: list[str]
    tilt_deg: NDArray[np.float64]
    phases: list[Phase]

    def rms_mm(self, chosen: NDArray[np.bool_]) -> float:
        """Root mean square distance from the reference over the chosen rows."""
        return float(np.sqrt(np.mean(self.error_mm[chosen] ** 2)))

    def rms_of_mm(self, segment: str) -> float:
        """The same over a segment; a hold is counted from 2 s after its start."""
        chosen = np.array([name == segment for name in self.segment])
        if segment == "hold":
            chosen &= self.time_s > self.time_s[chosen][0] + 2.0
        return self.rms_mm(chosen)


def run(
    plant_config: PlantConfig | None = None,
    *,
    trajectory: str = "hold",
    seconds: float | None = None,
    controller_config: ControllerConfig | None = None,
    estimator_config: EstimatorConfig | None = None,
    trajectory_config: TrajectoryConfig | None = None,
    control_hz: int = 125,
    touch: Callable[[float, ContactMeasurement], ContactMeasurement | None] = lambda _time, measured: measured,
    at: Callable[[float, Plant], None] = lambda _time, _plant: None,
    refer: Callable[[float, ReferenceReport], ReferenceReport | None] = lambda _time, report: report,
    clock_off_s: Callable[[float], float] = lambda _time: 0.0,
) -> Run:
    """Close the loop as the nodes do: estimate at 1 kHz, control at `control_hz`, the trajectory while balancing.

    `touch` and `refer` may change or swallow what the skin and the trajectory say; `at` may meddle with the plant.
    `clock_off_s` is how far the clock of all stamps is off: where it steps, somebody has set it.
    """
    plant = Plant(plant_config or PlantConfig())
    controller = BallController(controller_config or ControllerConfig())
    estimator = BallEstimator(estimator_config or EstimatorConfig())
    plan = Trajectory(trajectory_config or TrajectoryConfig(trajectory=trajectory))
    every = round(1.0 / control_hz / STEP_S)
    report: BallReport | None = None
    referred: ReferenceReport | None = None
    clock_s = 0.0
    rows = round((plan.duration_s + 0.5 if seconds is None else seconds) / STEP_S)
    times, errors, segments, tilts, phases = np.zeros(rows), np.zeros(rows), [], np.zeros(rows), []
    for row in range(rows):
        time_s = row * STEP_S
        at(time_s, plant)
        plant.step()
        now_ns = START_NS + round((time_s + clock_off_s(time_s)) * 1e9)
        arrived = plant.touch(time_s, now_ns)
        arrived = touch(time_s, arrived) if arrived is not None else None
        if arrived is not None:
            estimator.step(arrived)
            s = estimator.state
            report = BallReport(s.stamp_ns, s.valid, Ball(s.x_m, s.y_m, s.vx_m_s, s.vy_m_s))
        reference = plan.at(clock_s)
        if row % every == 0:
            tilt = ur5e.tilt_of(plant.q)
            estimator.set_tilt(now_ns, *tilt)
            new = refer(time_s, ReferenceReport(now_ns, reference.reference))
            referred = new if new is not None else referred
            inputs = ControlInput(now_ns, report, referred, tilt)
            wanted = controller.step(inputs, 1.0 / control_hz)
            plant.command[3:5] = ur5e.wrist_angles_for_tilt(ur5e.LEVEL_Q_RAD, *wanted)
        if controller.state.phase is Phase.BALANCING:
            clock_s += STEP_S
        times[row] = time_s
        errors[row] = 1e3 * hypot(plant.x - reference.reference.x_m, plant.y - reference.reference.y_m)
        tilts[row] = np.rad2deg(hypot(*ur5e.tilt_of(plant.q)))
        segments.append("end" if reference.finished else reference.segment)
        phases.append(controller.state.phase)
    return Run(times, errors, segments, tilts, phases)
