# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Spherical grasp balancing: bring what is held to the palm's centre, with the fingertips still touching.

The palm tells where a sphere lies on it. While the hand closes, one finger comes down on the sphere and rolls it to the
palm's centre before the others touch it (`rolling`). While the hand holds, a sphere is fitted to all contacts: its
centre is where their normals meet. Every touched point is pressed as hard as is wanted, and moves along with the
sphere's surface as long as that is to roll; the joints follow by the inverse of the finger's Jacobian. Far from the
palm's centre (the exterior) more than near it (the interior): the wanted speed is in proportion to the distance.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.description import Region
from acts_control.hand.reflexes.base import HandState, Reflex, Sensed, Wish
from acts_control.hand.reflexes.spheres import Ball, Phase, Pinching, Rolling, aiming, felt_ball
from acts_core.errors import SettingsError
from acts_core.settings import setting, validate
from acts_core.skin import RegionContact

Array = NDArray[np.float64]

# What is put down sinks into the skin first: the palm must have felt something round for a while.
_ROUND_S = 0.1
# Once at the centre it is moved again when it is this much farther than `sphere_deadband_m`.
_HYSTERESIS = 1.75
# What is pressed into the palm spreads more than what lies on it, by up to this: a sphere of 34 mm radius spreads by
# 7.3 mm, a cylinder of 25 mm radius by more than 20 mm.
_PRESSED = 1.5
# A force is left alone within this share of what is wanted: what always corrects itself creeps.
_FORCE_BAND = 0.4


@dataclass(frozen=True)
class SphereBalancingConfig:
    """How a sphere is brought to the palm's centre."""

    sphere_speed_m_s: float = setting(
        0.040, "fastest that the sphere is moved along the palm [m/s]", minimum=0.001, maximum=1.0
    )
    sphere_gain_per_s: float = setting(
        4.0, "speed wanted for each metre of distance from the palm's centre [1/s]", minimum=0.1, maximum=50.0
    )
    sphere_deadband_m: float = setting(
        0.002, "a sphere that is nearer to the palm's centre than this counts as centred [m]", minimum=0.0, maximum=0.05
    )
    sphere_min_spread_m: float = setting(
        0.0035, "what the palm feels with less spread is too small to be rolled [m]", minimum=0.0, maximum=0.1
    )
    sphere_max_spread_m: float = setting(
        0.007, "what the palm feels with more spread is no sphere that could be rolled [m]", minimum=0.0, maximum=0.1
    )
    sphere_force_n: float = setting(0.6, "what each finger is to press with [N]", minimum=0.05, maximum=20.0)
    sphere_roll_force_n: float = setting(
        1.5, "what the finger that has rolled it is to press with [N]", minimum=0.05, maximum=20.0
    )
    sphere_compliance_m_s_n: float = setting(
        0.02,
        "speed at which a finger presses harder or yields, for each newton of difference [m/s/N]",
        minimum=0.0,
        maximum=1.0,
    )
    sphere_prior_m: float = setting(
        0.03, "radius that is assumed while the contacts do not determine it [m]", minimum=0.002, maximum=0.2
    )
    sphere_search_rad_s: float = setting(
        0.3, "how fast a finger that has lost the sphere looks for it [rad/s]", minimum=0.0, maximum=8.0
    )
    sphere_return_per_s: float = setting(
        1.5,
        "how fast joints that do not close a finger go back to where they were when the sphere was centred [1/s]",
        minimum=0.0,
        maximum=50.0,
    )
    sphere_damping_m: float = setting(
        0.01, "keeps the joints slow where a finger is stretched [m/rad]", minimum=1e-4, maximum=0.1
    )

    def __post_init__(self) -> None:
        validate(self)
        if self.sphere_min_spread_m > self.sphere_max_spread_m:
            raise SettingsError(
                f"sphere_min_spread_m = {self.sphere_min_spread_m:g}: allowed is sphere_max_spread_m = "
                f"{self.sphere_max_spread_m:g} or less"
            )


@dataclass
class SphereBalancingState:
    """What is remembered.

    Attributes
    ----------
    rest_rad : np.ndarray [shape=(joints,), dtype=float64] or None
        Goals of the joints when the sphere was last at the palm's centre, at first when the hand began to hold [rad].
    ball : Ball or None
        The sphere, in the frame of the hand's base.
    rolling : Rolling or None
        Since a finger comes down on it.
    pinching : Pinching or None
        Since it is at the centre and small.
    round_s : float
        For how long the palm alone has felt something round [s].
    is_off : bool
        Whether it has to be moved.
    moves : dict
        For each region of a finger, the joint that moves its link and closes the finger.
    """

    rest_rad: Array | None = None
    ball: Ball | None = None
    rolling: Rolling | None = None
    pinching: Pinching | None = None
    round_s: float = 0.0
    is_off: bool = True
    moves: dict[str, int] = field(default_factory=dict)


class SphereBalancing(Reflex):
    """See the module."""

    Config = SphereBalancingConfig
    priority = 70  # above slip: what it moves on purpose does slip
    states = frozenset({HandState.CLOSING, HandState.HOLDING, HandState.AVOIDING})
    pressing = ("sphere_force_n", "sphere_roll_force_n")

    config: SphereBalancingConfig

    def reset(self) -> None:
        """Forget what was."""
        self.state = SphereBalancingState()

    def step(self, sensed: Sensed) -> Wish | None:
        """Steps of all fingers that touch, or of the one that comes down on a sphere."""
        palm = next((one for one in sensed.hand.regions.values() if one.role == "palm"), None)
        ball = None if palm is None else self._look(sensed, palm)
        if ball is None:
            return None
        wish = self._close(sensed, ball) if sensed.state is HandState.CLOSING else self._hold(sensed, ball)
        if wish is not None:
            self.note_acting(sensed.time_s)
        return wish

    def _look(self, sensed: Sensed, palm: Region) -> Ball | None:
        """The sphere that touches the skin; None where nothing does."""
        config, state = self.config, self.state
        contacts = [one for one in sensed.regions.values() if one.in_contact]
        if not contacts:
            return None
        state.ball = ball = felt_ball(sensed.pose, palm, contacts, config.sphere_prior_m)
        state.is_off = ball.offset_m > config.sphere_deadband_m * (1.0 if state.is_off else _HYSTERESIS)
        return ball

    def _close(self, sensed: Sensed, ball: Ball) -> Wish | None:
        """Steps of a finger that rolls the sphere to the centre before the others close around it."""
        state = self.state
        if state.rolling is None:
            state.rolling = self._begin(sensed, ball)
        rolling, pinching = state.rolling, state.pinching
        if rolling is None or rolling.phase is Phase.GIVEN_UP:
            return None
        touching = _outermost(sensed, rolling.finger)
        # Nothing else may touch the sphere meanwhile: closing waits.
        everything = np.ones(len(sensed.goal_rad), dtype=bool)
        if pinching is not None:
            rates = pinching.step(sensed)
            if pinching.has_ended and not pinching.has_gripped:
                rolling.phase = Phase.GIVEN_UP
            return Wish(rates / sensed.step_rad_s, self._why(), everything, holds=pinching.has_gripped)
        if rolling.phase is Phase.ROLLING:
            coming = rolling.step(sensed, ball, touching, is_off=state.is_off)
            rates = self._follow_all(sensed, ball) if coming is None else coming
            state.pinching = self._pinch(rolling, ball)
            return Wish(rates / sensed.step_rad_s, self._why(), everything)
        if touching is None:
            return None
        # The others close around it.
        rates = self._follow(sensed, ball, touching)
        return Wish(rates / sensed.step_rad_s, self._why(), claimed=rates != 0.0)

    def _pinch(self, rolling: Rolling, ball: Ball) -> Pinching | None:
        """How a sphere that has come to the centre is gripped, if it is too small for all fingers."""
        is_small = rolling.phase is Phase.CENTRED and ball.radius_m < aiming.PAIR_M
        return Pinching(ball, self.config.sphere_force_n) if is_small else None

    def _begin(self, sensed: Sensed, ball: Ball) -> Rolling | None:
        """What comes down on the sphere, once the palm has felt something round and no finger anything."""
        config, state = self.config, self.state
        spread_m = max((one.spread_m for one in sensed.of_finger("") if one.in_contact), default=0.0)
        is_round = config.sphere_min_spread_m < spread_m < config.sphere_max_spread_m
        is_alone = not any(one.in_contact for name, one in sensed.regions.items() if sensed.finger(name))
        # Before the hand is in shape its thumb may come from the side, and push the sphere away.
        state.round_s = state.round_s + sensed.dt_s if sensed.is_shaped and is_round and is_alone else 0.0
        if state.round_s <= _ROUND_S or not aiming.can_aim(sensed.hand):
            return None
        # A thumb without skin would not feel what it comes down on.
        felt = aiming.approaches(sensed, ball.foot_m, ball.up)
        thumb = next((finger for finger in felt if sensed.hand.fingers[finger].opposes), None)
        return Rolling(thumb) if thumb is not None else None

    def _hold(self, sensed: Sensed, ball: Ball) -> Wish | None:
        """Steps of all fingers, so that the sphere gets to the centre and every fingertip to the sphere."""
        config, state = self.config, self.state
        widest_m = _PRESSED * config.sphere_max_spread_m
        if any(one.in_contact and one.spread_m > widest_m for one in sensed.of_finger("")):
            return None  # no sphere: its fingers would be moved on and on
        touched = {finger: _outermost(sensed, finger) for finger in sensed.hand.fingers}
        if not any(touched.values()) or sum(one.in_contact for one in sensed.regions.values()) < 2:
            return None
        if state.rest_rad is None or not state.is_off:
            state.rest_rad = sensed.goal_rad.copy()
        rates = config.sphere_return_per_s * (state.rest_rad - sensed.goal_rad) * (_all_closing(sensed) == 0.0)
        rates += self._follow_all(sensed, ball)
        parts = aiming.approaches(sensed, ball.foot_m, ball.up)
        for finger, region in touched.items():
            if region is None:
                # Beside a small sphere a finger finds nothing, and without skin it would not feel it.
                part = parts.get(finger)
                reaches = state.pinching is None or (part is not None and part.part != "beside")
                rates += config.sphere_search_rad_s * sensed.closing(finger) * reaches
            elif sensed.role(region.name) != "distal":
                rates[self._tip_joints(sensed, finger)] += config.sphere_search_rad_s
        return Wish(rates / sensed.step_rad_s, self._why(), claimed=rates != 0.0 if state.is_off else None)

    def _why(self) -> str:
        ball = self.state.ball
        assert ball is not None
        return f"sphere of {1e3 * ball.radius_m:.0f} mm is {1e3 * ball.offset_m:.0f} mm off the palm's centre"

    def _tip_joints(self, sensed: Sensed, finger: str) -> list[int]:
        """The joint that brings a fingertip to the sphere; none where closing the finger moves none of its regions."""
        if not self.state.moves:
            self.state.moves = sensed.moving_joints()
        tips = [name for name, one in sensed.hand.regions.items() if one.finger == finger and name in self.state.moves]
        return [self.state.moves[name] for name in tips[-1:]]

    def _follow_all(self, sensed: Sensed, ball: Ball) -> Array:
        """Joint speeds of all fingers that touch, each at the place nearest to its tip [rad/s]."""
        rates = sensed.steps()
        for finger in sensed.hand.fingers:
            region = _outermost(sensed, finger)
            if region is not None:
                rates += self._follow(sensed, ball, region)
        return rates

    def _follow(self, sensed: Sensed, ball: Ball, region: RegionContact) -> Array:
        """Joint speeds that move a touched point along with the sphere, and press as is wanted [rad/s]."""
        config, pose = self.config, sensed.pose
        at = pose.point(region.link, region.centre_m)
        force_n = config.sphere_roll_force_n if self._rolls(sensed.finger(region.name)) else config.sphere_force_n
        lacks_n = force_n - region.force_n
        press = config.sphere_compliance_m_s_n * lacks_n if abs(lacks_n) > _FORCE_BAND * force_n else 0.0
        wanted = press * pose.direction(region.link, region.normal)
        if self.state.is_off:
            speed = min(config.sphere_gain_per_s * ball.offset_m, config.sphere_speed_m_s)
            wanted = wanted + ball.surface_velocity(ball.away_m * (speed / ball.offset_m), at)
        jacobian = pose.jacobian(region.link, at)
        damped = jacobian @ jacobian.T + config.sphere_damping_m**2 * np.eye(3)
        rates: Array = jacobian.T @ np.linalg.solve(damped, wanted)
        return rates

    def _rolls(self, finger: str) -> bool:
        """Whether a finger lies on top of the sphere, to roll it."""
        rolling = self.state.rolling
        is_on_top = rolling is not None and rolling.finger == finger and rolling.phase is not Phase.GIVEN_UP
        return is_on_top and self.state.pinching is None


def _all_closing(sensed: Sensed) -> Array:
    """How much each joint takes part in closing whichever finger."""
    return np.sum([sensed.closing(finger) for finger in sensed.hand.fingers], axis=0)


def _outermost(sensed: Sensed, finger: str) -> RegionContact | None:
    """The touched region nearest to the tip of a finger."""
    touching = [one for one in sensed.of_finger(finger) if one.in_contact]
    return touching[-1] if touching else None
