# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated world of the ball-balancing task: arm, plate, ball and skin.

In each step, the joints move the plate, the plate moves the ball, and the ball presses the taxels. It depends on no
clock and no process: the same seed and joints give the same states.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from acts_core.array import ArrayGeometry
from acts_core.errors import SettingsError
from acts_core.robots import ur5e
from acts_core.settings import setting, validate
from acts_core.skin import LAYOUTS, NO_PATCH, Layout, layout
from acts_sim.ball import ball, ball_plate
from acts_sim.ball.ball import BallConfig, BallState
from acts_sim.ball.ball_contact import BallContact, ContactConfig
from acts_sim.ball.ball_plate import JointMotion, PlateConfig


class Phase(Enum):
    """Where the ball is."""

    AWAITED = "not yet on the plate"
    ROLLING = "on the plate"
    FALLEN = "fallen off the plate"


@dataclass(frozen=True)
class WorldConfig(BallConfig, ContactConfig, PlateConfig):
    """All settings of the world."""

    rows: int = setting(32, "rows of the array", minimum=1, maximum=64)
    cols: int = setting(32, "columns of the array", minimum=1, maximum=64)
    layout: str = setting(
        "square",
        f"how the matrix of taxels lies on the skin: {', '.join(LAYOUTS)}, or the path of a layout file; the ball "
        "rolls on its picture, laid flat",
    )
    pitch_m: float = setting(
        0.0, "distance between neighbouring columns of the picture [m]; 0: that of the layout", minimum=0.0, maximum=0.1
    )
    row_pitch_m: float = setting(
        0.0,
        "distance between neighbouring rows of the picture [m]; 0: as pitch_m, the layout's where that is 0",
        minimum=0.0,
        maximum=0.1,
    )
    start_x_m: float = setting(
        0.020, "start position of the ball, x in the skin's frame [m]", minimum=-3.0, maximum=3.0
    )
    start_y_m: float = setting(
        -0.015, "start position of the ball, y in the skin's frame [m]", minimum=-3.0, maximum=3.0
    )
    start_after_s: float = setting(
        3.0, "earliest time after the start at which the ball is put on the plate [s]", minimum=0.0, maximum=1e6
    )
    start_slope: float = setting(
        0.03, "the ball is put on once the plate is flatter than this (sine of its tilt)", minimum=0.0, maximum=2.0
    )
    start_turn_rate_rad_s: float = setting(
        0.05, "the ball is put on once the plate turns more slowly than this [rad/s]", minimum=0.0, maximum=100.0
    )
    replace_after_s: float = setting(
        0.0, "time after which a ball that fell off is put back [s]; 0: never", minimum=0.0, maximum=1e6
    )
    push_speed_m_s: float = setting(
        0.0, "change of the ball's velocity by each push [m/s]; 0: no pushes", minimum=0.0, maximum=5.0
    )
    push_period_s: float = setting(
        5.0, "time between pushes, each in a random direction [s]", minimum=0.001, maximum=1e6
    )
    seed: int = setting(1, "seed of the pushes' directions", minimum=0, maximum=2**31 - 1)

    def __post_init__(self) -> None:
        validate(self)

    def arranged(self) -> Layout:
        """The layout of the skin on the plate.

        Raises
        ------
        ArrayError, SettingsError
            As of `acts_core.skin.layout`.
        """
        return layout(self.layout, self.rows, self.cols)

    @property
    def geometry(self) -> ArrayGeometry:
        """The picture of the skin on the plate; raises as `arranged` does."""
        return self.arranged().geometry(self.pitch_m, self.row_pitch_m)


@dataclass(frozen=True)
class WorldState:
    """State of the world at one time.

    Attributes
    ----------
    time_s : float
        Time since the start [s].
    phase : Phase
    phase_time_s : float
        Time since `phase` began [s].
    ball : BallState
        Valid in phase ROLLING only.
    joints : JointMotion
        Joints of the arm.
    pushes, falls : int
        How often the ball was pushed, and how often it fell off.
    joints_refused : int
        Number of steps whose joints were NaN or impossible; the plate kept its last pose.
    """

    time_s: float
    phase: Phase
    phase_time_s: float
    ball: BallState
    joints: JointMotion
    pushes: int = 0
    falls: int = 0
    joints_refused: int = 0


class World:
    """Simulates the world step by step.

    Parameters
    ----------
    config : WorldConfig

    Raises
    ------
    ArrayError, SettingsError
        When there is no such layout, or it is for another matrix, or the ball would start beside the plate.

    Attributes
    ----------
    state : WorldState
    """

    def __init__(self, config: WorldConfig) -> None:
        self.config = config
        self.state = WorldState(0.0, Phase.AWAITED, 0.0, BallState(), JointMotion.still(np.array(ur5e.LEVEL_Q_RAD)))
        geometry, arranged = config.geometry, config.arranged()
        self._contact = BallContact(config, geometry, config.radius_m)
        self._layout = None if arranged.is_matrix else arranged
        self._has_skin = arranged.patch_of != NO_PATCH
        self._rng = np.random.default_rng(config.seed)
        self._is_asked_for = False
        self._half_x_m = geometry.cols * geometry.pitch_m / 2
        self._half_y_m = geometry.rows * geometry.pitch_y_m / 2
        self._require_start_on_plate()
        # Compile the kernel now; otherwise that would delay the step that puts the ball on.
        ball.step(config, BallState(), ball_plate.motion(config, self.state.joints), 0.0)
        self._contact.press(0.0, 0.0, 0.0)

    def _require_start_on_plate(self) -> None:
        config, radius_m = self.config, self.config.radius_m
        if abs(config.start_x_m) > self._half_x_m + radius_m or abs(config.start_y_m) > self._half_y_m + radius_m:
            raise SettingsError(
                f"start_x_m = {config.start_x_m:g}, start_y_m = {config.start_y_m:g}: a ball of radius {radius_m:g} m "
                f"there is beside the plate, which reaches {self._half_x_m:g} m along x and {self._half_y_m:g} m along "
                "y to both sides of its middle; allowed is a start on it"
            )

    @property
    def counts(self) -> NDArray[np.float64]:
        """Counts of the matrix before noise and rounding; shape (rows * cols,), overwritten by the next step."""
        picture = self._contact.counts
        if self._layout is None:
            return picture.reshape(-1)
        return self._layout.matrix(picture * self._has_skin).reshape(-1).astype(np.float64, copy=False)

    def put_back(self) -> str:
        """Put a ball that fell off on the plate again, once that is level and still; from any thread.

        Returns
        -------
        str
            Why there is nothing to be put back, or nothing.
        """
        phase = self.state.phase
        if phase is not Phase.FALLEN:
            return f"the ball is {phase.value}"
        self._is_asked_for = True
        return ""

    def step(self, joints: JointMotion | None, dt_s: float) -> WorldState:
        """Advance the world by one time step.

        Parameters
        ----------
        joints : JointMotion or None
            Motion of the arm during the step. None where it is unknown: the arm then rests in its last pose, at the
            start in the level one.
        dt_s : float
            Length of the step, about a millisecond [s].

        Returns
        -------
        WorldState
            State at the end of the step, as are `counts`.
        """
        state = self.state
        refused = joints is not None and not joints.is_plausible()
        if joints is None or refused:
            joints = JointMotion.still(state.joints.q_rad)
        plate = ball_plate.motion(self.config, joints)
        rolling = state.ball
        if state.phase is Phase.ROLLING:
            rolling = ball.step(self.config, self._pushed(state, dt_s), plate, dt_s)
        state = replace(
            state,
            time_s=state.time_s + dt_s,
            phase_time_s=state.phase_time_s + dt_s,
            ball=rolling,
            joints=joints,
            pushes=state.pushes + self._push_due(state, dt_s),
            joints_refused=state.joints_refused + refused,
        )
        if state.phase is Phase.ROLLING:
            if not (abs(rolling.x_m) <= self._half_x_m and abs(rolling.y_m) <= self._half_y_m):
                self._is_asked_for = False
                state = replace(state, phase=Phase.FALLEN, phase_time_s=0.0, ball=BallState(), falls=state.falls + 1)
        elif self._is_put_on(state, plate):
            start = BallState(self.config.start_x_m, self.config.start_y_m)
            # A step of length 0, to compute the load.
            state = replace(
                state, phase=Phase.ROLLING, phase_time_s=0.0, ball=ball.step(self.config, start, plate, 0.0)
            )
        self.state = state
        self._contact.press(state.ball.x_m, state.ball.y_m, state.ball.load_n)
        return state

    def _push_due(self, state: WorldState, dt_s: float) -> int:
        if state.phase is not Phase.ROLLING or self.config.push_speed_m_s == 0.0:
            return 0
        period_s = self.config.push_period_s
        return int((state.phase_time_s + dt_s) // period_s > state.phase_time_s // period_s)

    def _pushed(self, state: WorldState, dt_s: float) -> BallState:
        if not self._push_due(state, dt_s):
            return state.ball
        direction_rad = self._rng.uniform(0.0, 2 * math.pi)
        speed_m_s = self.config.push_speed_m_s
        return replace(
            state.ball,
            vx_m_s=state.ball.vx_m_s + speed_m_s * math.cos(direction_rad),
            vy_m_s=state.ball.vy_m_s + speed_m_s * math.sin(direction_rad),
        )

    def _is_put_on(self, state: WorldState, plate: ball_plate.PlateMotion) -> bool:
        config = self.config
        if state.phase is Phase.AWAITED:
            due = state.phase_time_s >= config.start_after_s
        else:
            due = self._is_asked_for or 0.0 < config.replace_after_s <= state.phase_time_s
        return due and plate.slope <= config.start_slope and plate.turn_rate_rad_s <= config.start_turn_rate_rad_s
