"""What a hand is, whatever moves it: its joints in the order of all joint arrays."""

from __future__ import annotations

import math
from dataclasses import dataclass

from acts_core.errors import SettingsError


@dataclass(frozen=True)
class Joint:
    """One joint, moved by one motor.

    Attributes
    ----------
    name : str
    motor_id : int
        On the bus.
    lower_rad, upper_rad : float
        How far it may turn; positive angles close the hand [rad].
    motor_zero_rad : float
        The motor's own angle where the joint's is 0 [rad].
    direction : int
        1, or -1 where the motor turns against the joint.
    gain_scale : float
        Factor on the motor's P and D gains.

    Raises
    ------
    SettingsError
        When made with limits that are not finite or the wrong way round.
    """

    name: str
    motor_id: int
    lower_rad: float
    upper_rad: float
    motor_zero_rad: float = math.pi
    direction: int = 1
    gain_scale: float = 1.0

    def __post_init__(self) -> None:
        finite = all(map(math.isfinite, (self.lower_rad, self.upper_rad, self.motor_zero_rad, self.gain_scale)))
        if not finite or not self.lower_rad < self.upper_rad:
            raise SettingsError(
                f"joint {self.name}: limits {self.lower_rad} and {self.upper_rad} rad; allowed are two finite numbers, "
                f"the lower one first"
            )
        if self.direction not in (-1, 1) or not 0 <= self.motor_id <= 252 or not 0.0 < self.gain_scale <= 10.0:
            raise SettingsError(
                f"joint {self.name}: direction {self.direction}, motor_id {self.motor_id}, gain_scale "
                f"{self.gain_scale}; allowed are 1 or -1, 0 to 252, above 0 to 10"
            )

    def to_motor_rad(self, q_rad: float) -> float:
        """The motor's angle for an angle of the joint."""
        return self.motor_zero_rad + self.direction * q_rad

    def from_motor_rad(self, motor_rad: float) -> float:
        """The joint's angle for an angle of the motor."""
        return self.direction * (motor_rad - self.motor_zero_rad)

    def clipped(self, q_rad: float) -> float:
        """The nearest angle within the limits."""
        return min(max(q_rad, self.lower_rad), self.upper_rad)


@dataclass(frozen=True)
class HandDescription:
    """A hand.

    Attributes
    ----------
    name : str
    joints : tuple of Joint
        With different names and motors.

    Raises
    ------
    SettingsError
        When two joints share a name or a motor, or there is none.
    """

    name: str
    joints: tuple[Joint, ...]

    def __post_init__(self) -> None:
        names, motors = [one.name for one in self.joints], [one.motor_id for one in self.joints]
        if not names or len(set(names)) < len(names) or len(set(motors)) < len(motors):
            raise SettingsError(
                f"hand {self.name}: joints {names} with motors {motors}; at least one is needed, and no name or motor "
                f"may occur twice"
            )

    @property
    def names(self) -> list[str]:
        """Of the joints, in order."""
        return [joint.name for joint in self.joints]


def _finger(name: str, first_motor: int) -> tuple[Joint, ...]:
    # The two joints at the root have the load of the whole finger: LEAP's own programs weaken the one to the side.
    return (
        Joint(f"{name}_mcp_side", first_motor, -1.047, 1.047, gain_scale=0.75),
        Joint(f"{name}_mcp_forward", first_motor + 1, -0.314, 2.23),
        Joint(f"{name}_pip", first_motor + 2, -0.506, 1.885),
        Joint(f"{name}_dip", first_motor + 3, -0.366, 2.042),
    )


LEAP_RIGHT = HandDescription(
    "leap_right",
    (
        *_finger("index", 0),
        *_finger("middle", 4),
        *_finger("ring", 8),
        Joint("thumb_cmc", 12, -0.349, 2.094),
        Joint("thumb_axial", 13, -0.47, 2.443),
        Joint("thumb_mcp", 14, -1.20, 1.90),
        Joint("thumb_ipl", 15, -1.34, 1.88),
    ),
)
"""The right LEAP hand (Shaw et al., 2023, doi:10.15607/RSS.2023.XIX.089): limits of its URDF, motors open at pi."""
