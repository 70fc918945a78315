# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Topics ``board_image`` and ``board_object``: what the board recovered itself."""

from __future__ import annotations

from array import array

from rclpy.lifecycle import LifecycleNode
from sensor_msgs.msg import Image

from acts_core.wire import BoardImage, BoardObject, confidence_of
from acts_driver.board import BoardResult
from acts_msgs.msg import ObjectClass
from acts_ros.messages import set_stamp
from acts_ros.publishers import published
from acts_ros.qos import STREAM


class BoardTopics:
    """Publishes results of the board.

    Parameters
    ----------
    node : LifecycleNode
        The driver.
    frame_id : str
        Of the headers.
    """

    def __init__(self, node: LifecycleNode, frame_id: str) -> None:
        self._frame_id = frame_id
        self._images = node.create_publisher(Image, "board_image", **published(STREAM))
        self._objects = node.create_publisher(ObjectClass, "board_object", **published(STREAM))

    def publish(self, result: BoardResult, stamp_ns: int) -> None:
        """Publish one result with the stamp of its frame [ns]."""
        if isinstance(result, BoardImage):
            self._images.publish(image_message(result, self._frame_id, stamp_ns))
        else:
            self._objects.publish(object_message(result, self._frame_id, stamp_ns))


def image_message(image: BoardImage, frame_id: str, stamp_ns: int) -> Image:
    """An image as ``mono16``, in counts."""
    rows, cols = image.counts.shape
    message = Image(height=rows, width=cols, encoding="mono16", is_bigendian=0, step=2 * cols)
    message.header.frame_id = frame_id
    set_stamp(message.header.stamp, stamp_ns)
    message.data = array("B", image.counts.astype("<u2").tobytes())
    return message


def object_message(result: BoardObject, frame_id: str, stamp_ns: int) -> ObjectClass:
    """A classification; the board does not know the object's name."""
    touched = result.number is not None
    message = ObjectClass(sequence=result.sequence)
    message.header.frame_id = frame_id
    set_stamp(message.header.stamp, stamp_ns)
    message.class_number = result.number if touched else ObjectClass.NO_OBJECT
    message.confidence = confidence_of(result.residuals) if touched else 0.0
    message.residuals = array("f", result.residuals.astype("f4").tobytes())
    return message
