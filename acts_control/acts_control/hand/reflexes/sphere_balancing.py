# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Spherical grasp balancing: bring what is held to the palm's centre, with the fingertips still touching.

Each contact has a place and a normal, so a sphere is fitted to them: its centre is where the normals meet. The touched
point of every finger is then moved towards where the sphere has to go, and pressed as hard as is wanted; the joints
follow by the inverse of the finger's Jacobian. Far from the palm's centre (the exterior) more than near it (the
interior): the wanted speed is in proportion to the distance.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.reflexes.reflex import HandState, Reflex, Sensed, Wish
from acts_core.settings import setting, validate
from acts_core.skin import RegionContact

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SphereBalancingConfig:
    """How a sphere is brought to the palm's centre."""

    sphere_speed_m_s: float = setting(
        0.025, "fastest that the sphere is moved along the palm [m/s]", minimum=0.001, maximum=1.0
    )
    sphere_gain_per_s: float = setting(
        4.0, "speed wanted for each metre of distance from the palm's centre [1/s]", minimum=0.1, maximum=50.0
    )
    sphere_deadband_m: float = setting(0.002, "nearer than this it is at the centre [m]", minimum=0.0, maximum=0.05)
    sphere_force_n: float = setting(0.6, "what each finger is to press with [N]", minimum=0.05, maximum=20.0)
    sphere_compliance_m_s_n: float = setting(
        0.02, "speed at which a finger is pressed on or let off, for each newton [m/s/N]", minimum=0.0, maximum=1.0
    )
    sphere_prior_m: float = setting(
        0.03, "radius that is taken where the contacts do not say [m]", minimum=0.002, maximum=0.2
    )
    sphere_search_rad_s: float = setting(
        0.3, "how fast a finger that has lost the sphere looks for it [rad/s]", minimum=0.0, maximum=8.0
    )
    sphere_return_per_s: float = setting(
        1.5,
        "how fast joints that do not close a finger go back to where they were at first [1/s]",
        minimum=0.0,
        maximum=50.0,
    )
    sphere_damping_m: float = setting(
        0.01, "keeps the joints slow where a finger is stretched [m/rad]", minimum=1e-4, maximum=0.1
    )

    def __post_init__(self) -> None:
        validate(self)


@dataclass
class SphereBalancingState:
    """What is remembered.

    Attributes
    ----------
    first_rad : np.ndarray or None
        Goals of the joints at the first step [rad].
    centre_m : np.ndarray or None
        Of the fitted sphere, in the frame of the hand's base [m].
    radius_m : float
    moves : dict
        For each region of a finger, the joint that moves its link and closes the finger.
    offset_m : float
        Distance of the sphere from the palm's centre, along the palm [m].
    """

    first_rad: Array | None = None
    centre_m: Array | None = None
    radius_m: float = 0.0
    moves: dict[str, int] = field(default_factory=dict)
    offset_m: float = 0.0


def fitted_sphere(points_m: Array, normals: Array, weights: Array, prior_m: float) -> tuple[Array, float]:
    """The sphere that touches skin at points with normals out of the skin.

    Parameters
    ----------
    points_m, normals : np.ndarray [shape=(n, 3)]
        n at least 1.
    weights : np.ndarray [shape=(n,)]
    prior_m : float
        Radius where the contacts do not say, with a small weight [m].

    Returns
    -------
    (np.ndarray [shape=(3,)], float)
        Centre and radius [m].
    """
    # centre - radius * normal = point, for every contact; the centre drops out as the weighted mean.
    share = weights / weights.sum()
    mean_point, mean_normal = share @ points_m, share @ normals
    dp, dn = points_m - mean_point, normals - mean_normal
    small = 0.02
    radius = -float((share[:, None] * dp * dn).sum()) + small * prior_m
    radius /= float((share[:, None] * dn * dn).sum()) + small
    radius = min(max(radius, 0.002), 0.2)
    return mean_point + radius * mean_normal, radius


class SphereBalancing(Reflex):
    """See the module."""

    Config = SphereBalancingConfig
    priority = 70  # above slip: what it moves on purpose does slip
    states = frozenset({HandState.HOLDING, HandState.AVOIDING})

    config: SphereBalancingConfig

    def reset(self) -> None:
        """Forget what was."""
        self.state = SphereBalancingState()

    def step(self, sensed: Sensed) -> Wish | None:
        """Steps of all fingers that touch."""
        config, state = self.config, self.state
        palm = next((one for one in sensed.hand.regions.values() if one.role == "palm"), None)
        contacts = [one for one in sensed.regions.values() if one.in_contact]
        touched = {finger: _outermost(sensed, finger) for finger in sensed.hand.fingers}
        if palm is None or len(contacts) < 2 or not any(touched.values()):
            return None
        pose = sensed.pose
        points = np.array([pose.point(one.link, one.centre_m) for one in contacts])
        normals = np.array([pose.direction(one.link, one.normal) for one in contacts])
        forces = np.array([max(one.force_n, 1e-3) for one in contacts])
        centre, radius = fitted_sphere(points, normals, np.minimum(forces, 1.0), config.sphere_prior_m)
        state.centre_m, state.radius_m = centre, radius
        normal = pose.direction(palm.link, palm.normal)
        away = pose.point(palm.link, palm.centre_m) - centre
        away -= (away @ normal) * normal
        state.offset_m = float(np.linalg.norm(away))
        velocity = np.zeros(3)
        if state.offset_m > config.sphere_deadband_m:
            speed = min(config.sphere_gain_per_s * state.offset_m, config.sphere_speed_m_s)
            velocity = away * (speed / state.offset_m)
        if state.first_rad is None:
            state.first_rad = sensed.goal_rad.copy()
        rates = config.sphere_return_per_s * (state.first_rad - sensed.goal_rad) * (_all_closing(sensed) == 0.0)
        for finger, region in touched.items():
            if region is None:
                rates += config.sphere_search_rad_s * sensed.closing(finger)
                continue
            rates += self._follow(sensed, region, velocity)
            if sensed.role(region.name) != "distal":
                rates[self._tip_joint(sensed, finger)] += config.sphere_search_rad_s
        why = f"sphere of {1e3 * radius:.0f} mm is {1e3 * state.offset_m:.0f} mm off the palm's centre"
        return Wish(rates / sensed.step_rad_s, why, claimed=rates != 0.0 if velocity.any() else None)

    def _tip_joint(self, sensed: Sensed, finger: str) -> int:
        """The joint that brings a fingertip to the sphere."""
        if not self.state.moves:
            self.state.moves = sensed.moving_joints()
        tips = [name for name, one in sensed.hand.regions.items() if one.finger == finger and name in self.state.moves]
        return self.state.moves[tips[-1]]

    def _follow(self, sensed: Sensed, region: RegionContact, velocity: Array) -> Array:
        """Joint speeds that move a touched point along with the sphere, and press as is wanted [rad/s]."""
        config, pose = self.config, sensed.pose
        at = pose.point(region.link, region.centre_m)
        press = config.sphere_compliance_m_s_n * (config.sphere_force_n - region.force_n)
        wanted = velocity + press * pose.direction(region.link, region.normal)
        jacobian = pose.jacobian(region.link, at)
        damped = jacobian @ jacobian.T + config.sphere_damping_m**2 * np.eye(3)
        rates: Array = jacobian.T @ np.linalg.solve(damped, wanted)
        return rates


def _all_closing(sensed: Sensed) -> Array:
    """How much each joint takes part in closing whichever finger."""
    return np.sum([sensed.closing(finger) for finger in sensed.hand.fingers], axis=0)


def _outermost(sensed: Sensed, finger: str) -> RegionContact | None:
    """The touched region nearest to the tip of a finger."""
    touching = [one for one in sensed.of_finger(finger) if one.in_contact]
    return touching[-1] if touching else None
