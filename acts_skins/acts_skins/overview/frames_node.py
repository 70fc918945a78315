# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The node `skin_frames`: publishes the frames of the skins."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node

from acts_core.settings import setting, validate
from acts_ros import qos
from acts_ros.parameters import declare, node_options
from acts_ros.publishers import TolerantPublisher
from acts_skins.frame_tree import Pose
from acts_skins.skins_file import skins_of


@dataclass(frozen=True)
class SkinFramesSettings:
    """Parameters of the node."""

    skins_file: str = setting("", "YAML file that describes the skins; needed")

    def __post_init__(self) -> None:
        validate(self)


class SkinFramesNode(Node):
    """Publishes once, also for late joiners: ``/tf_static`` with all frames, and ``SKIN/pose`` for every skin.

    Without tf2_msgs (ROS installations have it, Python's package index does not) it publishes only the poses.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("skin_frames", **node_options(), **options)
        settings = declare(self, SkinFramesSettings)
        skins_file = skins_of(settings.skins_file)
        transforms = static_transforms(skins_file.poses(), self.get_clock().now().to_msg())
        # Kept: late joiners get the last message only while its publisher exists.
        self._pose_publishers = []
        for skin in skins_file.skins:
            publisher = self.create_publisher(
                TransformStamped, f"{skin.name}/pose", qos.LATCHED, publisher_class=TolerantPublisher
            )
            publisher.publish(transforms[skin.name])
            self._pose_publishers.append(publisher)
        message_class = _tf_message_class()
        if message_class is None:
            self.get_logger().warning("tf2_msgs is not installed: no /tf_static; the poses are on the topics SKIN/pose")
            return
        self._tf_publisher = self.create_publisher(
            message_class, "/tf_static", qos.LATCHED, publisher_class=TolerantPublisher
        )
        self._tf_publisher.publish(message_class(transforms=list(transforms.values())))


def static_transforms(poses: Mapping[str, Pose], stamp: Time) -> dict[str, TransformStamped]:
    """Transforms as tf2 defines them, from a frame to its parent, by the frame's name."""
    transforms = {}
    for name, pose in poses.items():
        message = TransformStamped(child_frame_id=name)
        message.header.stamp = stamp
        message.header.frame_id = pose.parent
        translation, rotation = message.transform.translation, message.transform.rotation
        translation.x, translation.y, translation.z = pose.transform.position_m
        rotation.x, rotation.y, rotation.z, rotation.w = pose.transform.quaternion
        transforms[name] = message
    return transforms


def _tf_message_class() -> Any:
    try:
        return importlib.import_module("tf2_msgs.msg").TFMessage
    except ImportError:
        return None
