# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A sphere that lies on the palm, as the skin feels it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from acts_control.hand.description import HandPose, Region
from acts_core.skin import RegionContact

Array = NDArray[np.float64]

# Contacts that press harder than this tell no more of the sphere.
_FULL_WEIGHT_N = 1.0


class Ball(NamedTuple):
    """A sphere that lies on the palm, in the frame of the hand's base.

    Attributes
    ----------
    foot_m, up : np.ndarray [shape=(3,)]
        Where it touches the palm [m], and the direction out of the palm.
    centre_m : np.ndarray [shape=(3,)]
        [m]
    radius_m : float
    away_m : np.ndarray [shape=(3,)]
        Along the palm, from its foot to the palm's centre [m].
    """

    foot_m: Array
    up: Array
    centre_m: Array
    radius_m: float
    away_m: Array

    @property
    def offset_m(self) -> float:
        """How far it is from the palm's centre [m]."""
        return float(np.linalg.norm(self.away_m))

    def surface_velocity(self, velocity_m_s: Array, at_m: Array) -> Array:
        """How its surface moves at a point while it rolls along the palm without sliding, shape (3,) [m/s].

        The foot is at rest, so the surface turns about it: v = omega x (at - foot), omega = up x velocity / radius.
        """
        turn_rad_s = np.cross(self.up, velocity_m_s) / self.radius_m
        return np.cross(turn_rad_s, at_m - self.foot_m)

    def height(self, at_m: Array) -> float:
        """Sine of the angle at which its centre sees a point above its equator: 1 on top, 0 at the equator."""
        away = at_m - self.centre_m
        return float(away @ self.up / max(float(np.linalg.norm(away)), 1e-9))


def felt_ball(pose: HandPose, palm: Region, contacts: Sequence[RegionContact], prior_m: float) -> Ball:
    """The sphere that fits to all contacts.

    Parameters
    ----------
    pose : HandPose
    palm : Region
    contacts : sequence of RegionContact
        At least one.
    prior_m : float
        Radius that is taken where they do not say [m].
    """
    points = np.array([pose.point(one.link, one.centre_m) for one in contacts])
    normals = np.array([pose.direction(one.link, one.normal) for one in contacts])
    weights = np.clip([one.force_n for one in contacts], 1e-3, _FULL_WEIGHT_N)
    centre, radius_m = fitted_sphere(points, normals, weights, prior_m)
    up = pose.direction(palm.link, palm.normal)
    # The palm tells where the sphere is; where it feels none, the other contacts do.
    on_palm = [one for one in contacts if one.link == palm.link]
    foot = pose.point(palm.link, on_palm[0].centre_m) if on_palm else centre - radius_m * up
    away = pose.point(palm.link, palm.centre_m) - foot
    return Ball(foot, up, centre, radius_m, away - (away @ up) * up)


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
