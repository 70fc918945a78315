# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the links of a hand are, and how its joints move a point of them; any hand of a description."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from acts_control.hand.description.description import HandDescription
from acts_core.errors import SettingsError

Array = NDArray[np.float64]


class HandKinematics:
    """The links of a hand.

    Parameters
    ----------
    hand : HandDescription
    """

    def __init__(self, hand: HandDescription) -> None:
        self.hand = hand
        self._joint = {name: k for k, name in enumerate(hand.names)}
        self._link = {hand.base: 0, **{link.name: k + 1 for k, link in enumerate(hand.links)}}
        self._parent = [self._link[link.parent] for link in hand.links]
        self._moved_by = np.array([self._joint[link.joint] for link in hand.links], dtype=np.intp)
        self._origin = np.array([link.pose.position_m for link in hand.links]).reshape(-1, 3)
        self._fixed = np.array([link.pose.rotation() for link in hand.links]).reshape(-1, 3, 3)
        self._axis = np.array([link.axis for link in hand.links]).reshape(-1, 3)
        # Rodrigues: 1 + sin(q) K + (1 - cos(q)) K K
        self._cross = np.array([_cross(axis) for axis in self._axis]).reshape(-1, 3, 3)
        self._cross_cross = self._cross @ self._cross
        self._chain = [self._chain_of(k) for k in range(len(self._link))]
        self._levels = self._by_depth()

    def has(self, link: str) -> bool:
        """Whether the hand has a link, its base included."""
        return link in self._link

    def number(self, link: str) -> int:
        """A link's place in the arrays of `HandPose`.

        Raises
        ------
        SettingsError
            When the hand has no such link.
        """
        if link not in self._link:
            raise SettingsError(f"hand {self.hand.name} has no link {link!r}; it has {', '.join(self._link)}")
        return self._link[link]

    def at(self, q_rad: ArrayLike) -> HandPose:
        """Where all links are at these joint angles, shape (joints,) [rad]."""
        q = np.asarray(q_rad, dtype=np.float64)[self._moved_by, None, None]
        turned = self._fixed @ (np.eye(3) + np.sin(q) * self._cross + (1.0 - np.cos(q)) * self._cross_cross)
        count = len(self._link)
        rotation, origin = np.empty((count, 3, 3)), np.empty((count, 3))
        rotation[0], origin[0] = np.eye(3), 0.0
        for links, parents in self._levels:
            base = rotation[parents]
            rotation[links] = base @ turned[links - 1]
            origin[links] = origin[parents] + (base @ self._origin[links - 1, :, None])[:, :, 0]
        return HandPose(self, rotation, origin)

    def _chain_of(self, link: int) -> list[int]:
        """Numbers of the link and of all links before it but the base."""
        chain = []
        while link:
            chain.append(link)
            link = self._parent[link - 1]
        return chain

    def _by_depth(self) -> list[tuple[NDArray[np.intp], NDArray[np.intp]]]:
        """Links of the same depth, and their parents: worked out at once."""
        depths: dict[int, list[int]] = {}
        for link in range(1, len(self._link)):
            depths.setdefault(len(self._chain[link]), []).append(link)
        return [
            (np.array(links, dtype=np.intp), np.array([self._parent[k - 1] for k in links], dtype=np.intp))
            for _, links in sorted(depths.items())
        ]


class HandPose:
    """Where the links are, at one set of joint angles; everything in the frame of the hand's base.

    Attributes
    ----------
    rotation : np.ndarray [shape=(links, 3, 3)]
        From each link's frame.
    origin : np.ndarray [shape=(links, 3)]
        Of each link's frame [m].
    """

    def __init__(self, kinematics: HandKinematics, rotation: Array, origin: Array) -> None:
        self.rotation = rotation
        self.origin = origin
        self._kinematics = kinematics

    def point(self, link: str, point_m: ArrayLike) -> Array:
        """A point of a link, from its frame; shape (3,) both [m]."""
        k = self._kinematics.number(link)
        moved: Array = self.rotation[k] @ np.asarray(point_m) + self.origin[k]
        return moved

    def direction(self, link: str, vector: ArrayLike) -> Array:
        """A direction, from a link's frame; shape (3,) both."""
        turned: Array = self.rotation[self._kinematics.number(link)] @ np.asarray(vector)
        return turned

    def tip(self, finger: str) -> Array:
        """The tip of a finger, shape (3,) [m]."""
        one = self._kinematics.hand.fingers[finger]
        return self.point(one.tip_link, one.tip_m)

    def jacobian(self, link: str, at_m: ArrayLike) -> Array:
        """How a point that a link carries moves with the joints.

        Parameters
        ----------
        link : str
        at_m : array_like [shape=(3,)]
            The point, in the frame of the hand's base [m].

        Returns
        -------
        np.ndarray [shape=(3, joints)]
            [m/rad]
        """
        kinematics = self._kinematics
        jacobian = np.zeros((3, len(kinematics.hand.joints)))
        at = np.asarray(at_m, dtype=np.float64)
        for k in kinematics._chain[kinematics.number(link)]:
            axis = self.rotation[k] @ kinematics._axis[k - 1]
            arm = at - self.origin[k]
            jacobian[:, kinematics._moved_by[k - 1]] += (
                axis[1] * arm[2] - axis[2] * arm[1],
                axis[2] * arm[0] - axis[0] * arm[2],
                axis[0] * arm[1] - axis[1] * arm[0],
            )
        return jacobian


def _cross(axis: Array) -> Array:
    x, y, z = axis
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
