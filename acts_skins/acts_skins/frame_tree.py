# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A tree of fixed frames, and the transform between any two of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from acts_core.errors import SettingsError
from acts_core.transforms import Transform


@dataclass(frozen=True)
class Pose:
    """Pose of a frame in its parent frame."""

    parent: str
    transform: Transform


class FrameTree:
    """The fixed frames of a robot.

    Parameters
    ----------
    poses : mapping of str to Pose
        By the frame's name.

    Raises
    ------
    SettingsError
        When frames form a cycle.
    """

    def __init__(self, poses: Mapping[str, Pose]) -> None:
        self._poses = dict(poses)
        for name in self._poses:
            self._way_to_root(name)

    def between(self, base: str, frame: str) -> Transform:
        """Transform from `frame` to `base`.

        Raises
        ------
        SettingsError
            When no fixed frames connect the two.
        """
        base_root, to_base = self._way_to_root(base)
        frame_root, to_frame = self._way_to_root(frame)
        if base_root != frame_root:
            raise SettingsError(
                f"the frame {frame} is fixed to {frame_root}, and {base} to {base_root}: nothing in this file says "
                f"how {frame_root} lies in {base_root}; give {frame_root} a pose under frames, or another base_frame"
            )
        return to_base.inverse() @ to_frame

    def _way_to_root(self, frame: str) -> tuple[str, Transform]:
        """The root above `frame`, and the transform from `frame` to it."""
        transform, seen = Transform(), [frame]
        while frame in self._poses:
            pose = self._poses[frame]
            transform, frame = pose.transform @ transform, pose.parent
            if frame in seen:
                raise SettingsError(f"poses go round in a circle: {' in '.join([*seen, frame])}")
            seen.append(frame)
        return frame, transform
