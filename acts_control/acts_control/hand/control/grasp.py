"""Closing the hand: into the shape from which it closes, then each finger until it feels enough."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from acts_control.hand.reflexes import Sensed, Wish
from acts_core.settings import setting, validate

_ARRIVED_RAD = 0.05
_SHAPED_AFTER_S = 1.5


@dataclass(frozen=True)
class GraspConfig:
    """How the hand closes and opens."""

    grip_force_n: float = setting(
        0.5, "a finger that closes has gripped when its regions feel so much [N]", minimum=0.02, maximum=20.0
    )
    close_speed_rad_s: float = setting(
        1.0, "how fast the joint that takes most part closes [rad/s]", minimum=0.01, maximum=8.0
    )
    open_speed_rad_s: float = setting(3.0, "how fast the hand opens [rad/s]", minimum=0.01, maximum=8.0)
    grasp_posture: str = setting("pregrasp", "posture of the hand's description from which it closes")
    close_timeout_s: float = setting(3.0, "closing ends after this [s]", minimum=0.1, maximum=60.0)
    grip_settle_s: float = setting(
        0.2, "how long all fingers must have gripped before it counts as held [s]", minimum=0.0, maximum=5.0
    )

    def __post_init__(self) -> None:
        validate(self)


class Grasp:
    """One closing of the hand.

    Parameters
    ----------
    config : GraspConfig

    Attributes
    ----------
    ended : str
        How closing has ended, in words; empty as long as it goes on.
    has_gripped : bool
        Whether something is held now.
    """

    def __init__(self, config: GraspConfig) -> None:
        self._config = config
        self.reset()

    def reset(self) -> None:
        """Begin anew."""
        self.ended = ""
        self.has_gripped = False
        self._is_shaped = False
        self._shaping_s = 0.0
        self._closing_s = 0.0
        self._gripped_s = 0.0

    def step(self, sensed: Sensed) -> Wish | None:
        """Steps that close the hand."""
        config = self._config
        if not self._is_shaped and self._shapes(sensed):
            return towards(sensed, config.grasp_posture, config.open_speed_rad_s)
        self._closing_s += sensed.dt_s
        forces = {finger: sum(one.force_n for one in sensed.of_finger(finger)) for finger in sensed.hand.fingers}
        gripping = [finger for finger, force in forces.items() if force >= config.grip_force_n]
        steps = sensed.steps()
        upper = np.array([joint.upper_rad for joint in sensed.hand.joints])
        closes = sensed.goal_rad < upper - 1e-6
        is_closing = False
        for finger in sensed.hand.fingers:
            closing = sensed.closing(finger)
            if finger not in gripping:
                steps += config.close_speed_rad_s / sensed.step_rad_s * closing / closing.max()
                is_closing |= bool(closes[closing > 0.0].any())
        all_grip = len(gripping) == len(forces)
        self._gripped_s = self._gripped_s + sensed.dt_s if all_grip else 0.0
        is_exhausted = self._closing_s > config.close_timeout_s or not (all_grip or is_closing)
        if self._gripped_s > config.grip_settle_s or is_exhausted:
            palm = [name for name, one in sensed.regions.items() if one.in_contact and not sensed.finger(name)]
            holders = [*gripping, *palm]
            self.has_gripped = len(holders) >= 2
            self.ended = f"gripped by {', '.join(holders)}" if self.has_gripped else "nothing was gripped"
        return Wish(steps, "closing")

    def _shapes(self, sensed: Sensed) -> bool:
        """Whether the hand still has to come into the shape from which it closes."""
        touched = any(one.in_contact for name, one in sensed.regions.items() if sensed.finger(name))
        left = np.abs(np.array(sensed.hand.postures[self._config.grasp_posture]) - sensed.q_rad).max()
        self._shaping_s += sensed.dt_s
        # Something may be in the way that the skin does not feel.
        self._is_shaped = touched or bool(left < _ARRIVED_RAD) or self._shaping_s > _SHAPED_AFTER_S
        return not self._is_shaped


def towards(sensed: Sensed, posture: str, speed_rad_s: float) -> Wish | None:
    """Steps towards a posture of the description, all joints arriving together; None once they have."""
    left = np.array(sensed.hand.postures[posture]) - sensed.goal_rad
    farthest = float(np.abs(left).max())
    if farthest < 1e-4:
        return None
    rates = left * min(speed_rad_s / farthest, 1.0 / max(sensed.dt_s, 1e-3))
    return Wish(rates / sensed.step_rad_s, f"to the posture {posture}")
