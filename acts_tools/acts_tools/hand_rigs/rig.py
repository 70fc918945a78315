# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The simulated hand with its reflexes in one process, without a clock: the same seed gives the same bits.

The skin is sampled as on the board and its image recovered as in the driver, frame after frame. The reflexes receive
what its patches feel one step of the world later, at the cycles of their loop.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.control import HandSupervisor, SupervisorConfig
from acts_control.hand.description import LEAP_RIGHT, HandKinematics
from acts_control.hand.motors import DynamixelConfig, HandReading
from acts_control.hand.reflexes import REFLEXES, HandState, Reflex
from acts_core.array import COUNT_MAX
from acts_core.sampling import SamplingConfig, SkinMap
from acts_core.settings import describe
from acts_core.skin import RegionContact
from acts_recon.fusion import known_noise
from acts_recon.settings import ReconstructionSettings
from acts_recon.slip import SlipConfig
from acts_sim.dynamixel import RAD_PER_TICK
from acts_sim.hand import STEP_S, HandWorld, HandWorldConfig
from acts_tools.firmware.board_sampler import BoardSampler

_CURRENT_BASED_POSITION = 5
_FRAMES = 2
"""Frames of the board in each step of the world: 1000 per second."""
_MAX_SPEED_RAD_S = 12.0
"""Largest speed of a goal, as in the node `hand_reflexes` [rad/s]."""
_GRASP_S = 6.0
"""Longest time in which the hand closes [s]."""
_FIRST_TOUCH_S = 0.15
"""By then reflexes at the lowest rate have looked at touch [s]."""
_KINEMATICS = HandKinematics(LEAP_RIGHT)


@dataclass(frozen=True)
class RigOptions:
    """Options of the hand and its reflexes.

    Attributes
    ----------
    rate_hz : float
        Rate of the reflexes' loop [Hz].
    reflexes : tuple of str
        Names of active reflexes in the registry.
    sampling : SamplingConfig
        Settings of the board, as in config/params/hand_reflexes.yaml.
    touch_counts : int
        A taxel above it is pressed.
    noise_counts : float
        Standard deviation of a measurement: of the board's, and as the reconstruction takes it [counts].
    slip : SlipConfig
        Thresholds of slip.
    settings : mapping
        Settings of supervisor and reflexes that are not the defaults.
    """

    rate_hz: float = 250.0
    reflexes: tuple[str, ...] = ("sharp", "slip")
    sampling: SamplingConfig = field(
        default_factory=lambda: SamplingConfig(scheme="tracking", m=55, threshold_counts=20, search_share=0.4)
    )
    touch_counts: int = 8
    noise_counts: float = 1.5
    slip: SlipConfig = field(
        default_factory=lambda: SlipConfig(slip_distance_taxels=0.03, slip_sigmas=4.0, slip_together_share=0.7)
    )
    settings: Mapping[str, Any] = field(default_factory=dict)


class HandRig:
    """A hand's world, the regions of its skin, and a supervisor that moves its motors.

    Parameters
    ----------
    world : HandWorldConfig
    options : RigOptions

    Attributes
    ----------
    world : HandWorld
    supervisor : HandSupervisor
    reflexes : dict of str to Reflex
    regions : list of RegionContact
        Regions at the last step.
    goal_rad : np.ndarray [shape=(joints,)]
        Goals last sent to the motors [rad].
    behind_s : float
        How long after the present it knows of it [s].
    """

    behind_s = 0.0

    def __init__(self, world: HandWorldConfig, options: RigOptions) -> None:
        self.world = HandWorld(world)
        self.reflexes: dict[str, Reflex] = {
            name: REFLEXES[name](_configured(REFLEXES[name].Config, options.settings)) for name in options.reflexes
        }
        config = _configured(SupervisorConfig, options.settings)
        self.supervisor = HandSupervisor(_KINEMATICS, self.reflexes, config)
        self.supervisor.restart(recovered=False)
        layout, noise_counts = self.world.layout, options.noise_counts
        self._board = BoardSampler(
            replace(options.sampling, seed=world.seed + 1), noise_counts, skin_map=SkinMap.of(layout)
        )
        settings = ReconstructionSettings(
            layout=layout.name,
            touch_counts=options.touch_counts,
            noise_counts=known_noise(noise_counts),
            **asdict(options.slip),
        )
        self._recovery = settings.recovery()
        self._finder = settings.regions(self._recovery)
        self._counts = self._matrix()
        self._period_s = 1.0 / options.rate_hz
        self._due_s = self._last_s = 0.0
        self._switch_on(DynamixelConfig())
        self.regions: list[RegionContact] = []
        self.goal_rad = self._angles()

    @property
    def time_s(self) -> float:
        """Time of the world [s]."""
        return self.world.time_s

    @property
    def state(self) -> HandState:
        """State of the supervisor."""
        return self.supervisor.status.state

    def step(self) -> None:
        """Advance by one step of the world."""
        seen, seen_s = list(self.regions), self.time_s
        self.world.step()
        self._feel()
        if seen:
            self.supervisor.touch(seen, seen_s, self.time_s)
        if self.time_s >= self._due_s - 1e-9:
            self._due_s += self._period_s
            self._cycle()

    def run(self, duration_s: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Run for a time [s], or until a condition is true; return whether it was."""
        for _ in range(round(duration_s / STEP_S)):
            self.step()
            if until():
                return True
        return False

    def begin_grasp(self) -> None:
        """Begin to close the hand, as soon as it has looked at touch."""
        self.run(0.02)
        if self.supervisor.status.is_stale:
            self.run(_FIRST_TOUCH_S, lambda: not self.supervisor.status.is_stale)
        objection = self.supervisor.grasp()
        assert not objection, objection

    def grasp(self) -> bool:
        """Close the hand; return whether it then holds something."""
        self.begin_grasp()
        self.run(_GRASP_S, lambda: self.state in (HandState.HOLDING, HandState.OPEN))
        return self.state is HandState.HOLDING

    def object_m(self) -> NDArray[np.float64]:
        """Position of the object in the palm's frame [m]."""
        return np.array(self.world.truth.object_position_m)

    def _cycle(self) -> None:
        dt_s, self._last_s = max(self.time_s - self._last_s, STEP_S), self.time_s
        currents = tuple(float(motor["present_current"]) for motor in self.world.motors)
        count = len(currents)
        reading = HandReading(tuple(self._angles()), (0.0,) * count, currents, (30,) * count, ("",) * count)
        wanted = self.supervisor.step(reading, self.goal_rad.tolist(), self.time_s, dt_s)
        farthest = _MAX_SPEED_RAD_S * dt_s
        self.goal_rad = self.goal_rad + np.clip(wanted - self.goal_rad, -farthest, farthest)
        for motor, joint, angle in zip(self.world.motors, LEAP_RIGHT.joints, self.goal_rad, strict=True):
            _write(motor, "goal_position", round(joint.to_motor_rad(float(angle)) / RAD_PER_TICK))

    def _angles(self) -> NDArray[np.float64]:
        return np.array([motor["present_position"] * RAD_PER_TICK - math.pi for motor in self.world.motors])

    def _feel(self) -> None:
        """Sample and recover the frames of a step of the world."""
        before, self._counts = self._counts, self._matrix()
        field, recovery = np.stack((before, self._counts)), self._recovery
        duration_s = STEP_S / _FRAMES
        for k in range(_FRAMES):
            indices, counts = self._board.frame(field, k / _FRAMES, 1.0 / (_FRAMES * self._board.config.m))
            end_s = self.time_s - (_FRAMES - 1 - k) * duration_s
            recovery.step(indices, counts, end_s, duration_s)
            self.regions = list(self._finder.step(end_s, recovery.image, recovery.measured, recovery.age_s))

    def _matrix(self) -> NDArray[np.uint16]:
        layout = self.world.layout
        counts = self.world.counts.reshape(layout.matrix_rows, layout.matrix_cols)
        return np.clip(np.rint(counts), 0, COUNT_MAX).astype(np.uint16)

    def _switch_on(self, config: DynamixelConfig) -> None:
        """Set the motors up like `DynamixelHand`."""
        for motor, joint in zip(self.world.motors, LEAP_RIGHT.joints, strict=True):
            p_gain, i_gain, d_gain = config.gains(joint)
            _write(motor, "operating_mode", _CURRENT_BASED_POSITION)
            _write(motor, "position_p_gain", p_gain)
            _write(motor, "position_i_gain", i_gain)
            _write(motor, "position_d_gain", d_gain)
            _write(motor, "goal_current", config.max_current_ma)
            _write(motor, "torque_enable", 1)


def _write(motor: Any, name: str, value: int) -> None:
    register = motor.model.registers[name]
    error = motor.write(register.address, int(value).to_bytes(register.size, "little", signed=True))
    assert not error, (name, value, error)


def _configured(kind: type, settings: Mapping[str, Any]) -> Any:
    return kind(**{name: value for name, value in settings.items() if name in describe(kind)})
