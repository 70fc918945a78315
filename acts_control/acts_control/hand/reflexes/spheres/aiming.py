# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Aiming fingers at a sphere that the palm feels: from which side each comes, and how its tip gets there.

A sphere that lies on the palm touches it where its middle is, so the palm tells its place before a finger does, and
each finger that touches it tells its radius.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.description import HandDescription, Region
from acts_control.hand.reflexes.base import Sensed
from acts_core.skin import RegionContact

Array = NDArray[np.float64]

# Above the middle of a sphere: what is small is held down, what is large is held around.
_HEIGHT_RAD = {"over": 0.45, "beside": 0.45, "against": 0.60}
_OVER_RAD = 1.45
_LARGE_M, _SMALLEST_M = 0.035, 0.008

SMALL_M = 0.018
"""Radius of a sphere that only one finger gets hold of: tips side by side are in each other's way [m]."""

PAIR_M = 0.0245
"""Radius of a sphere that only the finger over it and the one against it get hold of [m]."""

# The others wait at this distance from its middle.
_WAITS_M = {"over": 0.0, "beside": 0.040, "against": 0.028}

# Fingers beside the one in the middle come from the side, and a little from ahead.
_AHEAD = 0.3

# An error of 1 in a pad's direction counts as much as this distance; keeps joints slow where a finger is stretched.
_TURN_M, _DAMPING_M = 0.003, 0.008
_LIMIT_RAD = 0.01
_GAIN_PER_S = 7.0


def felt_by_palm(sensed: Sensed, widest_m: float) -> tuple[Array, Array] | None:
    """Where something round lies on the palm, and the direction out of the palm there.

    Parameters
    ----------
    sensed : Sensed
    widest_m : float
        Spread of a contact above which it is none of a sphere [m].

    Returns
    -------
    at_m, up : np.ndarray [shape=(3,)]
        The place, and a unit vector, in the frame of the hand's base [m]. None where there is no such contact.
    """
    for one in sensed.of_finger(""):
        if one.in_contact and one.spread_m <= widest_m:
            return sensed.pose.point(one.link, one.centre_m), sensed.pose.direction(one.link, one.normal)
    return None


def radius_on_palm(at_m: Array, up: Array, points_m: Sequence[Array]) -> float | None:
    """Radius of the sphere that touches the palm at one point and fingers at others; None where they do not say [m].

    Parameters
    ----------
    at_m, up : np.ndarray [shape=(3,)]
        Where it lies on the palm [m], and the unit vector out of the palm there.
    points_m : sequence of np.ndarray [shape=(3,)]
        Where fingers touch it [m]. Those that are hardly above the palm say nothing.
    """
    away = np.array(points_m).reshape(-1, 3) - at_m
    heights = away @ up
    away, heights = away[heights > 0.002], heights[heights > 0.002]
    if not len(heights):
        return None
    return float((heights * (away**2).sum(axis=1)).sum() / (2.0 * (heights**2).sum()))


def can_aim(hand: HandDescription) -> bool:
    """Whether fingertips can be aimed: a finger that does not oppose feels, and of each that feels the pad is known."""
    tips = {region.finger: region for region in hand.regions.values() if region.finger}
    comes_over = any(not hand.fingers[finger].opposes for finger in tips)
    return comes_over and all(any(tip.normal) for tip in tips.values())


class Approach(NamedTuple):
    """From where a finger comes to a sphere on the palm.

    Attributes
    ----------
    side : np.ndarray [shape=(3,)]
        Unit vector along the palm, from the sphere.
    part : str
        `over`: of the fingers the one most in the middle, which comes down on what is small; `beside` it; `against`
        these, as a thumb does.
    """

    side: Array
    part: Literal["over", "beside", "against"]

    def on_sphere(self, up: Array, radius_m: float) -> Array:
        """Where its tip belongs: unit vector from the sphere's middle, shape (3,).

        Parameters
        ----------
        up : np.ndarray [shape=(3,)]
            Unit vector out of the palm.
        radius_m : float
            Of the sphere [m].
        """
        height_rad = _HEIGHT_RAD[self.part]
        if self.part == "over":
            share = np.clip((radius_m - _SMALLEST_M) / (_LARGE_M - _SMALLEST_M), 0.0, 1.0)
            height_rad = _OVER_RAD + share * (height_rad - _OVER_RAD)
        result: Array = np.cos(height_rad) * self.side + np.sin(height_rad) * up
        return result

    @property
    def waits_m(self) -> float:
        """No nearer to the sphere's middle than this, or it is in the way of the finger that comes from above [m]."""
        return _WAITS_M[self.part]


def approaches(sensed: Sensed, at_m: Array, up: Array) -> dict[str, Approach]:
    """From where each finger comes to something on the palm.

    By where their roots are in the flat hand, seen from there: so parts change with the place.

    Parameters
    ----------
    sensed : Sensed
    at_m, up : np.ndarray [shape=(3,)]
        Where it lies [m], and the unit vector out of the palm there.

    Returns
    -------
    dict of str to Approach
        By finger; those of which no region is known are left out.
    """
    flat = sensed.kinematics.at(sensed.steps())
    roots, sides = {}, {}
    for finger in sensed.hand.fingers:
        first = next((one for one in sensed.hand.regions.values() if one.finger == finger), None)
        if first is None:
            continue
        root = flat.point(first.link, first.centre_m) - at_m
        roots[finger] = root - (root @ up) * up
        sides[finger] = unit(roots[finger])
    most = [finger for finger in sides if not sensed.hand.fingers[finger].opposes]
    if not most:
        return {}
    middle = unit(np.sum([sides[finger] for finger in most], axis=0))
    over = max(most, key=lambda finger: float(sides[finger] @ middle))
    found = {}
    for finger, side in sides.items():
        across = roots[finger] - (roots[finger] @ sides[over]) * sides[over]
        if finger == over:
            found[finger] = Approach(side, "over")
        elif finger not in most:
            found[finger] = Approach(-middle, "against")
        else:
            found[finger] = Approach(unit(unit(across) + _AHEAD * sides[over]), "beside")
    return found


def turned(direction: Array, to: Array, most_rad: float) -> Array:
    """A unit vector, turned towards another by no more than an angle.

    Parameters
    ----------
    direction, to : np.ndarray [shape=(3,)]
        Unit vectors.
    most_rad : float
        [rad]
    """
    angle_rad = float(np.arccos(np.clip(direction @ to, -1.0, 1.0)))
    if angle_rad <= most_rad:
        return to
    across = unit(to - (to @ direction) * direction)
    result: Array = np.cos(most_rad) * direction + np.sin(most_rad) * across
    return result


def pad_m(sensed: Sensed, finger: str) -> Array:
    """Where the pad of a fingertip is, shape (3,) [m]."""
    tip = _tip(sensed, finger)
    return sensed.pose.point(tip.link, tip.centre_m)


def _tip(sensed: Sensed, finger: str) -> Region:
    return [one for one in sensed.hand.regions.values() if one.finger == finger][-1]


def reach(sensed: Sensed, finger: str, to_m: Array, facing: Array, speed_m_s: float) -> Array:
    """Joint speeds that bring the pad of a fingertip to a point, facing a direction.

    Parameters
    ----------
    sensed : Sensed
    finger : str
    to_m, facing : np.ndarray [shape=(3,)]
        The point [m], and a unit vector.
    speed_m_s : float
        No faster than this [m/s].

    Returns
    -------
    np.ndarray [shape=(joints,)]
        [rad/s]
    """
    region, pose = _tip(sensed, finger), sensed.pose
    at, normal = pose.point(region.link, region.centre_m), pose.direction(region.link, region.normal)
    moves = pose.jacobian(region.link, at)
    turns = pose.jacobian(region.link, at + normal) - moves
    velocity = _GAIN_PER_S * (to_m - at)
    speed = float(np.linalg.norm(velocity))
    velocity *= min(1.0, speed_m_s / max(speed, 1e-9))
    jacobian = np.concatenate([moves, _TURN_M * turns])
    return _rates(sensed, jacobian, np.concatenate([velocity, _TURN_M * _GAIN_PER_S * (facing - normal)]), _DAMPING_M)


def press(sensed: Sensed, region: RegionContact, speed_m_s: float, damping_m: float = _DAMPING_M) -> Array:
    """Joint speeds that press a touched point on, or let it off.

    Parameters
    ----------
    sensed : Sensed
    region : RegionContact
        The contact of which the centre is moved.
    speed_m_s : float
        Out of the skin, so towards what it touches; below 0 away from that [m/s].
    damping_m : float
        The larger, the slower are joints where a finger is stretched [m].

    Returns
    -------
    np.ndarray [shape=(joints,)]
        [rad/s]
    """
    pose = sensed.pose
    at = pose.point(region.link, region.centre_m)
    wanted = speed_m_s * pose.direction(region.link, region.normal)
    return _rates(sensed, pose.jacobian(region.link, at), wanted, damping_m)


def _rates(sensed: Sensed, jacobian: Array, wanted: Array, damping_m: float) -> Array:
    """By the damped inverse; what joints at their limits cannot do, the others do."""
    is_lowest = sensed.goal_rad < sensed.hand.lower_rad + _LIMIT_RAD
    is_highest = sensed.goal_rad > sensed.hand.upper_rad - _LIMIT_RAD
    rates = sensed.steps()
    for _ in range(3):
        damped = jacobian @ jacobian.T + damping_m**2 * np.eye(len(wanted))
        rates = jacobian.T @ np.linalg.solve(damped, wanted)
        stuck = ((rates > 0.0) & is_highest) | ((rates < 0.0) & is_lowest)
        if not stuck.any():
            break
        jacobian = np.where(stuck, 0.0, jacobian)
    return rates


def unit(vector: Array) -> Array:
    """A vector's direction, of length 1; that of no length stays nearly 0."""
    result: Array = vector / max(float(np.linalg.norm(vector)), 1e-9)
    return result
